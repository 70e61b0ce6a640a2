#include "motion_goals.hpp"

#include <fmt/format.h>

#include "lfdtools/io/goals.hpp"

namespace lfd::cli {
namespace {

Vector to_base(const MotionRequest& request, const Vector& p) {
  if (!request.camera_pose) return p;
  return request.camera_pose->rotation * p + request.camera_pose->position;
}

/// Splits `T,X,Y,Z[,...]`: the numbers behind the time.
std::vector<double> behind_time(const std::vector<double>& numbers, std::size_t D, std::size_t optional,
                                const char* option) {
  if (numbers.size() < D + 1 || numbers.size() > D + 1 + optional) {
    throw UsageError("usage.arity", fmt::format("{} takes a time and {} numbers here, one a signal{}, not {} in all",
                                                option, D, optional > 0 ? ", and perhaps an sd" : "", numbers.size()));
  }
  if (!(numbers[0] > 0)) {
    throw UsageError("usage.value", fmt::format("{} takes a time over 0 s, not {}", option, numbers[0]));
  }
  return {numbers.begin() + 1, numbers.end()};
}

}  // namespace

Vector position(const std::vector<double>& numbers, std::size_t D, const char* option) {
  if (numbers.size() != D) {
    throw UsageError("usage.arity",
                     fmt::format("{} takes {} numbers here, one a signal, not {}", option, D, numbers.size()));
  }
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(D));
}

std::vector<Goal> goals_of(const MotionRequest& request, const std::vector<std::string>& columns, Run& run) {
  if (request.camera_pose && columns.size() != 3) {
    throw UsageError("generate.camera", fmt::format("--camera needs three signals, and here are {}", columns.size()));
  }
  std::vector<Goal> goals;
  for (const auto& numbers : request.goals) {
    Goal goal;
    if (request.goals.size() > 1) goal.labels.target = fmt::format("{}", goals.size() + 1);
    goal.position = position(numbers, columns.size(), "--goal");
    goals.push_back(goal);
  }
  if (!request.goals_file.empty()) goals = read_goals(request.goals_file, columns, run.messages());
  if (!request.target.empty() && !request.goals_file.empty()) {
    std::erase_if(goals, [&](const Goal& goal) { return goal.labels.target != request.target; });
    if (goals.empty()) throw UsageError("generate.no_target", fmt::format("no goal is of target '{}'", request.target));
  }
  for (auto& goal : goals) {
    goal.position = to_base(request, goal.position);
    if (goal.start) goal.start = to_base(request, *goal.start);
    if (request.camera_pose && goal.covariance.size() > 0) {
      const Matrix R = request.camera_pose->rotation;
      goal.covariance = R * goal.covariance * R.transpose();
    }
    if (request.start) goal.start = position(*request.start, columns.size(), "--start");
    if (request.duration) goal.duration = request.duration;
  }
  return goals;
}

std::vector<GoalChange> changes_of(const MotionRequest& request, std::size_t D) {
  std::vector<GoalChange> changes;
  for (const auto& numbers : request.goal_at) {
    const auto rest = behind_time(numbers, D, 0, "--goal-at");
    if (!changes.empty() && !(numbers[0] > changes.back().time)) {
      throw UsageError("usage.value", "the times of --goal-at must rise");
    }
    changes.push_back({numbers[0], to_base(request, position(rest, D, "--goal-at")), {}});
  }
  return changes;
}

MotionConstraints constraints_of(const MotionRequest& request, std::size_t D) {
  MotionConstraints constraints;
  for (const auto& numbers : request.via) {
    auto rest = behind_time(numbers, D, 1, "--via");
    const double sd = rest.size() > D ? rest.back() : 0.0;
    if (sd < 0) throw UsageError("usage.value", fmt::format("--via takes an sd of at least 0, not {}", sd));
    rest.resize(D);
    constraints.via.push_back({numbers[0], position(rest, D, "--via"), sd});
  }
  if (request.start_velocity) constraints.start_velocity = position(*request.start_velocity, D, "--start-velocity");
  if (request.end_velocity) constraints.end_velocity = position(*request.end_velocity, D, "--end-velocity");
  return constraints;
}

}  // namespace lfd::cli
