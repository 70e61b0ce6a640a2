#include "lfdtools/ur_geometry.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "arm_fixture.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/singularity.hpp"
#include "lfdtools/ur10.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

struct Axis {
  Vector3 point;
  Vector3 direction;
};

double signed_angle(const Vector3& from, const Vector3& to, const Vector3& about) {
  return std::atan2(from.cross(to).dot(about), from.dot(to));
}

/// The robot whose joint axes and flange, at q = 0, are those of `nominal` displaced by up to `size` [m, rad]: as a
/// calibration finds it. Its rows follow from the common normals, as the convention says.
Robot calibrated(const Robot& nominal, double size, Random& random) {
  const auto frames = joint_frames(nominal, Joints::Zero());
  const auto noise = [&] {
    return Vector3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  std::array<Axis, 6> axes;
  for (std::size_t i = 0; i < 6; ++i) {
    axes[i] = {frames[i].position, frames[i].rotation.col(2)};
    if (i == 0) continue;
    axes[i].point += noise();
    axes[i].direction = (axes[i].direction + noise()).normalized();
  }
  Robot robot = nominal;
  Vector3 x = Vector3::UnitX(), origin = Vector3::Zero();
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3 z = axes[i].direction;
    Vector3 next_x, foot_here, foot_next, next_z = z;
    if (i < 5) {
      next_z = axes[i + 1].direction;
      const Vector3 n = z.cross(next_z);
      const Vector3 between = axes[i + 1].point - axes[i].point;
      foot_here = axes[i].point + between.cross(next_z).dot(n) / n.squaredNorm() * z;
      foot_next = axes[i + 1].point + between.cross(z).dot(n) / n.squaredNorm() * next_z;
      next_x = n.normalized();
    } else {
      const Vector3 flange_x = frames[6].rotation.col(0);
      next_x = (flange_x - flange_x.dot(z) * z).normalized();
      foot_here = foot_next = axes[5].point + (frames[6].position - axes[5].point).dot(z) * z;
    }
    robot.dh[i] = {(foot_next - foot_here).dot(next_x), signed_angle(z, next_z, next_x), (foot_here - origin).dot(z),
                   signed_angle(x, next_x, z)};
    x = next_x;
    origin = foot_next;
  }
  return robot;
}

}  // namespace

TEST_CASE("an uncalibrated arm is taken from its rows, zero offsets included") {
  Robot robot = nominal_ur10();
  robot.dh[3].theta = 0.5;
  const UrGeometry g = ur_geometry(robot);
  CHECK(g.exact);
  CHECK(g.a3 == -0.5723);
  CHECK(g.offset[3] == 0.5);
  const InverseKinematics arm(robot);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Pose pose = forward_kinematics(robot, random_joints(random));
    const IkSolutions found = arm(pose);
    CHECK(found.size() >= 2);
    for (const IkSolution& s : found) CHECK(distance(forward_kinematics(robot, s.joints), pose).largest() < 1e-12);
  }
}

TEST_CASE("lengths and offsets of an exact arm are measured back from its axes") {
  Random random(2);
  Robot robot = nominal_ur10();
  for (DhRow& row : robot.dh) row.theta = random.uniform(-0.5, 0.5);
  const UrGeometry expected = ur_geometry(robot);
  robot.dh[5].a = 1e-300;  // counts as calibrated, changes nothing
  const UrGeometry g = ur_geometry(robot);
  CHECK_FALSE(g.exact);
  CHECK(g.d1 == Approx(expected.d1));
  CHECK(g.a2 == Approx(expected.a2));
  CHECK(g.a3 == Approx(expected.a3));
  CHECK(g.d4 == Approx(expected.d4));
  CHECK(g.d5 == Approx(expected.d5));
  CHECK(g.d6 == Approx(expected.d6));
  CHECK((g.offset - expected.offset).norm() < 1e-12);
}

TEST_CASE("calibrated arms are solved to 1e-9, the original joints among the solutions") {
  Random random(3);
  double largest_row = 0.0;
  int unsolved = 0;
  // |sin q5| of the poses, nothing where it is random, and how many of a thousand may be missed: two solutions that
  // nearly coincide.
  struct Kind {
    double wrist;
    int allowed;
    int missed = 0;
  };
  std::array<Kind, 6> kinds = {{{0.0, 0}, {1e-4, 10}, {1e-3, 5}, {3e-3, 2}, {1e-2, 0}, {3e-2, 0}}};
  for (int k = 0; k < 10; ++k) {
    const Robot robot = calibrated(nominal_ur10(), 2e-3, random);
    for (const DhRow& row : robot.dh) largest_row = std::max(largest_row, std::abs(row.d));
    // The rows describe the displaced arm, not something else.
    CHECK(distance(forward_kinematics(robot, Joints::Zero()), forward_kinematics(nominal_ur10(), Joints::Zero()))
              .largest() < 0.02);
    const UrGeometry g = ur_geometry(robot);
    CHECK(g.a2 == Approx(-0.612).margin(0.01));
    CHECK(g.d4 == Approx(0.163941).margin(0.01));
    const InverseKinematics arm(robot);
    for (Kind& kind : kinds) {
      for (int i = 0; i < 100; ++i) {
        Joints q = random_joints(random);
        if (kind.wrist > 0.0) q[4] = (i % 2 == 0 ? 0.0 : pi) + (i % 4 < 2 ? kind.wrist : -kind.wrist) - g.offset[4];
        const SingularityDistances clear = singularity_distances(g, q);
        if (std::min(clear.shoulder, clear.elbow) < 0.05) {
          --i;
          continue;
        }
        const Pose pose = forward_kinematics(robot, q);
        double nearest = 10.0;
        const IkSolutions found = arm(pose);
        for (std::size_t s = 0; s < found.size(); ++s) {
          CHECK(distance(forward_kinematics(robot, found[s].joints), pose).largest() < 1e-9);
          CHECK(found[s].branch == arm.branch(found[s].joints));
          if (s > 0) CHECK(found[s - 1].branch <= found[s].branch);
          double apart = 0.0;
          for (int j = 0; j < 6; ++j) {
            apart = std::max(apart, std::abs(std::remainder(found[s].joints[j] - q[j], 2 * pi)));
          }
          nearest = std::min(nearest, apart);
        }
        unsolved += found.empty() ? 1 : 0;
        kind.missed += nearest < 1e-4 ? 0 : 1;
      }
    }
  }
  CHECK(largest_row > 50.0);  // common normals of nearly parallel axes are far away: the hard case is in the test
  for (const Kind& kind : kinds) {
    INFO("|sin q5| " << kind.wrist);
    CHECK(kind.missed <= kind.allowed);
  }
  CHECK(unsolved == 0);
}

TEST_CASE("calibrated arms keep their solutions beside two singularities at once") {
  Random random(5);
  const auto stretched = [&](Joints& q, const Robot&) {
    q[2] = random.uniform(-0.1, 0.1);
    q[4] = random.uniform(-0.1, 0.1);
  };
  const auto folded = [&](Joints& q, const Robot&) { q[2] = pi + random.uniform(-0.1, 0.1); };
  const auto beside_axis = [&](Joints& q, const Robot& robot) {  // the wrist centre within 1 cm of where it cannot be
    const UrGeometry g = ur_geometry(robot);
    double distance = 1.0;
    while (!(distance > 0.0 && distance < 0.01)) {
      q = random_joints(random);
      const Pose pose = forward_kinematics(robot, q);
      const Vector3 wrist = pose.position - g.d6 * pose.rotation.col(2);
      distance = wrist.head<2>().norm() - std::abs(g.d4);
    }
  };
  int missed = 0, unsolved = 0, poses = 0;
  const auto look = [&](const Robot& robot, const auto& place) {
    const InverseKinematics arm(robot);
    for (int i = 0; i < 50; ++i) {
      Joints q = random_joints(random);
      place(q, robot);
      const Pose pose = forward_kinematics(robot, q);
      const IkSolutions found = arm(pose);
      double nearest = 10.0;
      for (const IkSolution& s : found) {
        CHECK(distance(forward_kinematics(robot, s.joints), pose).largest() < 1e-9);
        const Joints apart = (s.joints - q).unaryExpr([](double angle) { return wrap_angle(angle); });
        nearest = std::min(nearest, s.wrist_free ? 0.0 : apart.cwiseAbs().maxCoeff());
      }
      ++poses;
      unsolved += found.empty() ? 1 : 0;
      missed += nearest < 1e-3 ? 0 : 1;
    }
  };
  for (int k = 0; k < 12; ++k) {
    Robot robot = k % 3 == 0 ? nominal_ur10() : calibrated(nominal_ur10(), k % 3 == 1 ? 1e-3 : 3e-3, random);
    if (k % 3 == 0) robot.dh[1].d = 1e-7;  // hardly calibrated; nearly parallel axes would meet too far away for this
    look(robot, stretched);
    look(robot, folded);
    look(robot, beside_axis);
  }
  INFO(missed << " of " << poses << " missed, " << unsolved << " not solved at all");
  CHECK(poses == 1800);
  CHECK(unsolved == 0);
  CHECK(missed <= 2);
}

TEST_CASE("a calibrated arm is solved where the exact arm's own q6 does not let the elbow close") {
  Robot robot = nominal_ur10();
  robot.dh[0] = {1e-4, 1.570796327, 0.1273, 0.0};
  robot.dh[1].alpha = -5e-4;
  robot.dh[2].alpha = 1e-3;
  Joints q;
  q << -2.991524, 2.926248, -0.440025, -0.965798, 0.000484, -2.346605;
  double nearest = 10.0;
  for (const IkSolution& s : InverseKinematics(robot)(forward_kinematics(robot, q))) {
    nearest = std::min(nearest, (s.joints - q).cwiseAbs().maxCoeff());
  }
  CHECK(nearest < 1e-6);
}

TEST_CASE("where a calibrated wrist is parallel, q6 is the one asked for, once for each arm") {
  Robot robot = nominal_ur10();
  robot.dh[5].a = 1e-300;  // counts as calibrated, changes nothing
  const InverseKinematics arm(robot), exact(nominal_ur10());
  Joints q;
  q << 0.3, -1.2, 1.4, 0.2, 0.0, 0.7;
  const Pose pose = forward_kinematics(robot, q);
  IkOptions options;
  options.seed = q;
  const IkSolutions found = arm(pose, options), expected = exact(pose, options);
  REQUIRE(found.size() == expected.size());
  double nearest = 10.0;
  int free = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].wrist_free == expected[i].wrist_free);
    free += found[i].wrist_free ? 1 : 0;
    nearest = std::min(nearest, (found[i].joints - q).cwiseAbs().maxCoeff());
  }
  CHECK(free == 2);
  CHECK(nearest < 1e-6);
}

TEST_CASE("other arms are refused") {
  Robot robot = nominal_ur10();
  robot.dh[1].alpha = pi / 2;
  CHECK_THROWS_AS(ur_geometry(robot), ConfigError);
  robot = nominal_ur10();
  robot.dh[2].a = 0.0;
  CHECK_THROWS_AS(ur_geometry(robot), ConfigError);
  robot.dh[2].alpha = 1e-4;
  CHECK_THROWS_AS(InverseKinematics(robot), ConfigError);
}
