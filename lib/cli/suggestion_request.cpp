#include "lfdtools/cli/suggestion_request.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "lfdtools/cli/suggestion_report.hpp"
#include "lfdtools/cli/training.hpp"

namespace lfd::cli {

GoalBox goal_box(const std::vector<double>& region) {
  if (region.empty() || region.size() % 2 != 0) {
    throw UsageError("usage.arity", "--suggest takes two numbers a signal, the least and the greatest of each in turn");
  }
  const Eigen::Map<const Matrix> ends(region.data(), 2, static_cast<Eigen::Index>(region.size() / 2));
  if ((ends.row(0).array() > ends.row(1).array()).any()) {
    throw UsageError("usage.range", "--suggest: the box is empty, a least value is over the greatest");
  }
  return {ends.row(0).transpose(), ends.row(1).transpose()};
}

void suggest_target(const std::vector<TargetDemonstrations>& targets, const std::vector<std::string>& columns,
                    const GoalBox& box, const PreparationOptions& preparation, Run& run) {
  if (box.low.size() != static_cast<Eigen::Index>(columns.size())) {
    throw UsageError("usage.arity", fmt::format("--suggest takes {} numbers here, two a signal, not {}",
                                                2 * columns.size(), 2 * box.low.size()));
  }
  std::vector<SkillRow> rows;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const TrainingTarget target = training_target(targets[i].labels, recorded(targets[i], preparation.alignment),
                                                  preparation, {.primitives = true}, i);
    for (std::size_t k = 0; k < target.examples.size(); ++k) {
      rows.push_back({targets[i].demonstration_labels[k], target.examples[k].primitive});
    }
  }
  TrainingRequest request;
  request.two_ways_refused = false;
  request.options.teachers = SkillTeachers::together;  // whose the next demonstration will be is not asked
  request.options.seed = run.seed();
  request.options.jobs = run.jobs();
  Skill skill = learn(columns, rows, request, run);
  const double repetitions = std::round(static_cast<double>(rows.size()) / static_cast<double>(targets.size()));
  const Suggestion suggestion = suggest(SkillPredictor(std::move(skill)), box, repetitions);
  report(suggestion, columns, rows, run);
  write_suggestion(suggestion, columns, rows, run.output());
}

}  // namespace lfd::cli
