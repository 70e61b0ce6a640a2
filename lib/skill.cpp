#include "lfdtools/skill.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

/// How far x lies outside the interval of some values, widened by a tenth and at least 10 mm; negative inside.
double beyond(const Eigen::Ref<const Vector>& values, double x) {
  const double low = values.minCoeff();
  const double high = values.maxCoeff();
  const double margin = std::max(0.01, 0.1 * (high - low));
  return std::max(low - margin - x, x - high - margin);
}

/// Positions of the rows that are the same as the first of their group.
template <typename Same>
std::vector<std::vector<std::size_t>> grouped(const std::vector<Labels>& rows, const Same& same) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& group) { return same(rows[group.front()], rows[i]); });
    if (found == groups.end()) {
      groups.push_back({i});
    } else {
      found->push_back(i);
    }
  }
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> target_groups(const std::vector<Labels>& rows) {
  return grouped(rows, [](const Labels& a, const Labels& b) { return a.target && a.target == b.target; });
}

std::vector<std::vector<std::size_t>> repetition_groups(const std::vector<Labels>& rows) {
  return grouped(rows, [](const Labels& a, const Labels& b) {
    return a.target && a.target == b.target && a.teacher == b.teacher;
  });
}

std::vector<SkillRow> without(const std::vector<SkillRow>& rows, const std::vector<std::size_t>& left_out) {
  std::vector<SkillRow> rest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) rest.push_back(rows[i]);
  }
  return rest;
}

std::vector<Labels> labels_of(const std::vector<SkillRow>& rows) {
  std::vector<Labels> labels;
  for (const auto& row : rows) labels.push_back(row.labels);
  return labels;
}

Matrix left_out_residuals(const Skill& skill) {
  const auto groups = target_groups(skill.rows);
  const Eigen::Index N = skill.dmp.bases();
  Matrix residuals(static_cast<Eigen::Index>(skill.rows.size()), N * static_cast<Eigen::Index>(skill.columns.size()));
  for (const auto& model : skill.models) {
    const Matrix of_model = left_out_residuals(model.process, groups);
    for (std::size_t j = 0; j < model.outputs.size(); ++j) {
      residuals.middleCols(model.outputs[j] * N, N) = of_model.middleCols(static_cast<Eigen::Index>(j) * N, N);
    }
  }
  return residuals;
}

double DurationModel::predict(const Vector& change) const {
  return std::clamp(mean + coefficients.dot(change), range[0], range[1]);
}

bool sees_starts(const Skill& skill) {
  const auto D = static_cast<int>(skill.columns.size());
  const auto& inputs = skill.models.front().inputs;
  return std::any_of(inputs.begin(), inputs.end(), [D](int input) { return input >= D && input < 2 * D; });
}

bool sees_teachers(const Skill& skill) {
  const auto& inputs = skill.models.front().inputs;
  return std::find(inputs.begin(), inputs.end(), 2 * static_cast<int>(skill.columns.size())) != inputs.end();
}

int teacher_number(const std::vector<Labels>& rows, const std::optional<std::string>& teacher) {
  std::vector<std::optional<std::string>> known;
  for (const auto& row : rows) {
    if (std::find(known.begin(), known.end(), row.teacher) != known.end()) continue;
    if (row.teacher == teacher) return static_cast<int>(known.size());
    known.push_back(row.teacher);
  }
  return -1;
}

Vector inputs_of(const SkillModel& model, const Reach& reach) {
  const Eigen::Index D = reach.change.size();
  Vector x(static_cast<Eigen::Index>(model.inputs.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const int input = model.inputs[static_cast<std::size_t>(i)];
    if (input == 2 * D) {
      x[i] = reach.teacher;
      continue;
    }
    const bool start = input >= D;
    x[i] = !start ? reach.change[input] : reach.offset.size() > 0 ? reach.offset[input - D] : 0.0;
  }
  return x;
}

double region_excess(const Skill& skill, const Reach& reach) {
  const auto D = static_cast<Eigen::Index>(skill.columns.size());
  double excess = 0;
  Matrix changes = Matrix::Zero(static_cast<Eigen::Index>(skill.rows.size()), D);
  Vector change = Vector::Zero(D);
  for (const auto& model : skill.models) {
    const Vector x = inputs_of(model, reach);
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      if (model.inputs[static_cast<std::size_t>(j)] == 2 * reach.change.size()) continue;  // a name has no region
      const auto column = model.process.X.col(j);
      excess = std::max(excess, beyond(column, x[j]));
      const int input = model.inputs[static_cast<std::size_t>(j)];
      if (input >= D) continue;
      changes.col(input) = column;
      change[input] = x[j];
    }
  }
  const Matrix centred = changes.rowwise() - changes.colwise().mean();
  const Matrix V = Eigen::JacobiSVD<Matrix>(centred, Eigen::ComputeFullV).matrixV();
  const Matrix turned = changes * V;
  const Eigen::RowVectorXd spans = turned.colwise().maxCoeff() - turned.colwise().minCoeff();
  for (Eigen::Index k = 1; k < D; ++k) {
    if (spans[k] < 0.1 * spans[0]) excess = std::max(excess, beyond(turned.col(k), V.col(k).dot(change)));
  }
  return excess;
}

SkillPredictor::SkillPredictor(Skill skill) : skill_(std::move(skill)) {
  for (const auto& model : skill_.models) predictors_.emplace_back(model.process);
}

WeightPrediction SkillPredictor::weights(const Reach& reach) const {
  const Eigen::Index D = static_cast<Eigen::Index>(skill_.columns.size());
  const Eigen::Index N = skill_.dmp.bases();
  WeightPrediction prediction{Matrix::Zero(D, N), Matrix::Zero(D, N)};
  for (std::size_t m = 0; m < predictors_.size(); ++m) {
    const SkillModel& model = skill_.models[m];
    const MvgpPrediction w = predictors_[m].predict(inputs_of(model, reach));
    const Vector sd = predictors_[m].weight_covariance(w.variance).diagonal().cwiseMax(0.0).cwiseSqrt();
    for (std::size_t j = 0; j < model.outputs.size(); ++j) {
      const Eigen::Index from = static_cast<Eigen::Index>(j) * N;
      prediction.mean.row(model.outputs[j]) = w.mean.segment(from, N).transpose();
      prediction.sd.row(model.outputs[j]) = sd.segment(from, N).transpose();
    }
  }
  return prediction;
}

Reach SkillPredictor::reach(const Goal& goal) const {
  const Vector start = goal.start.value_or(skill_.start);
  Reach reach(goal.position - start, start - skill_.start);
  reach.teacher = teacher_number(skill_.rows, goal.labels.teacher);
  return reach;
}

Dmp SkillPredictor::primitive(const Goal& goal) const {
  Dmp dmp;
  dmp.settings = skill_.dmp;
  dmp.start = goal.start.value_or(skill_.start);
  dmp.goal = goal.position;
  const Reach there = reach(goal);
  dmp.tau = goal.duration.value_or(skill_.duration.predict(there.change));
  dmp.weights = weights(there).mean;
  dmp.rmse = Vector::Zero(dmp.goal.size());
  return dmp;
}

Motion generate(const Dmp& primitive, std::optional<double> dt) {
  const double step = dt.value_or(primitive.tau / 200);
  SettleOptions settled;
  settled.tolerance /= std::sqrt(static_cast<double>(primitive.dimensions()));  // so that the distance is within it
  const double end = settle_time(primitive, settled);
  const double count = std::ceil(end / step - 1e-9);
  if (!(count < 1e7)) throw DataError("skill.dt", "the time step makes over 10^7 samples");
  Vector times(static_cast<Eigen::Index>(count) + 1);
  for (Eigen::Index i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) * step;
  return rollout(primitive, times);
}

}  // namespace lfd
