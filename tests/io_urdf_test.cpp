#include <catch2/catch.hpp>
#include <numbers>

#include "io_fixture.hpp"
#include "lfdtools/joint_chain.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur10.hpp"
#include "robot_formats.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

std::string joint(const std::string& name, const std::string& parent, const std::string& child, const std::string& type,
                  const std::string& xyz, const std::string& rpy, const std::string& more) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/>" + more + "</joint>\n";
}

const std::string limit = R"(<axis xyz="0 0 1"/><limit effort="1" lower="-6.2" upper="6.2" velocity="2.1"/>)";

/// A UR10e on a table, as ROS describes it, its wrist slightly off.
std::string description(const std::string& shoulder = limit) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"my_arm\">\n";
  for (const char* link : {"world", "base_link", "base", "base_link_inertia", "shoulder", "upper_arm", "forearm",
                           "wrist_1", "wrist_2", "wrist_3", "flange", "tool0", "finger"}) {
    text += std::string("<link name=\"") + link + "\"/>\n";
  }
  text += joint("table", "world", "base_link", "fixed", "0.5 0.1 0.8", "0 0 0.3", "");
  text += joint("base_joint", "base_link", "base", "fixed", "0 0 0", "0 0 3.141592653589793", "");
  text += joint("inertia", "base_link", "base_link_inertia", "fixed", "0 0 0", "0 0 3.141592653589793", "");
  text += joint("pan", "base_link_inertia", "shoulder", "revolute", "0 0 0.1807", "0 0 0", shoulder);
  text += joint("lift", "shoulder", "upper_arm", "revolute", "0 0 0", "1.570796327 0 0", limit);
  text += joint("elbow", "upper_arm", "forearm", "revolute", "-0.6127 0 0", "0.0006 0.0003 0", limit);
  text += joint("w1", "forearm", "wrist_1", "revolute", "-0.57155 0 0.17415", "0 0.001 0", limit);
  // This axis is y, so that the transforms around it are others than ROS has.
  text += joint("w2", "wrist_1", "wrist_2", "continuous", "0 -0.11985 0", "0 0 0",
                R"(<axis xyz="0 -1 0"/><limit effort="1" velocity="3.1"/>)");
  text += joint("w3", "wrist_2", "wrist_3", "revolute", "0 0 0.11655", "0 0 0", limit);
  text += joint("f", "wrist_3", "flange", "fixed", "0 0 0", "0 -1.5707963267948966 -1.5707963267948966", "");
  text += joint("t", "flange", "tool0", "fixed", "0 0 0", "1.5707963267948966 0 1.5707963267948966", "");
  text += joint("g", "tool0", "finger", "prismatic", "0 0 0", "0 0 0", limit);
  return text + "</robot>\n";
}

Pose turned(const Vector3& position, const Vector3& rpy) {
  return {rotation_from_rpy(rpy), position};
}

}  // namespace

TEST_CASE("a URDF is the chain of its joints to 1e-9") {
  const Robot robot = read_urdf(description(), "arm.urdf");
  CHECK(robot.name == "my_arm");
  CHECK(robot.limits.velocity[0] == 2.1);
  CHECK(robot.limits.velocity[4] == 3.1);
  CHECK(robot.limits.position(0, 1) == 6.2);
  CHECK(robot.limits.position(4, 0) == Approx(-2 * pi));
  Random random(1);
  double worst = 0.0;
  const InverseKinematics arm(robot);
  for (int i = 0; i < 500; ++i) {
    Joints q;
    for (double& angle : q) angle = random.uniform(-pi, pi);
    const auto about = [](const Vector3& axis, double angle) {
      return Pose{rotation_from_vector(angle * axis), Vector3::Zero()};
    };
    const Vector3 z = Vector3::UnitZ(), none = Vector3::Zero();
    const Pose tip = turned({0.5, 0.1, 0.8}, {0, 0, 0.3}) * turned(none, {0, 0, pi}) * turned({0, 0, 0.1807}, none) *
                     about(z, q[0]) * turned(none, {1.570796327, 0, 0}) * about(z, q[1]) *
                     turned({-0.6127, 0, 0}, {0.0006, 0.0003, 0}) * about(z, q[2]) *
                     turned({-0.57155, 0, 0.17415}, {0, 0.001, 0}) * about(z, q[3]) * turned({0, -0.11985, 0}, none) *
                     about(-Vector3::UnitY(), q[4]) * turned({0, 0, 0.11655}, none) * about(z, q[5]);
    const Pose pose = forward_kinematics(robot, q);
    worst = std::max(worst, distance(inverse(frame_in_base(robot, "world")) * pose, tip).largest());
    const Pose base = turned({0.5, 0.1, 0.8}, {0, 0, 0.3}) * turned(none, {0, 0, pi});
    worst = std::max(worst, distance(inverse(frame_in_base(robot, "base")) * pose, inverse(base) * tip).largest());
    CHECK(!arm(pose).empty());
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("descriptions without one chain of six joints, without limits or without sense are refused") {
  const auto refusal = [](const std::string& text) { return refusal_of([&] { (void)read_urdf(text, "arm.urdf"); }); };
  CHECK(refusal("").id == "urdf.syntax");
  CHECK(refusal("<robot").id == "urdf.syntax");
  CHECK(refusal("<robot name=\"x\"><link name=\"a\"/></robot>").id == "urdf.chain");
  const Refusal limits =
      refusal(description(R"(<axis xyz="0 0 1"/><limit effort="1" lower="1" upper="-1" velocity="2"/>)"));
  CHECK(limits.fault == Fault::config);
  CHECK(limits.id == "urdf.limits");
  CHECK(limits.place.pointer == "/robot/joint/pan");
  CHECK(refusal(description(R"(<axis xyz="0 0 1"/><limit effort="1" lower="-1" upper="1" velocity="0"/>)")).id ==
        "urdf.limits");
  std::string aslant = description();
  const std::string tool = "1.5707963267948966 0 1.5707963267948966";
  aslant.replace(aslant.find(tool), tool.size(), "1.3 0.2 1.2");
  CHECK(refusal(aslant).id == "robot.not_dh");
}
