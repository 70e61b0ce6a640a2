#include <catch2/catch.hpp>
#include <numbers>

#include "arm_fixture.hpp"
#include "io_model_fixture.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/joint_chain.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur10.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

/// Transforms of a calibrated UR10e, about as far from the nominal ones as calibrations are.
const std::string calibration = R"(kinematics:
  shoulder: {x: 0, y: 0, z: 0.18093, roll: -0, pitch: 0, yaw: 4.1e-05}
  upper_arm: {x: 0.000131, y: 0, z: 0, roll: 1.570312, pitch: 0, yaw: -1.7e-05}
  forearm: {x: -0.612983, y: 0, z: 0, roll: 0.000612, pitch: 0.000143, yaw: 2.2e-05}
  wrist_1:
    x: -0.571801
    y: -6.4e-05
    z: 0.174321
    roll: 0.003214
    pitch: -0.001203
    yaw: 7e-06
  wrist_2: {x: -4.4e-05, y: -0.119762, z: -5.1e-05, roll: 1.571221, pitch: 0, yaw: 1.2e-05}
  wrist_3: {x: -2.2e-05, y: 0.116603, z: 3.9e-05, roll: 1.570461, pitch: 3.141592653589793, yaw: -3.141571}
  hash: calib_1234567890
)";

}  // namespace

TEST_CASE("every robot that comes along is loaded, and 10 000 of its poses are solved") {
  const std::string name = GENERATE("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e", "ur16e");
  INFO(name);
  CapturedMessages captured;
  const Robot robot = load_robot(find_data_file(name, "robots"), captured.messages, true);
  CHECK(robot.name == name);
  CHECK(captured.text().empty());
  const InverseKinematics arm(robot);
  CHECK(arm.geometry().exact);
  Random random(1);
  double residual = 0.0, original = 0.0;
  int unsolved = 0;
  for (int i = 0; i < 10000; ++i) {
    const Joints q = random_joints(random);
    const Pose pose = forward_kinematics(robot, q);
    double nearest = 10.0;
    for (const IkSolution& s : arm(pose)) {
      residual = std::max(residual, distance(forward_kinematics(robot, s.joints), pose).largest());
      nearest = std::min(nearest, (s.joints - q).unaryExpr(&wrap_angle).cwiseAbs().maxCoeff());
    }
    unsolved += nearest > 5.0 ? 1 : 0;
    if (std::abs(std::sin(q[4])) > 1e-4) original = std::max(original, nearest);
  }
  CHECK(residual < 1e-12);
  CHECK(original < 1e-6);
  CHECK(unsolved == 0);
}

TEST_CASE("the robots of the library and those of the files are the same") {
  CapturedMessages captured;
  for (const Robot& robot : {nominal_ur10(), nominal_ur10e()}) {
    const Robot read = load_robot(find_data_file(robot.name, "robots"), captured.messages, true);
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(read.dh[i].a == robot.dh[i].a);
      CHECK(read.dh[i].alpha == robot.dh[i].alpha);
      CHECK(read.dh[i].d == robot.dh[i].d);
      CHECK(read.dh[i].theta == robot.dh[i].theta);
    }
    CHECK(read.limits.velocity.isApprox(robot.limits.velocity));
  }
}

#ifdef LFD_WITH_YAML

TEST_CASE("a calibration is the chain of its transforms to 1e-9, with the limits of its model") {
  const ScratchFolder folder;
  CapturedMessages captured;
  const Robot robot = load_robot(folder.write("mine.yaml", calibration), captured.messages);
  CHECK(robot.name == "ur10e");
  CHECK(captured.text().find("[robot.model]") != std::string::npos);
  CHECK(robot.limits.velocity.isApprox(nominal_ur10e().limits.velocity));
  JointChain chain;
  const double numbers[6][6] = {{0, 0, 0.18093, 0, 0, 4.1e-05},
                                {0.000131, 0, 0, 1.570312, 0, -1.7e-05},
                                {-0.612983, 0, 0, 0.000612, 0.000143, 2.2e-05},
                                {-0.571801, -6.4e-05, 0.174321, 0.003214, -0.001203, 7e-06},
                                {-4.4e-05, -0.119762, -5.1e-05, 1.571221, 0, 1.2e-05},
                                {-2.2e-05, 0.116603, 3.9e-05, 1.570461, pi, -3.141571}};
  for (std::size_t i = 0; i < 6; ++i) {
    chain.origins[i].position = Eigen::Map<const Vector3>(numbers[i]);
    chain.origins[i].rotation = rotation_from_rpy(Eigen::Map<const Vector3>(numbers[i] + 3));
  }
  const Pose base = frame_in_base(robot, "base");
  const InverseKinematics arm(robot);
  Random random(2);
  double worst = 0.0, solved = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Joints q = random_joints(random);
    const Pose wanted = forward_kinematics(chain, q), pose = forward_kinematics(robot, q);
    worst = std::max(worst, distance(inverse(base) * pose, wanted).largest());
    for (const IkSolution& s : arm(pose)) {
      solved = std::max(solved, distance(forward_kinematics(chain, s.joints), wanted).largest());
    }
  }
  CHECK(worst < 1e-9);
  CHECK(solved < 2e-9);
}

TEST_CASE("a calibration that says too little, too much or nonsense is refused with its place") {
  const ScratchFolder folder;
  CapturedMessages captured;
  const auto refusal = [&](const std::string& text, bool strict = false) {
    const std::string file = folder.write("bad.yaml", text);
    return refusal_of([&] { (void)load_robot(file, captured.messages, strict); });
  };
  const Refusal text = refusal(changed(calibration, "0.18093", "high"));
  CHECK(text.fault == Fault::config);
  CHECK(text.id == "yaml.wrong_type");
  CHECK(text.place.pointer == "/kinematics/shoulder/z");
  CHECK(text.place.line == 2);
  CHECK(refusal(changed(calibration, "0.18093", ".nan")).id == "yaml.wrong_type");
  CHECK(refusal(changed(calibration, "0.18093", "[1]")).id == "yaml.wrong_type");
  const Refusal missing = refusal(changed(calibration, "    yaw: 7e-06\n", ""));
  CHECK(missing.id == "yaml.missing_key");
  CHECK(missing.place.pointer == "/kinematics/wrist_1");
  CHECK(refusal(changed(calibration, "    yaw: 7e-06\n", "    yaw: 7e-06\n    x: 1\n")).id == "yaml.duplicate_key");
  CHECK(refusal(changed(calibration, "hash", "hush"), true).id == "yaml.unknown_key");
  CHECK(refusal(changed(calibration, "hash", "hush")).id.empty());
  CHECK(refusal(changed(calibration, "-0.612983", "-0.9")).id == "robot.unknown_model");
  CHECK(refusal(changed(calibration, "1.570312", "0.4")).id == "ur10.not_a_ur");
  // Lengths that are right do not make the rest right.
  const Refusal turned = refusal(changed(calibration, "yaw: 2.2e-05", "yaw: 1.0"));
  CHECK(turned.id == "robot.far_from_model");
  CHECK(turned.place.pointer == "/kinematics/wrist_1");
  CHECK(refusal(changed(calibration, "{x: 0, y: 0, z: 0.18093", "{x: 0.5, y: 0, z: 0.18093")).place.pointer ==
        "/kinematics/shoulder");
  const Refusal degrees = refusal(changed(calibration, "pitch: 3.141592653589793", "pitch: 180"));
  CHECK(degrees.id == "robot.far_from_model");
  CHECK(degrees.place.pointer == "/kinematics/wrist_3");
  CHECK(refusal(calibration + calibration).id == "yaml.duplicate_key");
  CHECK(refusal("").id == "yaml.wrong_type");
  CHECK(refusal("kinematics: 3\n").id == "yaml.wrong_type");
  CHECK(refusal("kinematics: {shoulder: [\n").id == "yaml.syntax");
  CHECK(refusal("a: *b\n").id == "yaml.syntax");
  for (const std::string& odd : {std::string("["), std::string("- 1\n- 2\n"), std::string("\0\1\2", 3)}) {
    CHECK(refusal(odd).fault == Fault::config);
  }
}

#endif
