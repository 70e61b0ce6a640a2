#include "lfdtools/skill_method.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "lfdtools/gaussian.hpp"

namespace lfd {
namespace {

std::vector<std::string> signal_names(Eigen::Index D) {
  std::vector<std::string> names;
  for (Eigen::Index j = 0; j < D; ++j) names.push_back(fmt::format("s{}", j + 1));
  return names;
}

/// @param rows_are_means  a row is a mean of demonstrations already, so its noise is that of a mean
Predictor learnt(const std::vector<SkillRow>& rows, const SkillOptions& options, bool rows_are_means) {
  const auto names = signal_names(rows.front().primitive.dimensions());
  const auto skill = std::make_shared<const SkillPredictor>(train_skill(names, rows, options));
  return [skill, rows_are_means](const Query& query) {
    const Dmp dmp = skill->primitive({{}, query.goal, query.start, {}});
    const double averaged = rows_are_means ? 1.0 : static_cast<double>(query.repetitions);
    return Predicted{rollout(dmp, linspace(0, dmp.tau, phase_count)).positions, band_of(skill->skill(), dmp, averaged)};
  };
}

}  // namespace

Trainer skill_method(SkillStructure structure) {
  return [structure](const Fold& fold, const PreparationOptions& options) {
    std::vector<SkillRow> rows;
    for (const auto* target : fold) {
      for (const auto& row : target->examples) rows.push_back({target->labels, row.primitive});
    }
    SkillOptions learning;
    learning.structure = structure;
    learning.seed = options.seed;
    return learnt(rows, learning, options.road == Road::references);
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
    return learnt(rows, learning, true);
  };
}

Band band_of(const Skill& skill, const Dmp& primitive, double averaged) {
  const Matrix R = response_matrix(skill.dmp, primitive.tau, linspace(0, primitive.tau, phase_count));
  const Vector scale = primitive.scale();
  const Eigen::Index N = skill.dmp.bases();
  Band band{Samples::Zero(phase_count, primitive.dimensions()), Vector::Zero(primitive.dimensions())};
  for (const auto& model : skill.models) {
    const MvgpPredictor predictor(model.process);
    Vector x(static_cast<Eigen::Index>(model.inputs.size()));
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const int input = model.inputs[static_cast<std::size_t>(j)];
      x[j] = primitive.goal[input] - primitive.start[input];
    }
    const MvgpPrediction w = predictor.predict(x);
    const Matrix covariance = predictor.weight_covariance(w.variance + model.process.noise_variance / averaged);
    // Student-t: the covariance is nu / (nu - 2) times the squared scale that the quantile multiplies.
    const double nu = w.degrees_of_freedom;
    const double factor = student_t_quantile(0.975, nu) * (std::isfinite(nu) ? std::sqrt((nu - 2) / nu) : 1.0);
    for (std::size_t j = 0; j < model.outputs.size(); ++j) {
      const Eigen::Index axis = model.outputs[j];
      const Eigen::Index from = static_cast<Eigen::Index>(j) * N;
      const Matrix block = covariance.block(from, from, N, N);
      const Vector variance = ((R * block).array() * R.array()).rowwise().sum().max(0.0);
      band.half_width.col(axis) = factor * std::abs(scale[axis]) * variance.cwiseSqrt();
      band.degrees_of_freedom[axis] = nu;
    }
  }
  return band;
}

}  // namespace lfd
