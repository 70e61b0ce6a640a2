#include "lfdtools/tempo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lfdtools/dmp_fit.hpp"

namespace lfd {
namespace {

/// Weights of sin(pi s) dy/ds for a motion y, D x N: what makes its hand early.
Matrix earliness(const Dmp& motion) {
  Dmp unit = motion;
  unit.tau = 1;
  const Vector s = linspace(0, 1, std::max<Eigen::Index>(200, 4 * motion.settings.bases()));
  const Samples change = (s * std::numbers::pi).array().sin().matrix().asDiagonal() * rollout(unit, s).velocities;
  DmpFitOptions fit;
  fit.settings = motion.settings;
  fit.start = fit.goal = Vector::Zero(motion.dimensions());
  return fit_dmp({s, change}, fit).weights;
}

struct TargetTempo {
  std::vector<std::size_t> rows;
  Matrix direction;  // D x N, weights
  Vector early;      // c of each row
  double mean = 0;
};

/// Metric of the weights of one axis, N x N.
Matrix metric_of(const Skill& skill) {
  const Eigen::Index N = skill.dmp.bases();
  return skill.models.front().process.output_transform.topLeftCorner(N, N);
}

/// A row of residuals as weights are kept, D x N.
Matrix by_axis(const Matrix& residuals, std::size_t row, Eigen::Index N) {
  const Vector all = residuals.row(static_cast<Eigen::Index>(row)).transpose();
  return all.reshaped(N, all.size() / N).transpose();
}

TargetTempo target_tempo(const Matrix& metric, const std::vector<SkillRow>& rows, std::vector<std::size_t> group,
                         const Matrix& residuals) {
  const Eigen::Index N = metric.rows();
  const double count = static_cast<double>(group.size());
  Dmp predicted = rows[group.front()].primitive;
  predicted.weights.setZero();
  predicted.start.setZero();
  predicted.goal.setZero();
  for (const std::size_t i : group) {
    const Dmp& row = rows[i].primitive;
    predicted.start += row.start / count;
    predicted.goal += row.goal / count;
    const Matrix missed = by_axis(residuals, i, N);
    // W = Y A^-1
    predicted.weights +=
        (row.weights - metric.transpose().triangularView<Eigen::Upper>().solve(missed.transpose()).transpose()) / count;
  }
  TargetTempo tempo{std::move(group), earliness(predicted), {}};
  const Matrix direction = tempo.direction * metric;
  const double length = direction.squaredNorm();
  tempo.early = Vector::Zero(static_cast<Eigen::Index>(tempo.rows.size()));
  for (std::size_t k = 0; length > 0 && k < tempo.rows.size(); ++k) {
    const Matrix missed = by_axis(residuals, tempo.rows[k], N);
    tempo.early[static_cast<Eigen::Index>(k)] = missed.cwiseProduct(direction).sum() / length;
  }
  tempo.mean = tempo.early.mean();
  return tempo;
}

}  // namespace

std::vector<SkillRow> with_shared_tempo(const Skill& skill, std::vector<SkillRow> rows) {
  const auto groups = repetition_groups(skill.rows);
  if (groups.size() < 3 || groups.size() == rows.size()) return rows;
  const Matrix residuals = left_out_residuals(skill);
  const Matrix metric = metric_of(skill);
  std::vector<TargetTempo> targets;
  double within = 0, usual = 0;
  for (const auto& group : groups) {
    targets.push_back(target_tempo(metric, rows, group, residuals));
    within += (targets.back().early.array() - targets.back().mean).square().sum();
    usual += targets.back().mean / static_cast<double>(groups.size());
  }
  within /= static_cast<double>(rows.size() - groups.size());
  double between = 0, by_chance = 0;
  for (const auto& target : targets) {
    between += std::pow(target.mean - usual, 2) / static_cast<double>(groups.size() - 1);
    by_chance += within / static_cast<double>(target.rows.size() * groups.size());
  }
  const double own = std::max(0.0, between - by_chance);
  for (const auto& target : targets) {
    const double chance = within / static_cast<double>(target.rows.size());
    if (!(chance > 0)) continue;
    const double excess = chance / (own + chance) * (target.mean - usual);
    for (const std::size_t i : target.rows) rows[i].primitive.weights -= excess * target.direction;
  }
  return rows;
}

}  // namespace lfd
