#include "lfdtools/touching.hpp"

#include <Eigen/Geometry>
#include <algorithm>
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

using namespace lfd;

namespace {

double normal_tail(double c) {
  return 0.5 * std::erfc(c / std::sqrt(2.0));
}

Solid plane(const Vector3& position, const Vector3& up) {
  Solid solid;
  solid.shape = SolidShape::plane;
  solid.pose = {Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), up).toRotationMatrix(), position};
  return solid;
}

/// An arm whose only body is a ball at the flange.
Robot ball() {
  Robot robot = nominal_ur10();
  robot.links = {{"ball", 6, {0, 0, 0}, {0, 0, 0}, 0.05}};
  return robot;
}

const Joints bent = (Joints() << 0.3, -1.8, 1.9, -1.4, -1.5, 0.2).finished();

Vector3 hand() {
  return forward_kinematics(nominal_ur10(), bent).position;
}

Samples still(Eigen::Index T) {
  return bent.transpose().replicate(T, 1);
}

/// Told within four of its own standard errors, which are no excuse.
bool is(const Chance& told, double p) {
  CAPTURE(told.probability, told.error, p);
  CHECK(told.error <= 0.03 * p);
  return std::abs(told.probability - p) <= 4 * told.error + 1e-9 * p;
}

}  // namespace

TEST_CASE("joints and spread of different samples are refused") {
  const ArmClearance arm(ball(), {});
  CHECK(refusal_of([&] { (void)touching(arm, still(3), HandSpread{Matrix::Zero(6, 1)}); }).id == "touching.shape");
}

TEST_CASE("one plane: the normal tail, also far out, and with a margin") {
  for (const double room : {-0.01, 0.0, 0.02, 0.06}) {
    const ArmClearance arm(ball(), {plane(hand() - Vector3(0, 0, 0.05 + room), Vector3::UnitZ())});
    const HandSpread spread = hand_spread({Matrix::Identity(3, 3) * 1e-4}, Matrix3::Identity());
    const Touching result = touching(arm, still(1), spread);
    CHECK(result.path.probability == result.samples[0].probability);
    CHECK(is(result.path, normal_tail(room / 0.01)));
    CHECK(is(touching(arm, still(1), spread, {}, {.margin = 0.005}).path, normal_tail((room - 0.005) / 0.01)));
  }
}

TEST_CASE("two walls at right angles are independent, two that face each other exclude each other") {
  const auto chance = [](double first, double second, const Vector3& up) {
    const ArmClearance arm(ball(), {plane(hand() - Vector3(0, 0, 0.05 + first), Vector3::UnitZ()),
                                    plane(hand() - (0.05 + second) * up, up)});
    const HandSpread spread = hand_spread({Matrix::Identity(3, 3) * 1e-4}, Matrix3::Identity());
    return touching(arm, still(1), spread).path;
  };
  for (const double room : {0.0, 0.01, 0.03, 0.055}) {
    const double p = normal_tail(room / 0.01);
    CHECK(is(chance(room, room, Vector3::UnitX()), 2 * p - p * p));
    CHECK(is(chance(room, room, -Vector3::UnitZ()), std::min(1.0, 2 * p)));
  }
}

TEST_CASE("samples that err together touch together, those that err apart add up") {
  const ArmClearance arm(ball(), {plane(hand() - Vector3(0, 0, 0.05 + 0.02), Vector3::UnitZ())});
  const Eigen::Index T = 40;
  const double p = normal_tail(2);
  const auto path_chance = [&](const Matrix& A) {
    return touching(arm, still(T), hand_spread({A, A, A}, Matrix3::Identity())).path;
  };
  CHECK(is(path_chance(Matrix::Constant(T, T, 1e-4)), p));
  CHECK(is(path_chance(Matrix::Identity(T, T) * 1e-4), 1 - std::pow(1 - p, T)));
  // A shift of everything, told as such.
  const auto shifted = hand_shift({0, 0, 0.01}, Vector::Ones(T));
  CHECK(is(touching(arm, still(T), shifted).path, p));
}

TEST_CASE("without spread it is certain or impossible, and the same call says the same") {
  const auto arm = [](double room) {
    return ArmClearance(ball(), {plane(hand() - Vector3(0, 0, 0.05 + room), Vector3::UnitZ())});
  };
  const HandSpread none{Matrix::Zero(6, 1)};
  CHECK(touching(arm(0.001), still(2), none).path.probability == 0);
  CHECK(touching(arm(-0.001), still(2), none).path.probability == 1);
  const HandSpread spread =
      hand_spread({smooth(9, 0.01, 2), smooth(9, 0.01, 2), smooth(9, 0.01, 2)}, Matrix3::Identity());
  const Touching a = touching(arm(0.01), still(9), spread), b = touching(arm(0.01), still(9), spread);
  CHECK(a.path.probability == b.path.probability);
  CHECK(touching(arm(0.01), still(9), spread, {}, {.seed = 2}).path.probability != a.path.probability);
}

TEST_CASE("a ball beside a ball: the closed form of a shifted normal's radius, also where it is rare") {
  // Distance of the centres, sum of the radii and standard deviation: |x| <= radius where x is normal about `away`.
  const Robot robot = ball();
  constexpr double sd = 0.02;
  const HandSpread spread = hand_spread({Matrix::Identity(3, 3) * sd * sd}, Matrix3::Identity());
  for (const double radius : {0.055, 0.08, 0.2}) {
    for (const double room : {-0.01, 0.01, 0.05, 0.12}) {
      Solid other;
      other.shape = SolidShape::sphere;
      other.radius = radius - 0.05;
      const double away = radius + room;
      other.pose.position = hand() + away * Vector3(1, -2, 2) / 3;
      const double near = (radius - away) / sd, far = (radius + away) / sd;
      const double p =
          normal_tail(-near) - normal_tail(far) -
          sd / away / std::sqrt(2 * std::numbers::pi) * (std::exp(-0.5 * near * near) - std::exp(-0.5 * far * far));
      CAPTURE(radius, room);
      const Chance told = touching(ArmClearance(robot, {other}), still(1), spread).path;
      // A small ball takes up little of the half space that holds it: more draws are in vain.
      CHECK(told.error <= 0.25 * p);
      CHECK(std::abs(told.probability - p) <= 4 * told.error + 2e-3 * p);
    }
  }
}

TEST_CASE("a ball before a box's face, edge and corner touches as often as counted") {
  // A ball of 1 cm whose surface is 1 cm from the box, and an error of 1 cm along each axis.
  Robot robot = nominal_ur10();
  robot.links = {{"ball", 6, {0, 0, 0}, {0, 0, 0}, 0.01}};
  constexpr double size = 0.4, away = 0.02;
  const HandSpread spread = hand_spread({Matrix::Identity(3, 3) * 1e-4}, Matrix3::Identity());
  for (const Vector3& side : {Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(1, 1, 1)}) {
    Solid box;
    box.shape = SolidShape::box;
    box.size = Vector3::Constant(size);
    box.pose.position = hand() - 0.5 * size * side - away * side.normalized();
    const Chance told = touching(ArmClearance(robot, {box}), still(1), spread).path;
    Random random(5);
    constexpr int many = 100'000;
    int touched = 0;
    for (int i = 0; i < many; ++i) {
      Vector3 at = hand() - box.pose.position;
      for (double& x : at) x += 0.01 * random.normal();
      if ((at.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm() <= 0.01) ++touched;
    }
    const double p = static_cast<double>(touched) / many;
    CHECK(told.error < 0.05 * p);
    CHECK(std::abs(told.probability - p) <= 4 * std::hypot(told.error, std::sqrt(p * (1 - p) / many)));
  }
}
