// Plain paths: smooth motions, rows put in where samples are sparse, hands at rest, inputs that cannot be.
#include "lfdtools/path.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "lfdtools/random.hpp"
#include "path_fixture.hpp"
#include "refusal.hpp"

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

double largest_ratio(const Robot& robot, const Samples& joints, const Vector& times) {
  double largest = 0.0;
  for (Eigen::Index t = 1; t < joints.rows(); ++t) {
    const Joints step = (joints.row(t) - joints.row(t - 1)).transpose().cwiseAbs().cwiseQuotient(robot.limits.velocity);
    largest = std::max(largest, step.maxCoeff() / (times[t] - times[t - 1]));
  }
  return largest;
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

TEST_CASE("rows are put between samples that are too far apart, and only there") {
  const InverseKinematics arm(nominal_ur10());
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

TEST_CASE("one sample, a resting hand, and inputs that cannot be") {
  const InverseKinematics arm(nominal_ur10());
  const Pose pose{down, Vector3(0.5, 0.3, 0.3)};
  const JointPath one = solve_path(arm, {pose}, Vector::Zero(1));
  CHECK(one.status == PathStatus::continuous);
  double smallest = 1e9;
  for (const IkSolution& s : arm(pose)) smallest = std::min(smallest, s.joints.squaredNorm());
  CHECK(one.joints.row(0).squaredNorm() == Approx(smallest));
  const JointPath rest = solve_path(arm, {pose, pose, pose}, Vector::LinSpaced(3, 0.0, 1.0));
  CHECK(rest.joints.row(2) == one.joints.row(0));
  CHECK(rest.condition[1] == condition_number(jacobian(arm.robot(), rest.joints.row(1).transpose())));

  const auto id_of = [&](const std::vector<Pose>& poses, const Vector& times, const PathOptions& options = {}) {
    return refusal_of([&] { (void)solve_path(arm, poses, times, options); }).id;
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
