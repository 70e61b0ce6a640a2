#include "lfdtools/suggestion.hpp"

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/fold.hpp"

namespace lfd {
namespace {

/// From latent variances of the processes at the goals to the sd of the widest phase and axis.
class WidestSd {
 public:
  WidestSd(const SkillPredictor& predictor, const Matrix& goals) : skill_(predictor.skill()) {
    const Eigen::Index D = goals.cols();
    // With a change of 1 m: of a goal-scaled primitive unit goes with the square of the change.
    const Samples unit = position_variance(predictor, Reach(Vector::Ones(D)), linspace(0, 1, phase_count)).unit;
    unit_ = unit.colwise().maxCoeff().replicate(goals.rows(), 1);
    if (skill_.dmp.scaling == DmpScaling::goal) {
      unit_ = unit_.cwiseProduct((goals.rowwise() - skill_.start.transpose()).cwiseAbs2());
    }
  }

  /// @param latent  G x number of models   @return G [m]
  [[nodiscard]] Vector operator()(const Matrix& latent) const {
    Vector variance = Vector::Zero(latent.rows());
    for (std::size_t m = 0; m < skill_.models.size(); ++m) {
      for (const int axis : skill_.models[m].outputs) {
        Vector own = latent.col(static_cast<Eigen::Index>(m)).cwiseMax(0.0);
        if (skill_.calibration) own.array() += skill_.calibration->target_variance[axis];
        own = own.cwiseProduct(unit_.col(axis));
        if (skill_.calibration) own.array() += std::pow(skill_.calibration->reproduction[axis], 2);
        variance = variance.cwiseMax(own);
      }
    }
    return variance.cwiseSqrt();
  }

 private:
  const Skill& skill_;
  Matrix unit_;  // G x D, largest over the phases [m^2]
};

/// What one process knows of the goals.
struct GoalCovariance {
  Matrix C;          // G x G, latent
  double noise = 0;  // of one demonstration
  Matrix less;       // n x G: what the variance grows by without row i, (P k)_i^2 / P_ii
};

GoalCovariance goal_covariance(const SkillPredictor& predictor, std::size_t m, const Matrix& goals) {
  const SkillModel& model = predictor.skill().models[m];
  const MvgpModel& process = model.process;
  Matrix Xs(goals.rows(), process.X.cols());
  for (Eigen::Index g = 0; g < goals.rows(); ++g) {
    Xs.row(g) = inputs_of(model, predictor.reach({{}, goals.row(g).transpose(), {}, {}})).transpose();
  }
  const Eigen::Index n = process.X.rows();
  const Matrix P = cholesky_solve(cholesky(noisy_covariance(process)), Matrix::Identity(n, n));
  const Matrix Pk = P * covariance(process.kernel, process.X, Xs);
  return {predictor.processes()[m].latent_covariance(Xs),
          process.noise.size() > 0 ? process.noise.mean() : process.noise_variance,
          P.diagonal().cwiseInverse().asDiagonal() * Pk.cwiseAbs2()};
}

/// Smaller by more than rounding, so that of equals the first stays.
bool clearly_less(double a, double b) {
  return a < b - 1e-9 * std::abs(b);
}

}  // namespace

Matrix goal_grid(const GoalBox& box) {
  const Eigen::Index D = box.low.size();
  if (D == 0 || box.high.size() != D || !box.low.allFinite() || !box.high.allFinite() ||
      (box.low.array() > box.high.array()).any()) {
    throw UsageError("suggestion.box", "a box of goals needs a least and a greatest value for every signal");
  }
  const auto open = static_cast<int>((box.low.array() < box.high.array()).count());
  if (open > 6) throw UsageError("suggestion.dimensions", "a box of goals may extend along six signals at most");
  Eigen::Index points = 1;
  while (open > 0 && points < 101 && std::pow(points + 2, open) <= 1000) points += 2;
  Matrix goals = box.low.transpose();
  for (Eigen::Index j = 0; j < D; ++j) {
    if (box.low[j] == box.high[j]) continue;
    const Vector values = linspace(box.low[j], box.high[j], points);
    Matrix longer(goals.rows() * points, D);
    for (Eigen::Index g = 0; g < longer.rows(); ++g) {
      longer.row(g) = goals.row(g / points);
      longer(g, j) = values[g % points];
    }
    goals = std::move(longer);
  }
  return goals;
}

Suggestion suggest(const SkillPredictor& predictor, const GoalBox& box, double repetitions) {
  const Skill& skill = predictor.skill();
  if (box.low.size() != skill.start.size()) {
    throw UsageError("suggestion.box", "the box of goals needs two numbers for every signal of the skill");
  }
  const Matrix goals = goal_grid(box);
  const WidestSd widest_sd(predictor, goals);
  std::vector<GoalCovariance> processes;
  Matrix latent(goals.rows(), static_cast<Eigen::Index>(skill.models.size()));
  for (std::size_t m = 0; m < skill.models.size(); ++m) {
    processes.push_back(goal_covariance(predictor, m, goals));
    latent.col(static_cast<Eigen::Index>(m)) = processes[m].C.diagonal();
  }
  const Vector before = widest_sd(latent);

  Suggestion result;
  result.sd_before = before.maxCoeff();
  Matrix changed = latent;
  for (Eigen::Index c = 0; c < goals.rows(); ++c) {
    for (std::size_t m = 0; m < processes.size(); ++m) {
      const auto& [C, noise, less] = processes[m];
      const auto column = static_cast<Eigen::Index>(m);
      changed.col(column) = latent.col(column) - C.col(c).cwiseAbs2() / (C(c, c) + noise / repetitions);
    }
    const Vector after = widest_sd(changed);
    if (c > 0 && !clearly_less(after.maxCoeff(), result.sd_after)) continue;
    result.sd_after = after.maxCoeff();
    result.goal = goals.row(c).transpose();
    result.fall = (before - after).maxCoeff();
  }

  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(skill.rows.size()); ++i) {
    for (std::size_t m = 0; m < processes.size(); ++m) {
      const auto column = static_cast<Eigen::Index>(m);
      changed.col(column) = latent.col(column) + processes[m].less.row(i).transpose();
    }
    const Vector without = widest_sd(changed);
    result.rows.push_back({without.maxCoeff(), (without - before).maxCoeff()});
    if (clearly_less(result.rows.back().growth, result.rows[result.least].growth))
      result.least = result.rows.size() - 1;
  }
  return result;
}

}  // namespace lfd
