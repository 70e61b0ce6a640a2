#include "lfdtools/skill_method.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "lfdtools/row_check.hpp"
#include "lfdtools/ways.hpp"

namespace lfd {
namespace {

std::vector<std::string> signal_names(Eigen::Index D) {
  std::vector<std::string> names;
  for (Eigen::Index j = 0; j < D; ++j) names.push_back(fmt::format("s{}", j + 1));
  return names;
}

/// @param rows, options   those that the skill was trained with
/// @param rows_are_means  a row is a mean of demonstrations already, so its noise is that of a mean
Predictor one_way(Skill trained, const std::vector<SkillRow>& rows, const SkillOptions& options, bool rows_are_means) {
  trained.calibration = calibrate(trained, rows, options);
  const auto skill = std::make_shared<const SkillPredictor>(std::move(trained));
  return [skill, rows_are_means](const Query& query) {
    const Goal goal{{{}, query.teacher, {}, {}}, query.goal, query.start, {}};
    const Dmp dmp = skill->primitive(goal);
    const double averaged = rows_are_means && std::isfinite(query.repetitions) ? 1.0 : query.repetitions;
    const auto half_width = [skill, reach = skill->reach(goal), averaged](BandKind kind, double level) {
      return band(*skill, reach, linspace(0, 1, phase_count), kind, level, averaged);
    };
    return Predicted{rollout(dmp, linspace(0, dmp.tau, phase_count)).positions, half_width};
  };
}

/// Where the rows go two ways round, a skill of each, of which a query gets that of the nearest target.
Predictor learnt(std::vector<SkillRow> rows, SkillOptions options, bool rows_are_means) {
  rows = without(rows, repeated_rows(rows));
  const auto names = signal_names(rows.front().primitive.dimensions());
  options.kernel = choose_kernel(names, rows, options);
  Skill together = train_skill(names, rows, options);
  const auto ways = options.paper ? std::optional<Ways>() : two_ways(together, rows);
  if (!ways || !is_trainable(rows_of_way(rows, *ways, 0)) || !is_trainable(rows_of_way(rows, *ways, 1))) {
    return one_way(std::move(together), rows, options, rows_are_means);
  }
  std::vector<Predictor> predictors;
  for (const int way : {0, 1}) {
    const auto of_way = rows_of_way(rows, *ways, way);
    predictors.push_back(one_way(train_skill(names, of_way, options), of_way, options, rows_are_means));
  }
  return [predictors, rows, ways = *ways](const Query& query) {
    return predictors[static_cast<std::size_t>(nearest_way(rows, ways, query.change()))](query);
  };
}

}  // namespace

Trainer skill_method(SkillStructure structure, ProcessType process) {
  return [structure, process](const Fold& fold, const PreparationOptions& options) {
    std::vector<SkillRow> rows;
    for (const auto* target : fold) {
      for (const auto& row : target->examples) rows.push_back({target->labels, row.primitive});
    }
    SkillOptions learning;
    learning.structure = structure;
    learning.process = process;
    learning.seed = options.seed;
    return learnt(std::move(rows), learning, options.road == Road::references);
  };
}

Trainer paper_method(SkillStructure structure) {
  return [structure](const Fold& fold, const PreparationOptions& options) {
    std::vector<SkillRow> rows;
    for (const auto* target : fold) rows.push_back({target->labels, *target->paper});
    SkillOptions learning;
    learning.paper = true;
    learning.structure = structure;
    learning.seed = options.seed;
    return learnt(std::move(rows), learning, true);
  };
}

}  // namespace lfd
