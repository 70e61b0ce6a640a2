#include "lfdtools/motion.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/ur_geometry.hpp"

using namespace lfd;

TEST_CASE("figures of a motion known in closed form") {
  Robot robot = nominal_ur10();
  robot.limits.position(2, 1) = 1.0;
  robot.limits.acceleration = Joints::Constant(4.0);
  Vector times(4);
  times << 0.0, 0.1, 0.3, 0.4;  // uneven on purpose
  Samples joints = Samples::Zero(4, 6);
  for (Eigen::Index t = 0; t < 4; ++t) {
    joints(t, 0) = 0.5 * times[t];                   // 0.5 rad/s
    joints(t, 2) = 1.5 * times[t] * times[t] + 0.9;  // 3 rad/s^2
    joints(t, 4) = -times[t];
  }
  const MotionFigures f = motion_figures(robot, times, joints);
  CHECK(f.range_excess(3, 2) == Approx(1.5 * 0.16 + 0.9 - 1.0));
  CHECK(f.range_excess(0, 2) == 0.0);
  CHECK(f.range_excess.col(0).maxCoeff() == 0.0);
  CHECK(f.step(2, 4) == Approx(0.2));
  CHECK(f.speed(2, 4) == Approx(1.0));
  CHECK(f.speed.row(0).maxCoeff() == 0.0);
  CHECK(f.speed_ratio[1] == Approx(1.0 / robot.limits.velocity[4]));
  CHECK(f.acceleration(1, 2) == Approx(3.0));
  CHECK(f.acceleration(2, 2) == Approx(3.0));
  CHECK(f.acceleration(1, 0) == Approx(0.0).margin(1e-12));
  CHECK(f.acceleration_ratio[2] == Approx(0.75));
  CHECK(f.condition[1] == Approx(condition_number(jacobian(robot, joints.row(1).transpose()))));
  CHECK(worst(f.range_excess).sample == 3);
  CHECK(worst(f.speed_ratio).value == f.speed_ratio.maxCoeff());
  CHECK(worst(Vector()).value == 0.0);
}

TEST_CASE("the tool tip on a turning base runs on a circle") {
  const Robot robot = nominal_ur10();
  constexpr int T = 401;
  Vector times = Vector::LinSpaced(T, 0.0, 2.0);
  Samples joints = Samples::Zero(T, 6);
  joints.col(0) = 0.7 * times;
  const Pose tool{Matrix3::Identity(), Vector3(0.0, 0.1, 0.2)};
  const Vector3 tip = (forward_kinematics(robot, Joints::Zero()) * tool).position;
  const double radius = std::hypot(tip.x(), tip.y());
  const MotionFigures f = motion_figures(robot, times, joints, tool);
  CHECK(f.tcp_speed[200] == Approx(0.7 * radius).epsilon(1e-5));
  CHECK(f.tcp_acceleration[200] == Approx(0.49 * radius).epsilon(1e-5));
  CHECK(f.tcp_acceleration[0] == 0.0);
}

TEST_CASE("joint paths that cannot be judged are refused") {
  const Robot robot = nominal_ur10();
  Samples joints = Samples::Zero(2, 6);
  CHECK_THROWS_AS(motion_figures(robot, Vector::Zero(2), joints), DataError);
  CHECK_THROWS_AS(motion_figures(robot, Vector::LinSpaced(3, 0.0, 1.0), joints), DataError);
  joints(1, 3) = std::nan("");
  CHECK_THROWS_AS(motion_figures(robot, Vector::LinSpaced(2, 0.0, 1.0), joints), DataError);
  CHECK(motion_figures(robot, Vector::Zero(1), Samples::Zero(1, 6)).speed_ratio[0] == 0.0);
}
