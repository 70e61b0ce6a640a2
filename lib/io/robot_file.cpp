#include "lfdtools/io/robot_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "json_check.hpp"
#include "lfdtools/io/input.hpp"
#include "lfdtools/io/json_writer.hpp"
#include "robot_formats.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.robot";
constexpr std::size_t joints = 6;
constexpr std::size_t most_links = 1000;
constexpr std::uint64_t most_bytes = 10'000'000;  // of a file in another format

Pose read_pose(const JsonView& view) {
  view.only({"position", "orientation"});
  Pose pose;
  pose.position = view.at("position").vector(3);
  const JsonView orientation = view.at("orientation");
  const Vector q = orientation.vector(4);
  checked(orientation, [&] { pose.rotation = rotation_from_quaternion(q); });
  return pose;
}

/// A right angle written with ten digits, as makers publish it, is one: an arm that is off by less than a nanometre a
/// metre would count as calibrated, and take far longer to solve.
double right_angle_of(double alpha) {
  constexpr double quarter = std::numbers::pi / 2.0;
  const double right = quarter * std::nearbyint(alpha / quarter);
  return std::abs(alpha - right) < 1e-9 ? right : alpha;
}

void read_dh(const JsonView& list, Robot& robot) {
  if (list.size() != joints) list.fail("json.wrong_length", "there must be six rows, one a joint");
  for (std::size_t i = 0; i < joints; ++i) {
    const JsonView row = list.at(i);
    row.only({"a", "alpha", "d", "theta"});
    robot.dh[i] = {row.at("a").number(), right_angle_of(row.at("alpha").number()), row.at("d").number(),
                   row.at("theta").number()};
  }
}

void read_limits(const JsonView& view, JointLimits& limits) {
  view.only({"position", "velocity", "acceleration"});
  const JsonView position = view.at("position");
  limits.position = position.matrix(joints, 2);
  for (std::size_t i = 0; i < joints; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!(limits.position(row, 0) < limits.position(row, 1))) {
      position.at(i).fail("robot.limits", "the lower limit is not below the upper one");
    }
  }
  const auto read_rates = [](const JsonView& list) {
    const Joints rates = list.vector(joints);
    for (std::size_t i = 0; i < joints; ++i) {
      const double rate = list.at(i).positive();
      if (rate >= JointLimits::least_rate && rate <= JointLimits::most_rate) continue;
      list.at(i).fail("json.out_of_range", "a limit is from 1e-6 to 1e6");
    }
    return rates;
  };
  limits.velocity = read_rates(view.at("velocity"));
  if (const auto acceleration = view.find("acceleration")) limits.acceleration = read_rates(*acceleration);
}

Capsule read_link(const JsonView& view) {
  view.only({"name", "frame", "from", "to", "radius"});
  Capsule link;
  link.name = view.at("name").string();
  link.frame = static_cast<int>(view.at("frame").integer(0, joints));
  link.from = view.at("from").vector(3);
  link.to = view.at("to").vector(3);
  link.radius = view.at("radius").positive();
  return link;
}

/// The bytes of a file in another format.
[[maybe_unused]] std::string all_of(const std::string& path) {
  const Input input(path);
  if (input.size() > most_bytes) throw ConfigError("robot.too_long", "no robot takes over 10 MB", {path, 0, 0, ""});
  std::string text(static_cast<std::size_t>(input.size()), '\0');
  text.resize(input.read_at(0, text.data(), text.size()));
  return text;
}

}  // namespace

Robot read_robot(const JsonDocument& document) {
  document.expect(format);
  const JsonView root = document.root();
  root.only({"format", "version", "name", "dh", "limits", "links", "frames"});
  Robot robot;
  if (const auto name = root.find("name")) robot.name = name->string();
  read_dh(root.at("dh"), robot);
  read_limits(root.at("limits"), robot.limits);
  if (const auto links = root.find("links")) {
    if (links->size() > most_links) links->fail("json.out_of_range", "there are over 1000 links");
    for (std::size_t i = 0; i < links->size(); ++i) robot.links.push_back(read_link(links->at(i)));
  }
  if (const auto frames = root.find("frames")) {
    for (const std::string& name : frames->keys()) robot.frames[name] = read_pose(frames->at(name));
  }
  checked(root, [&] { check(robot); });
  return robot;
}

Robot load_robot(const std::string& path, Messages& messages, bool strict) {
  if (path.ends_with(".yaml") || path.ends_with(".yml")) {
#ifdef LFD_WITH_YAML
    return read_calibration(all_of(path), path, messages, strict);
#else
    throw ConfigError("robot.no_yaml", "these programs were built without yaml-cpp, which reads calibrations",
                      {path, 0, 0, ""});
#endif
  }
  if (path.ends_with(".urdf")) {
#ifdef LFD_WITH_URDF
    return read_urdf(all_of(path), path);
#else
    throw ConfigError("robot.no_urdf", "these programs were built without urdfdom (LFD_URDF), which reads URDF",
                      {path, 0, 0, ""});
#endif
  }
  JsonOptions options;
  options.fault = Fault::config;
  options.strict = strict;
  return read_robot(read_json(path, messages, options));
}

Robot load_robot_with_links(const std::string& path, Messages& messages, bool strict) {
  Robot robot = load_robot(path, messages, strict);
  for (int frame = 1; frame <= static_cast<int>(joints); ++frame) {
    if (std::any_of(robot.links.begin(), robot.links.end(), [&](const Capsule& link) { return link.frame == frame; })) {
      continue;
    }
    throw ConfigError("robot.no_links",
                      fmt::format("the robot file has no link, the capsule {{name, frame, from, to, radius}}, on frame "
                                  "{}, so not all of the arm can be kept clear; ur10 and ur10e have all",
                                  frame),
                      {path, 0, 0, "/links"});
  }
  return robot;
}

void write_robot(const Robot& robot, Output& out) {
  JsonWriter json;
  json.begin_object().member("format", format).member("version", 1).member("name", robot.name).key("dh").begin_array();
  for (const DhRow& row : robot.dh) {
    json.begin_object().member("a", row.a).member("alpha", row.alpha).member("d", row.d).member("theta", row.theta);
    json.end_object();
  }
  json.end_array().key("limits").begin_object().key("position").matrix(robot.limits.position);
  json.key("velocity").vector(robot.limits.velocity);
  if (robot.limits.acceleration) json.key("acceleration").vector(*robot.limits.acceleration);
  json.end_object().key("links").begin_array();
  for (const Capsule& link : robot.links) {
    json.begin_object().member("name", link.name).member("frame", link.frame).key("from").vector(link.from);
    json.key("to").vector(link.to).member("radius", link.radius).end_object();
  }
  json.end_array().key("frames").begin_object();
  for (const auto& [name, pose] : robot.frames) {
    json.key(name).begin_object().key("position").vector(pose.position);
    json.key("orientation").vector(quaternion_from_rotation(pose.rotation)).end_object();
  }
  json.end_object().end_object();
  json.write_line(out);
}

}  // namespace lfd
