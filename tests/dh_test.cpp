#include "lfdtools/dh.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur_geometry.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

Robot random_robot(Random& random) {
  Robot robot = nominal_ur10();
  for (DhRow& row : robot.dh) {
    row = {random.uniform(-1, 1), random.uniform(-pi, pi), random.uniform(-1, 1), random.uniform(-pi, pi)};
  }
  return robot;
}

Joints random_joints(Random& random) {
  Joints q;
  for (double& angle : q) angle = random.uniform(-2 * pi, 2 * pi);
  return q;
}

}  // namespace

TEST_CASE("forward kinematics is the product of the four elementary motions of every row") {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Robot robot = random_robot(random);
    const Joints q = random_joints(random);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    const auto frames = joint_frames(robot, q);
    for (int j = 0; j < 6; ++j) {
      const DhRow& row = robot.dh[static_cast<std::size_t>(j)];
      T = T * Eigen::AngleAxisd(q[j] + row.theta, Vector3::UnitZ()) * Eigen::Translation3d(0, 0, row.d) *
          Eigen::Translation3d(row.a, 0, 0) * Eigen::AngleAxisd(row.alpha, Vector3::UnitX());
      const Pose expected{T.rotation(), T.translation()};
      CHECK(distance(frames[static_cast<std::size_t>(j) + 1], expected).largest() < 1e-14);
    }
    CHECK(distance(forward_kinematics(robot, q), frames[6]).largest() < 1e-15);
  }
}

TEST_CASE("a ur10 at zero lies along -x with the flange at (a2 + a3, -d4 - d6, d1 - d5)") {
  const Pose flange = forward_kinematics(nominal_ur10(), Joints::Zero());
  CHECK((flange.position - Vector3(-0.612 - 0.5723, -0.163941 - 0.0922, 0.1273 - 0.1157)).norm() < 1e-15);
  CHECK((flange.rotation.col(2) - Vector3(0, -1, 0)).norm() < 1e-15);
}

TEST_CASE("the Jacobian is the derivative of forward kinematics") {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Robot robot = random_robot(random);
    const Joints q = random_joints(random);
    const Pose tool{Matrix3::Identity(), Vector3(0.1, -0.2, 0.3)};
    const Jacobian J = jacobian(robot, q, tool.position);
    const Matrix3 R = forward_kinematics(robot, q).rotation;
    for (int j = 0; j < 6; ++j) {
      constexpr double h = 1e-5;
      Joints ahead = q, behind = q;
      ahead[j] += h;
      behind[j] -= h;
      const Pose a = forward_kinematics(robot, ahead) * tool, b = forward_kinematics(robot, behind) * tool;
      CHECK((J.col(j).head<3>() - (a.position - b.position) / (2 * h)).norm() < 1e-8);
      const Matrix3 spin = (a.rotation - b.rotation) / (2 * h) * R.transpose();  // skew matrix of the angular velocity
      CHECK((J.col(j).tail<3>() - Vector3(spin(2, 1), spin(0, 2), spin(1, 0))).norm() < 1e-8);
    }
  }
}

TEST_CASE("condition numbers") {
  Jacobian J = Jacobian::Identity();
  CHECK(condition_number(J) == Approx(1.0));
  J.diagonal() << 2.0, 5.0, 1.0, 0.25, 3.0, 0.5;
  CHECK(condition_number(J) == Approx(20.0));
  Random random(3);
  for (int i = 0; i < 20; ++i) {  // |J| |J^-1| in the spectral norm, from the definition by brute search
    const Jacobian A = jacobian(nominal_ur10(), random_joints(random));
    double largest = 0.0, smallest = 1e9;
    Joints up = Joints::Ones(), down = Joints::Ones();
    const Jacobian AtA = A.transpose() * A;
    const Jacobian shifted = Jacobian::Identity() * AtA.trace() - AtA;
    for (int k = 0; k < 200000; ++k) {  // power iteration for both ends of the spectrum
      up = (AtA * up).normalized();
      down = (shifted * down).normalized();
    }
    largest = std::sqrt(up.dot(AtA * up));
    smallest = (A * down).norm();
    CHECK(condition_number(A) == Approx(largest / smallest).epsilon(1e-4));
  }
  Joints stretched = Joints::Zero();
  stretched << 0.3, -1.0, 0.0, 0.5, 1.0, 0.0;
  CHECK(condition_number(jacobian(nominal_ur10(), stretched)) > 1e12);
  CHECK(condition_number(Jacobian::Zero()) == 1e16);
}

TEST_CASE("named frames") {
  Robot robot = nominal_ur10();
  CHECK(distance(frame_in_base(robot, "base"), Pose{}).largest() == 0.0);
  CHECK(distance(frame_in_base(robot, "base_link"), Pose{rotation_about_z(pi), Vector3::Zero()}).largest() < 1e-15);
  robot.frames.clear();
  CHECK(frame_in_base(robot, "base_link").rotation(0, 0) == -1.0);
  CHECK_THROWS_AS(frame_in_base(robot, "world"), UsageError);
}

TEST_CASE("angles are wrapped to (-pi, pi]") {
  CHECK(wrap_angle(pi) == pi);
  CHECK(wrap_angle(-pi) == pi);
  CHECK(wrap_angle(3 * pi) == Approx(pi));
  CHECK(wrap_angle(2 * pi + 0.25) == Approx(0.25));
  CHECK(wrap_angle(-7.0) == Approx(-7.0 + 2 * pi));
}

TEST_CASE("robots that cannot be are refused by name") {
  const auto id_of = [](const Robot& robot) { return refused_as(Fault::config, [&] { check(robot); }); };
  CHECK(id_of(nominal_ur10e()).empty());
  Robot robot = nominal_ur10();
  robot.dh[2].alpha = std::numeric_limits<double>::quiet_NaN();
  CHECK(id_of(robot) == "robot.not_finite");
  robot = nominal_ur10();
  robot.limits.position(3, 0) = 7.0;
  CHECK(id_of(robot) == "robot.limits");
  robot = nominal_ur10();
  robot.limits.velocity[5] = 0.0;
  CHECK(id_of(robot) == "robot.limits");
  robot = nominal_ur10();
  robot.links.push_back({"hand", 7, Vector3::Zero(), Vector3::Zero(), 0.1});
  CHECK(id_of(robot) == "robot.link");
  robot = nominal_ur10();
  robot.frames["cell"].rotation(0, 0) = 2.0;
  CHECK(id_of(robot) == "robot.frame");
}
