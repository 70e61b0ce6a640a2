// Hand paths past singularities of the shoulder, the elbow and the wrist, and through a singular wrist.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/posture.hpp"
#include "lfdtools/ur_geometry.hpp"
#include "path_fixture.hpp"

using namespace lfd;

namespace {

enum Kind { shoulder, elbow, wrist };

/// The wrist centre so far along a straight line that passes beside the cylinder round the base axis.
Pose beside_base_axis(const UrGeometry& g, double along, double passing) {
  Pose pose;
  pose.rotation = rotation_from_rpy(Vector3(2.6, 0.4, 0.3));
  pose.position = Vector3(along, g.d4 + passing, 0.6) + g.d6 * pose.rotation.col(2);
  return pose;
}

double largest_step(const Samples& joints) {
  const Eigen::Index T = joints.rows();
  return (joints.bottomRows(T - 1) - joints.topRows(T - 1)).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a hand that passes a singularity at 1 mm, 1 cm, 10 cm is followed without a jump") {
  const InverseKinematics arm(nominal_ur10());
  const Robot& robot = arm.robot();
  const UrGeometry g = ur_geometry(robot);
  const auto kind = GENERATE(shoulder, elbow, wrist);
  const double passing = GENERATE(0.001, 0.01, 0.1);
  const auto solve = [&](Eigen::Index T) {
    std::vector<Pose> poses;
    for (Eigen::Index t = 0; t < T; ++t) {
      const double s = -1.0 + 2.0 * static_cast<double>(t) / static_cast<double>(T - 1);
      Pose pose;
      if (kind == shoulder) {  // a straight line of the wrist centre beside the cylinder round the base axis
        pose = beside_base_axis(g, 0.3 * s, passing);
      } else if (kind == elbow) {  // joint 4 goes out towards full reach and comes back
        const double reach = std::abs(g.a2) + std::abs(g.a3) - passing - 0.3 * s * s;
        const double a = std::abs(g.a2), b = std::abs(g.a3);
        Joints q;
        q << 0.2 + 0.3 * s, -0.9, std::acos((reach * reach - a * a - b * b) / (2 * a * b)), 0.4, 1.1, 0.3;
        pose = forward_kinematics(robot, q);
      } else {  // the tool axis tilts past the axis of joint 4, the hand at a fixed place
        Joints q;
        q << 0.2, -0.9, 1.2, 0.4, 0.0, 0.3;
        pose = forward_kinematics(robot, q);
        pose.rotation = pose.rotation * rotation_from_vector(Vector3(0.3 * s, passing, 0.0));
      }
      poses.push_back(pose);
    }
    return solve_path(arm, poses, Vector::LinSpaced(T, 0.0, 10.0));
  };
  INFO("kind " << kind << ", passing at " << passing << " m or rad");
  const JointPath coarse = solve(4000), fine = solve(8000);
  CHECK(coarse.status == PathStatus::continuous);
  CHECK(coarse.branch_changes == 0);
  CHECK(coarse.residual.maxCoeff() < 1e-9);
  CHECK(coarse.midpoint_deviation.maxCoeff() < 1e-3);
  // A jump would keep its size under finer sampling.
  CHECK(largest_step(fine.joints) < 0.55 * largest_step(coarse.joints));
}

TEST_CASE("a straight hand path past a singularity is continuous, or the reason why not has a name") {
  const InverseKinematics arm(nominal_ur10());
  const UrGeometry g = ur_geometry(arm.robot());
  const auto kind = GENERATE(shoulder, elbow, wrist);
  const double passing = GENERATE(-0.01, -0.001, 0.0, 0.001, 0.01, 0.1);
  INFO("kind " << kind << ", passing at " << passing);
  const auto solve = [&](int refinements) {
    constexpr Eigen::Index T = 60;
    std::vector<Pose> poses;
    for (Eigen::Index t = 0; t < T; ++t) {
      const double s = static_cast<double>(t) / (T - 1.0) - 0.5;
      Pose pose;
      if (kind == shoulder) {  // the wrist centre goes by the cylinder round the base axis, or through it
        pose = beside_base_axis(g, 0.6 * s, passing);
      } else if (kind == elbow) {  // out to so much before full reach, or beyond it
        Joints q;
        q << 0.2, -0.9, 0.0, 0.4, 1.1, 0.3;
        const auto frames = joint_frames(arm.robot(), q);
        const Vector3 out = (frames[3].position - frames[1].position).normalized();
        pose = frames[6];
        pose.position += (0.3 * (s - 0.5) - passing) * out;
      } else {  // the tool, level but for so much, comes by the line along joint 4
        pose.rotation = rotation_from_rpy(Vector3(std::numbers::pi / 2.0 + passing, 0.0, 0.0));
        pose.position = Vector3(0.7, -g.d4 - g.d6 + 0.4 * s, 0.4);
      }
      poses.push_back(pose);
    }
    PathOptions options;
    options.refinements = refinements;
    // Where the stretched elbow ends, another posture may still reach on.
    if (kind == elbow) options.branch = arm.branch((Joints() << 0.2, -0.9, 0.1, 0.3, 1.1, 0.3).finished());
    return solve_path(arm, poses, Vector::LinSpaced(T, 0.0, 10.0), options);
  };
  const JointPath path = solve(14);
  const bool reachable = kind == wrist || passing >= 0.0;
  if (reachable && !(kind == shoulder && passing == 0.0)) {
    CHECK(path.status == PathStatus::continuous);
    CHECK(path.reason.empty());
    CHECK(path.residual.maxCoeff() < 1e-9);
    CHECK(path.midpoint_deviation.maxCoeff() <= 0.005);
    CHECK(largest_step(path.joints) <= 0.5);
    CHECK(path.branch_changes == 0);
  } else if (!reachable) {
    CHECK(path.status != PathStatus::continuous);
    const char* why = kind == elbow ? "has no solution there" : "out of reach";
    CHECK(path.reason.find(why) != std::string::npos);
  }
}

TEST_CASE("samples with a singular wrist are crossed with the q6 of their neighbours") {
  const InverseKinematics arm(nominal_ur10());
  constexpr Eigen::Index T = 101;
  Samples joints(T, 6);
  for (Eigen::Index t = 0; t < T; ++t) {
    const double s = static_cast<double>(t) / (T - 1.0);
    joints.row(t) << 0.2 + 0.1 * s, -1.2 - 0.2 * s, 1.4, 0.3 * s, 0.0, 1.3 + 0.4 * s;
    const double beyond = std::max(0.0, std::abs(s - 0.5) - 0.15);
    joints(t, 4) = (s < 0.5 ? -1.0 : 1.0) * beyond;  // exactly 0 from sample 35 to 65
  }
  const Vector times = Vector::LinSpaced(T, 0.0, 5.0);
  for (const bool seeded : {false, true}) {
    PathOptions options;
    if (seeded) options.seed = joints.row(0).transpose();
    const JointPath path = solve_path(arm, poses_of(arm.robot(), joints), times, options);
    CHECK(path.status == PathStatus::continuous);
    CHECK(largest_step(path.joints) < 1.5 * largest_step(joints));
    if (seeded) CHECK((path.joints - joints).cwiseAbs().maxCoeff() < 0.05);
  }

  joints.col(4).setZero();  // singular all along: the arm moves in one plane
  joints.col(0).setConstant(0.3);
  const JointPath plane = solve_path(arm, poses_of(arm.robot(), joints), times);
  CHECK(plane.status == PathStatus::continuous);
  CHECK(largest_step(plane.joints) < 2.0 * largest_step(joints));
}

TEST_CASE("along a singular wrist rounding changes no branch, and a border is named as its neighbours are") {
  const InverseKinematics arm(nominal_ur10());
  Samples joints(6, 6);
  for (Eigen::Index t = 0; t < 6; ++t) {
    const auto s = static_cast<double>(t);
    joints.row(t) << 0.3, -1.2 - 0.05 * s, 1.4 + 0.02 * s, 0.1 * s, (t % 2 == 0 ? 1e-17 : -1.6e-16), 1.3 + 0.1 * s;
  }
  const Vector times = Vector::LinSpaced(6, 0.0, 5.0);
  const JointPath flat = solve_path(arm, poses_of(arm.robot(), joints), times);
  CHECK(flat.status == PathStatus::continuous);
  CHECK(flat.branch_changes == 0);

  CHECK(border_bits(arm, joints.row(0).transpose()) == 2);
  CHECK(branches_along(arm, joints) == std::vector<int>(6, arm.branch(joints.row(0).transpose())));
  joints(3, 4) = -0.1;  // the first to leave the border says what those before it are
  const int minus = arm.branch(joints.row(3).transpose());
  CHECK(branches_along(arm, joints) == std::vector<int>(6, minus));
  joints(0, 4) = 0.1;
  const int plus = arm.branch(joints.row(0).transpose());
  CHECK(branches_along(arm, joints) == std::vector<int>{plus, plus, plus, minus, minus, minus});
  CHECK(branches_along(arm, Samples(0, 6)).empty());

  joints.col(4) << -0.1, -0.05, 0.0, 0.0, 0.05, 0.1;  // a wrist that truly crosses changes once
  PathOptions options;
  options.seed = joints.row(0).transpose();
  const JointPath crossing = solve_path(arm, poses_of(arm.robot(), joints), times, options);
  CHECK(crossing.status == PathStatus::continuous);
  CHECK(crossing.branch_changes == 1);
}
