// The probability of touching beside paths of the hand drawn plainly, solved by inverse kinematics and measured in
// full.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "arm_fixture.hpp"
#include "io_fixture.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/path.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/touching.hpp"

using namespace lfd;

namespace {

/// A hand path, and its joints.
struct HandPath {
  std::vector<Pose> flange;
  Samples joints;
};

constexpr int draws = 10'000;

/// How often hand paths drawn from a spread touch, by inverse kinematics and full distances: share at each sample, and
/// of the path as the last. Out of reach is touching nothing.
/// @param self  the arm itself counts too
Vector counted(const ArmClearance& arm, const HandPath& path, const HandSpread& spread, double margin,
               bool self = false) {
  const InverseKinematics solver(arm.robot());
  const Eigen::Index T = path.joints.rows();
  Vector touched = Vector::Zero(T + 1);
  Random random(9);
  for (int i = 0; i < draws; ++i) {
    Vector z(spread.factor.cols());
    for (double& value : z) value = random.normal();
    const Vector shift = spread.factor * z;
    bool any = false;
    for (Eigen::Index t = 0; t < T; ++t) {
      Pose flange = path.flange[static_cast<std::size_t>(t)];
      flange.position += shift.segment<3>(3 * t);
      const Joints near = path.joints.row(t).transpose();
      Joints best = near;
      double nearest = 1e9;
      for (const IkSolution& solution : solver(flange)) {
        Joints way = solution.joints - near;
        for (double& angle : way) angle = wrap_angle(angle);
        if (way.norm() < nearest) {
          nearest = way.norm();
          best = near + way;
        }
      }
      if (nearest == 1e9) continue;
      const bool touches = arm.least(best) <= margin || (self && arm.least_of_arm_itself(best) <= margin);
      if (touches) ++touched[t];
      any = any || touches;
    }
    if (any) ++touched[T];
  }
  return touched / draws;
}

/// Standard error of a count whose expectation is the larger of two estimates; a single draw at least.
double error_of(double p, double other) {
  const double likely = std::max({p, other, 1.0 / draws});
  return std::sqrt(likely * (1 - likely) / draws);
}

/// Told as counted, but for four standard errors of both.
void agree(const Chance& told, double p) {
  CHECK(std::abs(told.probability - p) <= 4 * std::hypot(error_of(p, told.probability), told.error));
}

Robot ur10() {
  CapturedMessages captured;
  return load_robot(find_data_file("ur10", "robots"), captured.messages, true);
}

/// The same error at one sample, sd in every direction.
HandSpread ball_of(double sd) {
  return hand_shift(Vector3::Constant(sd), Vector::Ones(1));
}

/// An arm at rest, whose hand is off by sd in every direction.
void agree_at(const ArmClearance& arm, const Joints& q, double sd, bool self = false) {
  const HandPath still{{forward_kinematics(arm.robot(), q)}, q.transpose()};
  const Touching told = touching(arm, still.joints, ball_of(sd), {}, {.self = self});
  const Vector p = counted(arm, still, ball_of(sd), 0.0, self);
  std::cout << "told " << told.path.probability << " +- " << told.path.error << ", counted " << p[0] << " +- "
            << error_of(p[0], 0) << ", out of reach " << told.out_of_reach.probability << "\n";
  agree(told.path, p[0]);
}

/// A half space below `up`, `room` from the nearest link of the arm.
Solid wall(const Robot& robot, const Joints& q, const Vector3& up, double room) {
  Solid solid;
  solid.shape = SolidShape::plane;
  solid.pose = {Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), up).toRotationMatrix(), -3 * up};
  solid.pose.position += (ArmClearance(robot, {solid}).least(q) - room) * up;
  return solid;
}

}  // namespace

TEST_CASE("10000 sampled hand paths, by inverse kinematics and full distances, touch as often") {
  const Robot robot = ur10();
  const Pose tool{Matrix3::Identity(), {0, 0, 0.12}};
  Solid rod;
  rod.shape = SolidShape::cylinder;
  rod.pose = {rotation_from_rpy({0.3, 0.5, 0}), {-0.15, 0.66, 0.33}};
  rod.radius = 0.06;
  rod.length = 0.5;
  Solid shelf;
  shelf.shape = SolidShape::box;
  shelf.pose.position = {-0.45, 0.5, 0.75};
  shelf.size = {0.3, 0.3, 0.02};
  const ArmClearance arm(robot, {rod, shelf}, tool_capsule(tool, 0.01));

  // A hand path that passes both, the tool along y of the base.
  const Eigen::Index T = 12;
  const Matrix3 turned = rotation_from_rpy({-std::numbers::pi / 2, 0, 0});
  const auto pose_at = [&](const Vector3& tip) { return Pose{turned, tip} * inverse(tool); };
  std::vector<Pose> poses;
  Samples tips(T, 3);
  const Vector times = Vector::LinSpaced(T, 0, 3);
  for (Eigen::Index t = 0; t < T; ++t) {
    const double s = static_cast<double>(t) / static_cast<double>(T - 1);
    tips.row(t) << -0.32 + 0.42 * s, 0.45 + 0.25 * s, 0.58 + 0.05 * std::sin(std::numbers::pi * s) - 0.05 * s;
    poses.push_back(pose_at(tips.row(t).transpose()));
  }
  PathOptions elbow_up;
  elbow_up.seed = (Joints() << 2.9, -1.3, 4.0, 0.5, 0.2, 0.0).finished();
  const JointPath path = solve_path(robot, poses, times, elbow_up);
  REQUIRE(path.status == PathStatus::continuous);
  const double least = closest_approach(arm, path.joints).distance;

  for (const double sd : {0.004, 0.01, 0.02}) {
    std::vector<Matrix> covariance;
    for (const double part : {1.0, 0.7, 1.3}) {
      covariance.push_back(smooth(T, part * sd, 3) + Matrix::Identity(T, T) * 1e-8);
    }
    const HandSpread spread = hand_spread(covariance, Matrix3::Identity());
    // The same room in standard deviations for both, so that touching is neither rare nor sure.
    const double margin = least - 1.5 * sd;
    const Touching told = touching(arm, path.joints, spread, tool, {.margin = margin});
    const Vector p = counted(arm, {poses, path.joints}, spread, margin);
    std::cout << "touching, hand sd " << sd << " m: told " << told.path.probability << " +- " << told.path.error
              << ", counted " << p[T] << " +- " << error_of(p[T], 0) << "\n";
    CHECK(told.path.probability > 0.02);
    agree(told.path, p[T]);
    for (Eigen::Index t = 0; t < T; ++t) agree(told.samples[static_cast<std::size_t>(t)], p[t]);
  }
}

TEST_CASE("a tool before the face of a box touches as often as told") {
  const Robot robot = ur10();
  const Pose tool{Matrix3::Identity(), {0, 0, 0.12}};
  constexpr double away = 0.03;
  Solid box;
  box.shape = SolidShape::box;
  box.pose.position = {0.0, 0.8 + 0.5 + 0.01 + away, 0.5};  // its face 3 cm before the tip of a tool of radius 1 cm
  box.size = {2.0, 1.0, 2.0};
  const ArmClearance arm(robot, {box}, tool_capsule(tool, 0.01));
  const Eigen::Index T = 5;
  const Matrix3 turned = rotation_from_rpy({-std::numbers::pi / 2, 0, 0});
  std::vector<Pose> poses;
  for (Eigen::Index t = 0; t < T; ++t) {
    poses.push_back(Pose{turned, {-0.3 + 0.1 * static_cast<double>(t), 0.8, 0.5}} * inverse(tool));
  }
  const JointPath path = solve_path(robot, poses, Vector::LinSpaced(T, 0, 2));
  REQUIRE(path.status == PathStatus::continuous);
  REQUIRE(arm.least(path.joints.row(0).transpose()) == Approx(away).margin(1e-9));
  for (const double sd : {0.01, 0.02}) {
    const HandSpread spread = hand_spread({smooth(T, sd, 1), smooth(T, sd, 1), smooth(T, sd, 1)}, Matrix3::Identity());
    const double margin = away - 1.5 * sd;
    const Touching told = touching(arm, path.joints, spread, tool, {.margin = margin});
    const Vector p = counted(arm, {poses, path.joints}, spread, margin);
    std::cout << "before a face, hand sd " << sd << " m: told " << told.path.probability << " +- " << told.path.error
              << ", counted " << p[T] << " +- " << error_of(p[T], 0) << "\n";
    agree(told.path, p[T]);
    for (Eigen::Index t = 0; t < T; ++t) agree(told.samples[static_cast<std::size_t>(t)], p[t]);
  }
}

namespace {

/// Upper arm upright, forearm level.
const Joints upright =
    (Joints() << 0, -std::numbers::pi / 2, std::numbers::pi / 2, 0, -std::numbers::pi / 2, 0).finished();

}  // namespace

TEST_CASE("the far end of a link swings onto what its near end is closest to") {
  const Robot robot = ur10();
  // Under the forearm, 15 mm away at the elbow's end, which hardly moves, a little more at the other.
  Solid bar;
  bar.shape = SolidShape::box;
  bar.size = {0.3, 0.06, 0.02};
  bar.pose = {rotation_from_rpy({0, -0.005, std::numbers::pi}), {-0.271953, -0.048, 0.669551}};
  const ArmClearance arm(robot, {bar});
  REQUIRE(arm.least(upright) == Approx(0.015).margin(1e-3));
  for (const double sd : {0.008, 0.01}) agree_at(arm, upright, sd);
}

TEST_CASE("what moves the nearest link not at all, to first order, may still touch") {
  const Robot robot = ur10();
  // Over the elbow of an upright arm: to either side it goes down.
  for (const double room : {-0.0005, 0.0005}) {
    const ArmClearance arm(robot, {wall(robot, upright, -Vector3::UnitZ(), room)});
    agree_at(arm, upright, 0.02);
  }
  Robot ball = nominal_ur10();
  ball.links = {{"elbow", 2, {0, 0, 0}, {0, 0, 0}, 0.05}};
  for (const double room : {-0.0002, 0.0002}) {
    agree_at(ArmClearance(ball, {wall(ball, upright, Vector3::UnitZ(), room)}), upright, 0.02);
  }
}

TEST_CASE("a stretched arm and a singular wrist follow where they can") {
  const Robot robot = ur10();
  for (const double elbow : {0.0, 0.001, 0.1}) {
    const Joints q = (Joints() << 0.2, -1.0, elbow, -1.2, -1.5, 0.3).finished();
    const auto frames = joint_frames(robot, q);
    const Vector3 along = (frames[6].position - frames[1].position).normalized();
    const Vector3 across = frames[1].rotation.col(2).cross(along).normalized();
    agree_at(ArmClearance(robot, {wall(robot, q, across, 0.02)}), q, 0.005);
  }
  for (const double wrist : {0.0, 1e-4, 0.003, 0.03}) {
    const Joints q = (Joints() << 0.2, -1.4, 1.6, -1.0, wrist, 0.3).finished();
    const Vector3 ahead = forward_kinematics(robot, q).rotation.col(2);
    agree_at(ArmClearance(robot, {wall(robot, q, -ahead, 0.005)}), q, 0.01);
  }
}

TEST_CASE("the arm itself is touched as often as counted") {
  const Joints folded = (Joints() << 0.3, -1.6, 2.8, -1.9, -1.5, 0.2).finished();
  const ArmClearance arm(ur10(), {});
  REQUIRE(arm.least_of_arm_itself(folded) > 0);
  agree_at(arm, folded, 0.02, true);
}

TEST_CASE("an error along a wall moves nothing towards it") {
  const Robot robot = ur10();
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3 up = Vector3(random.normal(), random.normal(), random.normal()).normalized();
    Robot ball = nominal_ur10();
    ball.links = {{"ball", 6, {0, 0, 0}, {0, 0, 0}, 0.05}};
    const Matrix error = 1e-4 * up.unitOrthogonal() * up.unitOrthogonal().transpose();
    const HandSpread spread = hand_spread({error}, Matrix3::Identity());
    for (const double room : {-0.001, 0.001}) {
      const ArmClearance arm(ball, {wall(ball, upright, up, room)});
      const Chance told = touching(arm, upright.transpose(), spread).path;
      CHECK(std::abs(told.probability - (room < 0 ? 1 : 0)) <= 4 * told.error);
      CHECK(told.error < 0.03);
    }
  }
}
