#include "lfdtools/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/joint_curve.hpp"
#include "lfdtools/path_refinement.hpp"
#include "lfdtools/posture.hpp"
#include "lfdtools/posture_graph.hpp"
#include "lfdtools/singularity.hpp"
#include "path_layers.hpp"

namespace lfd {
namespace {

void check(const std::vector<Pose>& flange, const Vector& times, const PathOptions& options) {
  const bool positive = options.tolerance > 0.0 && options.max_step > 0.0 && options.midpoint_tolerance > 0.0 &&
                        (!options.curve_rest || *options.curve_rest > 0.0);
  const bool counted = options.refinements >= 0 && options.refinements <= 20 &&
                       (!options.branch || (*options.branch >= 0 && *options.branch <= 7));
  if (!positive || !counted || !(options.step_slack >= 1.0) || (options.seed && !options.seed->allFinite())) {
    throw UsageError("path.options",
                     "tolerances and the largest step must be positive, the slack at least 1, the seed finite, the "
                     "branch 0 to 7 and the refinements 0 to 20");
  }
  const auto T = static_cast<Eigen::Index>(flange.size());
  if (T < 1 || times.size() != T) {
    throw DataError("path.shape", fmt::format("{} poses but {} times", flange.size(), times.size()));
  }
  if (!times.allFinite()) throw DataError("path.not_finite", "a time is not a finite number");
  for (Eigen::Index t = 1; t < T; ++t) {
    if (times[t] > times[t - 1]) continue;
    throw DataError("path.time_not_rising", fmt::format("time {} s is not after {} s", times[t], times[t - 1]));
  }
  for (std::size_t t = 0; t < flange.size(); ++t) {
    if (is_rigid(flange[t])) continue;
    throw DataError("ur10.pose_not_rigid",
                    fmt::format("the pose of sample {} is not finite or its rotation is not orthonormal", t + 1));
  }
}

/// How far the hand is from the way between two poses when every joint is midway between its angles.
double deviation_midway(const Robot& robot, const Joints& q0, const Joints& q1, const Pose& from, const Pose& to) {
  return distance(forward_kinematics(robot, 0.5 * (q0 + q1)), interpolate(from, to, 0.5)).largest();
}

/// How far the hand is from its path on the curve through the rows, for the interval that ends at each row: the
/// largest at a quarter, half and three quarters of the way.
Vector deviation_on_curve(const Robot& robot, const Samples& joints, const std::vector<Pose>& flange, double rest) {
  Vector deviation = Vector::Zero(joints.rows());
  if (joints.rows() < 2) return deviation;
  const std::vector<Eigen::Index> rows = moving_rows(joints, rest);
  const JointCurve curve(joints(rows, Eigen::all));
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto knot = static_cast<Eigen::Index>(k);
    const Pose& from = flange[static_cast<std::size_t>(rows[k - 1])];
    const Pose& to = flange[static_cast<std::size_t>(rows[k])];
    const double begin = curve.along()[knot - 1], end = curve.along()[knot];
    for (const double share : {0.25, 0.5, 0.75}) {
      const Joints q = curve(Vector::Constant(1, begin + share * (end - begin))).row(0).transpose();
      const double off = distance(forward_kinematics(robot, q), interpolate(from, to, share)).largest();
      deviation[rows[k]] = std::max(deviation[rows[k]], off);
    }
  }
  return deviation;
}

/// Adds a fault; the first is what the path is told by.
void fail(JointPath& path, const PathFault& fault) {
  if (path.faults.empty()) {
    path.status = fault.status;
    path.sample = fault.sample;
    path.reason = fault.reason;
  }
  path.faults.push_back(fault);
}

/// The same for a row, in the numbers of the samples given.
void fail(PathStatus status, Eigen::Index row, const std::string& reason, const PathSampling& sampling,
          JointPath& path) {
  fail(path, {status, sampling.given(row), reason});
}

/// Adds the first jump and the first deviation of a path whose joints are known.
void judge(const InverseKinematics& arm, const PathOptions& options, const PathSampling& sampling, JointPath& path) {
  const auto why = [&](Eigen::Index row) {
    const std::string limit = sampling.limit(row, options.refinements);
    return limit.empty() ? limit : "; " + limit;
  };
  for (Eigen::Index t = 1; t < path.joints.rows(); ++t) {
    Eigen::Index joint = 0;
    const double step = (path.joints.row(t) - path.joints.row(t - 1)).cwiseAbs().maxCoeff(&joint);
    if (!(step > options.max_step)) continue;
    SingularityDistances least = singularity_distances(arm.geometry(), path.joints.row(t).transpose());
    const SingularityDistances before = singularity_distances(arm.geometry(), path.joints.row(t - 1).transpose());
    least = {std::min(least.shoulder, before.shoulder), std::min(least.elbow, before.elbow),
             std::min(least.wrist, before.wrist)};
    const std::string near = nearest_singularity(least);
    fail(PathStatus::jump, t,
         fmt::format("joint {} moves {:.3g} rad to {} on the best of all paths{}{}", joint + 1, step, sampling.name(t),
                     near.empty() ? near : ", near " + near, why(t)),
         sampling, path);
    break;
  }
  for (Eigen::Index t = 1; t < path.joints.rows(); ++t) {
    if (!(path.midpoint_deviation[t] > options.midpoint_tolerance)) continue;
    fail(PathStatus::deviates, t,
         fmt::format("the hand is off its path by {:.3g} (m or rad) {} {}{}", path.midpoint_deviation[t],
                     options.curve_rest ? "on the way to" : "midway to", sampling.name(t), why(t)),
         sampling, path);
    break;
  }
}

/// The rows of a path whose interval is to be halved.
std::vector<Eigen::Index> too_wide(const PathOptions& options, const JointPath& path) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index t = 1; t < path.joints.rows(); ++t) {
    const double step = (path.joints.row(t) - path.joints.row(t - 1)).cwiseAbs().maxCoeff();
    if (step > options.max_step || path.midpoint_deviation[t] > options.midpoint_tolerance) rows.push_back(t);
  }
  return rows;
}

/// The best path through the samples as they are, not judged yet.
JointPath solve_samples(const InverseKinematics& arm, const PathSampling& sampling, const PathOptions& options) {
  const Robot& robot = arm.robot();
  const std::vector<Pose>& flange = sampling.poses();
  JointPath path;
  path.joints.resize(0, 6);
  path.times = sampling.times();
  path.given = sampling.given();
  std::vector<SolutionLayer> layers = solve_layers(arm, flange, path.times, {options.seed, options.tolerance});
  for (std::size_t t = 0; t < layers.size(); ++t) {
    if (layers[t].empty()) path.unreachable.push_back(path.given[t]);
  }
  if (!path.unreachable.empty()) {
    const Eigen::Index sample = path.unreachable.front();
    const auto row = static_cast<std::size_t>(
        std::find_if(layers.begin(), layers.end(), [](const SolutionLayer& layer) { return layer.empty(); }) -
        layers.begin());
    fail(path,
         {PathStatus::unreachable, sample,
          fmt::format("sample {} is out of reach: {}", sample + 1, out_of_reach_words(arm.geometry(), flange[row]))});
    return path;
  }
  for (std::size_t t = 0; options.branch && t < layers.size(); ++t) {
    SolutionLayer& layer = layers[t];
    const auto leaves = [&](const IkSolution& s) { return !keeps_branch(arm, s.joints, *options.branch); };
    layer.erase(std::remove_if(layer.begin(), layer.end(), leaves), layer.end());
    for (IkSolution& solution : layer) solution.branch = *options.branch;
    if (!layer.empty()) continue;
    const auto row = static_cast<Eigen::Index>(t);
    fail(PathStatus::other_branch, row, fmt::format("{} has no solution there", sampling.name(row)), sampling, path);
    return path;
  }

  std::vector<std::vector<Posture>> postures(layers.size());
  for (std::size_t t = 0; t < layers.size(); ++t) {
    for (const IkSolution& solution : layers[t]) {
      postures[t].push_back({solution.joints, solution.branch, options.branch ? 0 : border_bits(arm, solution.joints)});
    }
  }
  Way way = best_way(postures, path.times, robot.limits,
                     {options.seed, options.max_step, options.step_slack, options.respect_limits});
  if (way.posture.empty()) {
    fail(PathStatus::outside_limits, way.blocked,
         fmt::format("no path within the joint ranges comes to {}", sampling.name(way.blocked)), sampling, path);
    return path;
  }

  const auto T = static_cast<Eigen::Index>(layers.size());
  path.joints = std::move(way.joints);
  path.largest_step_ratio = way.largest_ratio;
  path.residual = Vector::Zero(T);
  path.condition = Vector::Zero(T);
  path.midpoint_deviation = Vector::Zero(T);
  path.branch = options.branch ? std::vector<int>(layers.size(), *options.branch) : branches_along(arm, path.joints);
  for (Eigen::Index t = 0; t < T; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Joints q = path.joints.row(t).transpose();
    path.residual[t] = distance(forward_kinematics(robot, q), flange[i]).largest();
    path.condition[t] = condition_number(jacobian(robot, q));
    if (t == 0) continue;
    const Joints before = path.joints.row(t - 1).transpose();
    path.midpoint_deviation[t] = deviation_midway(robot, before, q, flange[i - 1], flange[i]);
    path.branch_changes += path.branch[i] != path.branch[i - 1] ? 1 : 0;
  }
  if (options.curve_rest) {
    const Vector on_curve = deviation_on_curve(robot, path.joints, flange, *options.curve_rest);
    path.midpoint_deviation = path.midpoint_deviation.cwiseMax(on_curve);
  }
  return path;
}

/// The best path through the samples, intervals halved where that helps.
JointPath solve_halving(const InverseKinematics& arm, const std::vector<Pose>& flange, const Vector& times,
                        const PathOptions& options) {
  PathSampling sampling(flange, times);
  JointPath path = solve_samples(arm, sampling, options);
  while (sampling.halve(arm, too_wide(options, path), options.refinements, options.tolerance)) {
    path = solve_samples(arm, sampling, options);
  }
  if (path.joints.rows() > 0) judge(arm, options, sampling, path);
  return path;
}

}  // namespace

JointPath solve_path(const InverseKinematics& arm, const std::vector<Pose>& flange, const Vector& times,
                     const PathOptions& options) {
  check(flange, times, options);
  JointPath kept = solve_halving(arm, flange, times, options);
  if (!options.branch || kept.status == PathStatus::continuous || kept.status == PathStatus::deviates ||
      kept.status == PathStatus::unreachable) {
    return kept;
  }
  PathOptions any = options;
  any.branch.reset();
  JointPath path = solve_halving(arm, flange, times, any);
  if (path.joints.rows() == 0) return path;
  if (path.status == PathStatus::jump && kept.status == PathStatus::jump) return kept;
  std::string reason = fmt::format("the posture {} cannot be kept: {}", branch_name(*options.branch), kept.reason);
  const bool one = path.branch_changes == 0 && path.branch.front() != *options.branch;
  if (one && path.faults.empty()) reason += fmt::format("; there is a path in {}", branch_name(path.branch.front()));
  const std::vector<PathFault> own = std::exchange(path.faults, {});
  fail(path, {PathStatus::other_branch, kept.sample, reason});
  for (const PathFault& fault : own) fail(path, fault);
  return path;
}

JointPath solve_path(const Robot& robot, const std::vector<Pose>& flange, const Vector& times,
                     const PathOptions& options) {
  return solve_path(InverseKinematics(robot), flange, times, options);
}

}  // namespace lfd
