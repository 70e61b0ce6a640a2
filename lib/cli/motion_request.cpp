#include "lfdtools/cli/motion_request.hpp"

#include <fmt/format.h>

#include "lfdtools/io/goals.hpp"
#include "lfdtools/io/labelled_table.hpp"

namespace lfd::cli {
namespace {

Vector position(const std::vector<double>& numbers, std::size_t D, const char* option) {
  if (numbers.size() != D) {
    throw UsageError("usage.arity",
                     fmt::format("{} takes {} numbers here, one a signal, not {}", option, D, numbers.size()));
  }
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(D));
}

std::vector<Goal> goals_of(const MotionRequest& request, const std::vector<std::string>& columns, Run& run) {
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
    if (request.start) goal.start = position(*request.start, columns.size(), "--start");
    if (request.duration) goal.duration = request.duration;
  }
  return goals;
}

std::vector<std::string> value_columns(const std::vector<std::string>& columns, bool derivatives) {
  auto names = joined({"t"}, columns);
  if (derivatives) names = joined(joined(names, prefixed("v_", columns)), prefixed("a_", columns));
  return names;
}

void write_motion(LabelledTable& table, const Labels& labels, const Dmp& dmp, const MotionRequest& request) {
  const Motion motion = generate(dmp, request.dt);
  Samples rows = beside(motion.times, motion.positions);
  if (request.derivatives) rows = beside(rows, beside(motion.velocities, motion.accelerations));
  table.write(labels, rows);
}

void write_weights(LabelledTable& table, const Goal& goal, const WeightPrediction& weights,
                   const std::vector<std::string>& columns) {
  for (Eigen::Index j = 0; j < weights.mean.rows(); ++j) {
    for (Eigen::Index i = 0; i < weights.mean.cols(); ++i) {
      CsvWriter& row = table.begin(goal.labels);
      row.labels(goal.labels);
      row.text(columns[static_cast<std::size_t>(j)]);
      row.integer(i + 1);
      row.number(weights.mean(j, i));
      row.number(weights.sd(j, i));
      row.end_row();
    }
  }
}

}  // namespace

void generate_from_skill(const SkillFile& file, const MotionRequest& request, Run& run) {
  const Skill& skill = file.skill;
  if (!request.target.empty() && request.goals_file.empty()) {
    throw UsageError("generate.target", "--target chooses among the goals of --goals, or the primitives of a file");
  }
  const auto goals = goals_of(request, skill.columns, run);
  if (goals.empty()) throw UsageError("generate.no_goal", "a skill needs a goal: --goal X,Y,Z or --goals FILE");
  const SkillPredictor predictor(skill);
  LabelledTable table(run.output(), request.weights ? std::vector<std::string>{"signal", "basis", "mean", "sd"}
                                                    : value_columns(skill.columns, request.derivatives));
  for (const Goal& goal : goals) {
    const std::string name = goal.labels.target ? describe(goal.labels) + ": " : std::string();
    if (!goal.start && skill.start_spread > start_tolerance) {
      run.refuse("start", fmt::format("{}the demonstrations start up to {:.1f} mm apart, so a goal needs a start"
                                      "",
                                      name, 1e3 * skill.start_spread));
    }
    const Reach reach = predictor.reach(goal);
    const double excess = region_excess(skill, reach);
    if (excess > 0) {
      run.refuse(
          "region",
          fmt::format(
              "{}the goal lies {:.1f} mm outside the demonstrated region (range of goal - start, and of the start, "
              "widened by a tenth)",
              name, 1e3 * excess));
    }
    if (request.weights) {
      write_weights(table, goal, predictor.weights(reach), skill.columns);
    } else {
      write_motion(table, goal.labels, predictor.primitive(goal), request);
    }
  }
}

void replay(std::vector<DmpFile> files, const MotionRequest& request, Run& run) {
  if (!request.target.empty()) {
    std::erase_if(files, [&](const DmpFile& file) { return file.header.labels.target != request.target; });
  }
  if (files.empty())
    throw UsageError("generate.no_target", fmt::format("no primitive is of target '{}'", request.target));
  if (files.size() > 1) {
    throw UsageError("generate.which", fmt::format("{} primitives: --target says which one to replay", files.size()));
  }
  if (request.weights)
    throw UsageError("generate.weights", "--weights needs a skill; a primitive's weights are in its file");
  const DmpFile& file = files.front();
  MotionRequest rest = request;
  rest.target.clear();
  auto goals = goals_of(rest, file.header.columns, run);
  if (goals.empty()) {
    goals.push_back({file.header.labels, file.dmp.goal, {}, request.duration});
    if (request.start) goals.back().start = position(*request.start, file.header.columns.size(), "--start");
  }
  LabelledTable table(run.output(), value_columns(file.header.columns, request.derivatives));
  for (const Goal& goal : goals) {
    Dmp dmp = file.dmp;
    dmp.goal = goal.position;
    dmp.start = goal.start.value_or(dmp.start);
    dmp.tau = goal.duration.value_or(dmp.tau);
    write_motion(table, goal.labels, dmp, request);
  }
}

}  // namespace lfd::cli
