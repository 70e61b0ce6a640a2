#include "lfdtools/path.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

/// A smooth joint motion: a few slow waves a joint about a random posture.
Samples smooth_joints(Random& random, Eigen::Index T, double size) {
  Samples joints(T, 6);
  for (int j = 0; j < 6; ++j) {
    const double centre = random.uniform(-2.0, 2.0);
    double amplitude[3], shift[3];
    for (int k = 0; k < 3; ++k)
      amplitude[k] = random.uniform(-size, size) / (k + 1), shift[k] = random.uniform(0.0, 2 * pi);
    for (Eigen::Index t = 0; t < T; ++t) {
      joints(t, j) = centre;
      for (int k = 0; k < 3; ++k) {
        joints(t, j) +=
            amplitude[k] * std::sin((k + 1) * pi * static_cast<double>(t) / static_cast<double>(T) + shift[k]);
      }
    }
  }
  return joints;
}

std::vector<Pose> poses_of(const Robot& robot, const Samples& joints) {
  std::vector<Pose> poses;
  for (Eigen::Index t = 0; t < joints.rows(); ++t)
    poses.push_back(forward_kinematics(robot, joints.row(t).transpose()));
  return poses;
}

double largest_ratio(const Robot& robot, const Samples& joints, const Vector& times) {
  double largest = 0.0;
  for (Eigen::Index t = 1; t < joints.rows(); ++t) {
    const Joints step = (joints.row(t) - joints.row(t - 1)).transpose().cwiseAbs().cwiseQuotient(robot.limits.velocity);
    largest = std::max(largest, step.maxCoeff() / (times[t] - times[t - 1]));
  }
  return largest;
}

double largest_step(const Samples& joints) {
  const Eigen::Index T = joints.rows();
  return (joints.bottomRows(T - 1) - joints.topRows(T - 1)).cwiseAbs().maxCoeff();
}

/// Largest step of a solver that starts nearest to given joints and goes to the nearest solution from sample to sample.
double greedy_step(const InverseKinematics& arm, const std::vector<Pose>& poses, const Joints& start) {
  const auto nearest_to = [](const IkSolutions& found, const Joints& q) {
    const auto apart = [&](const IkSolution& s) {
      double step = 0.0;
      for (int j = 0; j < 6; ++j) step = std::max(step, std::abs(std::remainder(s.joints[j] - q[j], 2 * pi)));
      return step;
    };
    const auto closer = [&](const IkSolution& a, const IkSolution& b) { return apart(a) < apart(b); };
    const IkSolution& best = *std::min_element(found.begin(), found.end(), closer);
    return std::make_pair(best.joints, apart(best));
  };
  Joints q = nearest_to(arm(poses[0]), start).first;
  double largest = 0.0;
  for (const Pose& pose : poses) {
    const auto [next, step] = nearest_to(arm(pose), q);
    if (&pose != &poses[0]) largest = std::max(largest, step);
    q = next;
  }
  return largest;
}

double worst_pose_error(const Robot& robot, const Samples& joints, const std::vector<Pose>& poses) {
  double worst = 0.0;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    const Joints q = joints.row(static_cast<Eigen::Index>(t)).transpose();
    worst = std::max(worst, distance(forward_kinematics(robot, q), poses[t]).largest());
  }
  return worst;
}

}  // namespace

TEST_CASE("hand paths of smooth joint motions are followed without a jump, where going to the nearest solution fails") {
  const InverseKinematics arm(nominal_ur10());
  Random random(1);
  constexpr Eigen::Index T = 150;
  const Vector times = Vector::LinSpaced(T, 0.0, 10.0);
  int failures = 0, slower = 0, greedy_failures = 0, greedy_seeded_failures = 0, seeded_elsewhere = 0;
  for (int i = 0; i < 1000; ++i) {
    PathOptions options;
    const Samples joints = smooth_joints(random, T, 1.2);
    const std::vector<Pose> poses = poses_of(arm.robot(), joints);
    const JointPath path = solve_path(arm, poses, times);
    REQUIRE(path.joints.rows() == T);
    failures += path.status == PathStatus::continuous ? 0 : 1;
    const double known = largest_ratio(arm.robot(), joints, times);
    slower += path.largest_step_ratio > 1.1 * known + 1e-6 ? 1 : 0;
    CHECK(path.largest_step_ratio == Approx(largest_ratio(arm.robot(), path.joints, times)));
    CHECK(worst_pose_error(arm.robot(), path.joints, poses) < 1e-9);
    CHECK(path.joints.cwiseAbs().maxCoeff() <= 2 * pi);
    greedy_failures += greedy_step(arm, poses, Joints::Zero()) > options.max_step ? 1 : 0;
    greedy_seeded_failures += greedy_step(arm, poses, joints.row(0).transpose()) > options.max_step ? 1 : 0;

    options.seed = joints.row(0).transpose();
    const JointPath seeded = solve_path(arm, poses, times, options);
    failures += seeded.status == PathStatus::continuous ? 0 : 1;
    seeded_elsewhere += (seeded.joints.row(0) - joints.row(0)).cwiseAbs().maxCoeff() < 1e-5 ? 0 : 1;
  }
  INFO("jumps in 1000 paths: nearest solution " << greedy_failures << ", from known joints " << greedy_seeded_failures
                                                << "; here " << failures << " in 2000");
  CHECK(failures == 0);
  CHECK(slower == 0);
  CHECK(seeded_elsewhere == 0);
  CHECK(greedy_failures > 50);  // the comparison means something
}

TEST_CASE("a hand that passes a singularity at 1 mm, 1 cm, 10 cm is followed without a jump") {
  const InverseKinematics arm(nominal_ur10());
  const Robot& robot = arm.robot();
  const UrGeometry g = ur_geometry(robot);
  enum Kind { shoulder, elbow, wrist };
  const auto kind = GENERATE(shoulder, elbow, wrist);
  const double passing = GENERATE(0.001, 0.01, 0.1);
  const auto solve = [&](Eigen::Index T) {
    std::vector<Pose> poses;
    for (Eigen::Index t = 0; t < T; ++t) {
      const double s = -1.0 + 2.0 * static_cast<double>(t) / static_cast<double>(T - 1);
      Pose pose;
      if (kind == shoulder) {  // a straight line of the wrist centre beside the cylinder round the base axis
        pose.rotation = rotation_from_rpy(Vector3(2.6, 0.4, 0.3));
        pose.position = Vector3(0.3 * s, g.d4 + passing, 0.6) + g.d6 * pose.rotation.col(2);
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
  enum Kind { shoulder, elbow, wrist };
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
        pose.rotation = rotation_from_rpy(Vector3(2.6, 0.4, 0.3));
        pose.position = Vector3(0.6 * s, g.d4 + passing, 0.6) + g.d6 * pose.rotation.col(2);
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

TEST_CASE("rows are put between samples that are too far apart, and only there") {
  const InverseKinematics arm(nominal_ur10());
  const Matrix3 down = rotation_from_rpy(Vector3(pi, 0.0, 0.0));
  const std::vector<Pose> poses = {
      {down, Vector3(0.4, -0.5, 0.3)}, {down, Vector3(0.41, -0.5, 0.3)}, {down, Vector3(0.5, 0.5, 0.4)}};
  Vector times(3);
  times << 0.0, 0.5, 2.5;
  PathOptions options;
  CHECK(solve_path(arm, poses, times, options).status == PathStatus::jump);
  options.refinements = 6;
  const JointPath path = solve_path(arm, poses, times, options);
  CHECK(path.status == PathStatus::continuous);
  REQUIRE(path.times.size() > 6);
  REQUIRE(path.joints.rows() == path.times.size());
  CHECK(path.given.size() == static_cast<std::size_t>(path.times.size()));
  CHECK(path.given[1] == 1);
  CHECK(!path.inserted(1));
  CHECK(path.inserted(2));
  CHECK(path.given.back() == 2);
  CHECK(!path.inserted(path.given.size() - 1));
  CHECK(path.midpoint_deviation.maxCoeff() <= options.midpoint_tolerance);
  for (Eigen::Index t = 1; t < path.times.size(); ++t) {
    CHECK(path.times[t] > path.times[t - 1]);
    const double share = (path.times[t] - times[1]) / (times[2] - times[1]);
    if (share < 0.0) continue;
    const Pose wanted = interpolate(poses[1], poses[2], share);
    CHECK(distance(forward_kinematics(arm.robot(), path.joints.row(t).transpose()), wanted).largest() < 1e-9);
  }

  // A hand that leaps: finer sampling does not help where the way between goes through the base.
  const std::vector<Pose> across = {{down, Vector3(0.5, -0.5, 0.3)}, {down, Vector3(-0.5, 0.5, 0.3)}};
  const JointPath leap = solve_path(arm, across, Vector::LinSpaced(2, 0.0, 1.0), options);
  CHECK(leap.status == PathStatus::jump);
  CHECK(leap.sample == 1);
  CHECK(leap.reason.find("the way between is out of reach") != std::string::npos);
  CHECK(leap.times.size() == 2);
}

TEST_CASE("a branch is kept where it can be, and the path named that leaves it where not") {
  const InverseKinematics arm(nominal_ur10());
  constexpr Eigen::Index T = 40;
  const Vector times = Vector::LinSpaced(T, 0.0, 4.0);
  std::vector<Pose> line;
  for (Eigen::Index t = 0; t < T; ++t) {
    line.push_back({rotation_from_rpy(Vector3(pi, 0.0, 0.0)), Vector3(0.4 + 0.01 * static_cast<double>(t), 0.3, 0.3)});
  }
  for (int branch = 0; branch < 8; ++branch) {
    PathOptions options;
    options.branch = branch;
    const JointPath path = solve_path(arm, line, times, options);
    INFO(branch_name(branch));
    CHECK(path.status == PathStatus::continuous);
    for (Eigen::Index t = 0; t < T; ++t) CHECK(arm.branch(path.joints.row(t).transpose()) == branch);
  }
  Robot bent_one_way = arm.robot();
  bent_one_way.limits.position.row(2) << 0.0, 3.0;
  PathOptions options;
  options.branch = 1;  // elbow-
  const JointPath other = solve_path(bent_one_way, line, times, options);
  CHECK(other.status == PathStatus::other_branch);
  CHECK(other.joints.rows() == T);
  CHECK((other.branch[0] & 1) == 0);
  CHECK(other.reason.find("left-wrist+-elbow-") != std::string::npos);
  CHECK(other.reason.find("there is a path in " + branch_name(other.branch[0])) != std::string::npos);
  CHECK(other.faults.size() == 1);
  CHECK(other.sample == 0);
  options.branch = 0;
  CHECK(solve_path(bent_one_way, line, times, options).status == PathStatus::continuous);

  // A path over the wrist singularity itself is kept in one branch up to there, and no further.
  std::vector<Pose> over;
  for (Eigen::Index t = 0; t < T; ++t) {
    Joints q;
    q << 0.2, -1.2, 1.4, 0.3, 0.02 * static_cast<double>(t - 20), 1.3;
    over.push_back(forward_kinematics(arm.robot(), q));
  }
  options.branch = arm.branch((Joints() << 0.2, -1.2, 1.4, 0.3, -0.4, 1.3).finished());
  const JointPath crossing = solve_path(arm, over, times, options);
  CHECK(crossing.status == PathStatus::other_branch);
  CHECK(crossing.branch_changes == 1);
  CHECK(crossing.faults.size() == 1);
  CHECK(crossing.reason.find("there is a path") == std::string::npos);  // it changes over

  // One fault does not hide another: the path in another branch jumps, and leaves the hand's path midway.
  options.branch = 1;
  const JointPath worse = solve_path(bent_one_way, {line[0], {line[0].rotation, Vector3(-0.4, -0.5, 0.3)}},
                                     Vector::LinSpaced(2, 0.0, 1.0), options);
  REQUIRE(worse.faults.size() == 3);
  CHECK(worse.status == PathStatus::other_branch);
  CHECK(worse.reason == worse.faults[0].reason);
  CHECK(worse.reason.find("there is a path") == std::string::npos);
  CHECK(worse.faults[1].status == PathStatus::jump);
  CHECK(worse.faults[1].sample == 1);
  CHECK(worse.faults[2].status == PathStatus::deviates);
  CHECK(worse.faults[2].sample == 1);

  options.branch = 8;
  CHECK_THROWS_AS(solve_path(arm, line, times, options), UsageError);
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

TEST_CASE("where there is no path, the result says where and why") {
  const InverseKinematics arm(nominal_ur10());
  constexpr Eigen::Index T = 60;
  const Vector times = Vector::LinSpaced(T, 0.0, 3.0);
  std::vector<Pose> line;
  for (Eigen::Index t = 0; t < T; ++t) {
    line.push_back({rotation_from_rpy(Vector3(pi, 0.0, 0.0)), Vector3(0.4 + 0.01 * static_cast<double>(t), 0.3, 0.3)});
  }
  CHECK(solve_path(arm, line, times).status == PathStatus::continuous);

  auto far = line;
  far[20].position.x() = 3.0;
  far[50].position.z() = 9.0;
  const JointPath out = solve_path(arm, far, times);
  CHECK(out.status == PathStatus::unreachable);
  CHECK(out.sample == 20);
  CHECK(out.unreachable == std::vector<Eigen::Index>{20, 50});
  CHECK(out.joints.rows() == 0);

  auto leap = line;
  for (std::size_t t = 30; t < leap.size(); ++t) leap[t].position.y() = -0.6;
  const JointPath jump = solve_path(arm, leap, times);
  CHECK(jump.status == PathStatus::jump);
  CHECK(jump.sample == 30);
  CHECK(jump.joints.rows() == T);

  Robot narrow = arm.robot();
  narrow.limits.position.row(0) << 3.0, 3.1;
  CHECK(solve_path(narrow, line, times).status == PathStatus::outside_limits);
  PathOptions free;
  free.respect_limits = false;
  CHECK(solve_path(narrow, line, times, free).status == PathStatus::continuous);

  const std::vector<Pose> sparse = {line[0], line[15]};
  PathOptions strict;
  strict.midpoint_tolerance = 1e-3;
  const JointPath off = solve_path(arm, sparse, Vector::LinSpaced(2, 0.0, 3.0), strict);
  CHECK(off.status == PathStatus::deviates);
  CHECK(off.midpoint_deviation[1] > 1e-3);
}

TEST_CASE("one sample, a resting hand, and inputs that cannot be") {
  const InverseKinematics arm(nominal_ur10());
  const Pose pose{rotation_from_rpy(Vector3(pi, 0.0, 0.0)), Vector3(0.5, 0.3, 0.3)};
  const JointPath one = solve_path(arm, {pose}, Vector::Zero(1));
  CHECK(one.status == PathStatus::continuous);
  double smallest = 1e9;
  for (const IkSolution& s : arm(pose)) smallest = std::min(smallest, s.joints.squaredNorm());
  CHECK(one.joints.row(0).squaredNorm() == Approx(smallest));
  const JointPath rest = solve_path(arm, {pose, pose, pose}, Vector::LinSpaced(3, 0.0, 1.0));
  CHECK(rest.joints.row(2) == one.joints.row(0));
  CHECK(rest.condition[1] == condition_number(jacobian(arm.robot(), rest.joints.row(1).transpose())));

  const auto id_of = [&](const std::vector<Pose>& poses, const Vector& times, const PathOptions& options = {}) {
    try {
      (void)solve_path(arm, poses, times, options);
    } catch (const Error& error) {
      return error.id();
    }
    return std::string();
  };
  CHECK(id_of({}, Vector()) == "path.shape");
  CHECK(id_of({pose, pose}, Vector::Zero(2)) == "path.time_not_rising");
  CHECK(id_of({pose}, Vector::Constant(1, std::nan(""))) == "path.not_finite");
  Pose skewed = pose;
  skewed.rotation(0, 0) += 1e-3;
  CHECK(id_of({skewed}, Vector::Zero(1)) == "ur10.pose_not_rigid");
  PathOptions options;
  options.step_slack = 0.9;
  CHECK(id_of({pose}, Vector::Zero(1), options) == "path.options");
}

TEST_CASE("rows at rest at both ends are left out, and those that hardly differ between") {
  JointPath path;
  const std::vector<double> along = {0, 4e-4, -3e-4, 0.01, 0.01005, 0.02, 0.05, 0.0491, 0.0503, 0.0496, 0.05};
  const auto T = static_cast<Eigen::Index>(along.size());
  path.times = Vector::LinSpaced(T, 0, 1);
  path.joints = Samples::Zero(T, 6);
  path.residual = path.condition = path.midpoint_deviation = path.times;
  for (Eigen::Index t = 0; t < T; ++t) {
    path.joints(t, 2) = along[static_cast<std::size_t>(t)];
    path.branch.push_back(static_cast<int>(t));
    path.given.push_back(t);
  }
  const JointPath moving = without_rest(path, 1e-3);
  CHECK(moving.given == std::vector<Eigen::Index>{0, 3, 5, 10});
  CHECK(moving.branch == std::vector<int>{0, 3, 5, 10});
  REQUIRE(moving.joints.rows() == 4);
  CHECK(moving.joints(1, 2) == 0.01);
  CHECK(moving.times[3] == 1);
  CHECK(moving.condition[2] == path.condition[5]);
  const JointPath still = without_rest(moving, 1.0);
  CHECK(still.given == std::vector<Eigen::Index>{0, 10});
}
