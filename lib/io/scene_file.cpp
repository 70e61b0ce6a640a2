#include "lfdtools/io/scene_file.hpp"

#include <set>

#include "json_check.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.scene";
constexpr std::size_t most_obstacles = 10'000;
constexpr double furthest = 1e6;  // of a place, and the largest length [m]; distances keep their digits

void require_near(const JsonView& view, double largest) {
  if (largest > furthest) view.fail("json.out_of_range", "a place or a length is over 1e6 m");
}

SolidShape shape_of(const JsonView& view) {
  const std::string type = view.string();
  if (type == "box") return SolidShape::box;
  if (type == "sphere") return SolidShape::sphere;
  if (type == "cylinder") return SolidShape::cylinder;
  if (type == "capsule") return SolidShape::capsule;
  if (type == "plane") return SolidShape::plane;
  view.fail("scene.type", "the type is box, sphere, cylinder, capsule or plane, not '" + type + "'");
}

Solid read_solid(const JsonView& view) {
  Solid solid;
  if (const auto name = view.find("name")) solid.name = name->string();
  solid.shape = shape_of(view.at("type"));
  const JsonView pose = view.at("pose");
  pose.only({"position", "orientation"});
  solid.pose.position = pose.at("position").vector(3);
  require_near(pose.at("position"), solid.pose.position.cwiseAbs().maxCoeff());
  if (const auto orientation = pose.find("orientation")) {
    const Vector q = orientation->vector(4);
    checked(*orientation, [&] { solid.pose.rotation = rotation_from_quaternion(q); });
  }
  switch (solid.shape) {
    case SolidShape::box: {
      view.only({"name", "type", "pose", "size"});
      const JsonView size = view.at("size");
      solid.size = size.vector(3);
      for (std::size_t i = 0; i < 3; ++i) require_near(size.at(i), size.at(i).positive());
      break;
    }
    case SolidShape::sphere:
      view.only({"name", "type", "pose", "radius"});
      solid.radius = view.at("radius").positive();
      require_near(view.at("radius"), solid.radius);
      break;
    case SolidShape::cylinder:
    case SolidShape::capsule:
      view.only({"name", "type", "pose", "radius", "length"});
      solid.radius = view.at("radius").positive();
      solid.length = view.at("length").positive();
      require_near(view.at("radius"), solid.radius);
      require_near(view.at("length"), solid.length);
      break;
    case SolidShape::plane:
      view.only({"name", "type", "pose"});
      break;
  }
  return solid;
}

}  // namespace

Scene read_scene(const JsonDocument& document) {
  document.expect(format);
  const JsonView root = document.root();
  root.only({"format", "version", "name", "frame", "obstacles"});
  Scene scene;
  if (const auto frame = root.find("frame")) {
    scene.frame = frame->string();
    if (scene.frame != "base" && scene.frame != "base_link") {
      frame->fail("scene.frame", "the frame is base or base_link, not '" + scene.frame + "'");
    }
  }
  const JsonView list = root.at("obstacles");
  if (list.size() > most_obstacles) list.fail("json.out_of_range", "there are over 10000 obstacles");
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    scene.obstacles.push_back(read_solid(list.at(i)));
    const std::string name = scene.obstacles.back().called(i);
    if (names.insert(name).second) continue;
    list.at(i).fail("scene.name_twice",
                    "another obstacle is called '" + name + "' too, by its name or, without one, its number");
  }
  return scene;
}

Scene load_scene(const std::string& path, Messages& messages, bool strict) {
  JsonOptions options;
  options.fault = Fault::config;
  options.strict = strict;
  return read_scene(read_json(path, messages, options));
}

}  // namespace lfd
