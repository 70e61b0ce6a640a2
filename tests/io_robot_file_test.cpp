// Robot files: read as written, faults of status 78, loaded by path, links wanted of every joint.
#include <catch2/catch.hpp>

#include "io_model_fixture.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/ur_geometry.hpp"

using namespace lfd;

namespace {

Robot small_robot() {
  Robot robot;
  robot.name = "toy";
  for (int i = 0; i < 6; ++i) robot.dh[static_cast<std::size_t>(i)] = {0.1 * i, -0.5 * i, 0.3, 0.01 * i};
  robot.limits.position.col(0).setConstant(-6.25);
  robot.limits.position.col(1).setConstant(6.25);
  robot.limits.velocity.setConstant(2.5);
  robot.limits.acceleration = Joints::Constant(40);
  robot.links.push_back({"forearm", 3, Vector3(0, 0, 0.5), Vector3(0.25, 0, 0), 0.06});
  robot.frames["base_link"] = {rotation_about_z(3.0), Vector3(1, 2, 3)};
  return robot;
}

std::string robot_text() {
  return text_of(small_robot(), write_robot);
}

}  // namespace

TEST_CASE("a robot is read as it was written, and its faults are status 78") {
  const std::string text = robot_text();
  const Robot robot = read_robot(document(text, Fault::config));
  REQUIRE(text_of(robot, write_robot) == text);
  REQUIRE(robot.name == "toy");
  REQUIRE(robot.dh[5].alpha == -2.5);
  REQUIRE(robot.limits.acceleration);
  REQUIRE(robot.links[0].frame == 3);
  REQUIRE((robot.frames.at("base_link").rotation - rotation_about_z(3.0)).cwiseAbs().maxCoeff() < 1e-15);
  const auto refused = [&](const char* from, const char* to, const char* id, const char* pointer) {
    require_refused(changed(text, from, to), read_robot, id, pointer, Fault::config);
  };
  refused("{\"a\":0,\"alpha\":0,\"d\":0.3,\"theta\":0},", "", "json.wrong_length", "/dh");
  refused("\"alpha\":0,", "", "json.missing_key", "/dh/0");
  refused("[[-6.25,6.25]", "[[6.25,6.25]", "robot.limits", "/limits/position/0");
  refused("\"velocity\":[2.5", "\"velocity\":[0", "json.out_of_range", "/limits/velocity/0");
  refused("\"velocity\":[2.5", "\"velocity\":[1e7", "json.out_of_range", "/limits/velocity/0");
  refused("\"frame\":3", "\"frame\":7", "json.out_of_range", "/links/0/frame");
  refused("\"frame\":3", "\"frame\":2.5", "json.not_an_integer", "/links/0/frame");
  refused("\"radius\":0.06", "\"radius\":0", "json.out_of_range", "/links/0/radius");
  refused("\"position\":[1,2,3]", "\"position\":[1,2]", "json.wrong_length", "/frames/base_link/position");
  refused("\"name\":\"toy\"", "\"nam\":\"toy\"", "json.unknown_key", "/nam");
  const std::size_t quaternion = text.find("\"orientation\":[");
  const std::string bad =
      text.substr(0, quaternion) + "\"orientation\":[2,0,0,0" + text.substr(text.find(']', quaternion));
  require_refused(bad, read_robot, "rotation.not_unit", "/frames/base_link/orientation", Fault::config);
}

TEST_CASE("right angles in ten digits are right angles, other angles what they are") {
  Robot robot = nominal_ur10();
  const std::string text = text_of(robot, write_robot);
  const std::string published = changed(text, "1.5707963267948966", "1.570796327");
  REQUIRE(published != text);
  const Robot read = read_robot(document(published, Fault::config));
  CHECK(read.dh[0].alpha == robot.dh[0].alpha);
  CHECK(ur_geometry(read).exact);
  const Robot calibrated = read_robot(document(changed(text, "1.5707963267948966", "1.5707963"), Fault::config));
  CHECK(calibrated.dh[0].alpha == 1.5707963);
  CHECK_FALSE(ur_geometry(calibrated).exact);
}

TEST_CASE("a robot file is loaded by path") {
  const ScratchFolder folder;
  REQUIRE(load_robot(folder.write("toy.json", robot_text()), silent).name == "toy");
  REQUIRE(refusal_of([&] { (void)load_robot(folder.write("bad.json", "{"), silent); }).fault == Fault::config);
  REQUIRE(refusal_of([&] { (void)load_robot(folder.file("none.json"), silent); }).fault == Fault::no_input);
}

TEST_CASE("a robot with a joint that carries no link has not all of its body") {
  const ScratchFolder folder;
  Robot robot = read_robot(document(robot_text(), Fault::config));
  const Capsule link = robot.links[0];
  robot.links.clear();
  for (int frame = 1; frame <= 6; ++frame) {
    robot.links.push_back(link);
    robot.links.back().frame = frame;
  }
  REQUIRE(load_robot_with_links(folder.write("toy.json", text_of(robot, write_robot)), silent).links.size() == 6);
  robot.links[2].frame = 4;
  const std::string still = folder.write("still.json", text_of(robot, write_robot));
  const Refusal refusal = refusal_of([&] { (void)load_robot_with_links(still, silent); });
  REQUIRE(refusal.id == "robot.no_links");
  REQUIRE(refusal.fault == Fault::config);
  REQUIRE(refusal.place.pointer == "/links");
  REQUIRE(refusal.place.file == still);
}
