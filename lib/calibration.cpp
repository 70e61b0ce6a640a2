#include "lfdtools/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "lfdtools/gaussian.hpp"
#include "lfdtools/parallel.hpp"

namespace lfd {
namespace {

constexpr double least_factor = 0.5;  // in normal quantiles
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Targets without which there is still something to learn from.
std::vector<std::vector<std::size_t>> groups_to_leave_out(const std::vector<SkillRow>& rows) {
  auto groups = target_groups(labels_of(rows));
  std::erase_if(groups, [&](const auto& group) { return !is_trainable(without(rows, group)); });
  return groups;
}

/// Positions of the rows of a target, by teacher.
std::vector<std::vector<std::size_t>> repetitions_in(const std::vector<SkillRow>& rows,
                                                     const std::vector<std::size_t>& target) {
  std::vector<Labels> labels;
  for (const std::size_t i : target) labels.push_back(rows[i].labels);
  auto groups = repetition_groups(labels);
  for (auto& group : groups) {
    for (std::size_t& i : group) i = target[i];
  }
  return groups;
}

/// What was missed on one target, as one teacher reaches it.
struct Miss {
  Samples error;  // phase_count x D [m]
  PositionVariance variance;
  double repetitions = 1;
};

/// Mean reach of the rows of a target.
Reach mean_reach(const std::vector<SkillRow>& rows, const std::vector<std::size_t>& group, const Skill& skill) {
  Reach reach(Vector::Zero(skill.start.size()), -skill.start);
  reach.teacher = teacher_number(skill.rows, rows[group.front()].labels.teacher);
  for (const std::size_t i : group) {
    reach.change += rows[i].change() / static_cast<double>(group.size());
    reach.offset += rows[i].primitive.start / static_cast<double>(group.size());
  }
  return reach;
}

/// Predicted path less the mean path of a target, phase_count x D [m]. The mean of the free responses is the free
/// response to the mean change, so what differs is the forced part alone.
Samples error_on(const SkillPredictor& predictor, const std::vector<SkillRow>& rows,
                 const std::vector<std::size_t>& group, const Matrix& R) {
  const Reach reach = mean_reach(rows, group, predictor.skill());
  Matrix force = predictor.weights(reach).mean;
  if (predictor.skill().dmp.scaling == DmpScaling::goal) force = reach.change.asDiagonal() * force;
  for (const std::size_t i : group) {
    const Dmp& row = rows[i].primitive;
    force -= row.scale().asDiagonal() * row.weights / static_cast<double>(group.size());
  }
  return R * force.transpose();
}

/// @param searched  gives the error   @param known  the same rows under the skill's own hyperparameters: gives the sd
Miss miss(const SkillPredictor& searched, const SkillPredictor& known, const std::vector<SkillRow>& rows,
          const std::vector<std::size_t>& group, const Matrix& R) {
  Miss result;
  result.repetitions = static_cast<double>(group.size());
  result.error = error_on(searched, rows, group, R);
  result.variance = position_variance(known, mean_reach(rows, group, known.skill()), linspace(0, 1, phase_count));
  return result;
}

/// Value at a share of the sorted values, between neighbours in proportion.
double quantile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(position), sorted.size() - 1);
  const double next = sorted[std::min(i + 1, sorted.size() - 1)];
  return sorted[i] + (position - static_cast<double>(i)) * (next - sorted[i]);
}

/// The smallest of the sorted values that holds a new one with the probability asked for, else the largest.
double conformal_quantile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * (static_cast<double>(sorted.size()) + 1) - 1e-9);
  return sorted[std::min(sorted.size(), static_cast<std::size_t>(std::max(1.0, rank))) - 1];
}

/// An sd that was measured on few values has the tails of a Student-t: by how much its quantile exceeds the normal one.
double few_values(double degrees_of_freedom, double level) {
  return student_t_quantile((1 + level) / 2, degrees_of_freedom) / student_t_quantile((1 + level) / 2, infinite);
}

Vector effect_of_target(const std::vector<std::vector<Miss>>& misses) {
  Vector missed = Vector::Zero(misses.front().front().error.cols());
  Vector latent = missed;
  for (const auto& target : misses) {
    const double m = static_cast<double>(misses.size() * target.size());
    for (const auto& miss : target) {
      for (Eigen::Index j = 0; j < missed.size(); ++j) {
        const double unit = miss.variance.unit.col(j).sum();
        if (unit > 0)
          missed[j] += (miss.error.col(j).squaredNorm() / unit - miss.variance.noise[j] / miss.repetitions) / m;
      }
      latent += miss.variance.latent / m;
    }
  }
  return missed.cwiseMax(latent);
}

/// Of the mean of some demonstrations, T x D [m^2].
Samples of_noise(const PositionVariance& variance, double repetitions) {
  return variance.unit * (variance.noise / repetitions).asDiagonal();
}

/// What the squared factors multiply, T x D [m^2].
Samples of_intention(const PositionVariance& variance, const Calibration& calibration) {
  Samples total = variance.of_mean(calibration.target_variance, infinite);
  total.rowwise() += calibration.reproduction.array().square().matrix().transpose();
  return total;
}

/// Squares of what was missed on one target, with what its primitives miss of the recordings, beside the variances that
/// have to hold them, all phase_count - 2 x D: both ends are given to the motion, so they say nothing [m^2].
struct Scored {
  Samples squares, intention, noise;
};

Scored scored(const Miss& miss, const Calibration& calibration) {
  const auto inner = [](const Samples& all) -> Samples { return all.middleRows(1, phase_count - 2); };
  Samples squares = miss.error.cwiseAbs2();
  squares.rowwise() += calibration.reproduction.array().square().matrix().transpose();
  return {inner(squares), inner(of_intention(miss.variance, calibration)).cwiseMax(1e-24),
          inner(of_noise(miss.variance, miss.repetitions))};
}

void set_factors(Calibration& calibration, const std::vector<std::vector<Miss>>& misses) {
  std::vector<std::vector<Scored>> targets;
  for (const auto& target : misses) {
    targets.emplace_back();
    for (const auto& miss : target) targets.back().push_back(scored(miss, calibration));
  }
  const auto& levels = nominal_levels();
  calibration.levels = Eigen::Map<const Vector>(levels.data(), static_cast<Eigen::Index>(levels.size()));
  calibration.pointwise = calibration.path = Vector::Zero(calibration.levels.size());
  const double degrees = static_cast<double>(targets.size()) - 1;
  const double axes = static_cast<double>(calibration.target_variance.size());
  double pointwise = 0, path = 0;  // of the level before: bands of rising levels hold each other
  for (Eigen::Index i = 0; i < calibration.levels.size(); ++i) {
    const double level = calibration.levels[i];
    const double q = student_t_quantile((1 + level) / 2, infinite);
    std::vector<double> all, greatest;
    for (const auto& target : targets) {
      for (const auto& one : target) {
        const Samples ratio = ((one.squares - q * q * one.noise).array().max(0.0) / one.intention.array()).sqrt();
        all.insert(all.end(), ratio.data(), ratio.data() + ratio.size());
      }
    }
    std::sort(all.begin(), all.end());
    pointwise = std::max({pointwise, least_factor * q, quantile(all, level)});
    calibration.pointwise[i] = few_values(axes * degrees, level) * pointwise;
    for (const auto& target : targets) {
      greatest.push_back(0);
      for (const auto& one : target) {
        const Samples held = one.intention + std::pow(q / calibration.pointwise[i], 2) * one.noise;
        greatest.back() = std::max(greatest.back(), std::sqrt((one.squares.array() / held.array()).maxCoeff()));
      }
    }
    std::sort(greatest.begin(), greatest.end());
    path = std::max({path, pointwise, conformal_quantile(greatest, level)});
    calibration.path[i] = few_values(degrees, level) * path;
  }
}

double factor(const Calibration& calibration, BandKind kind, double level) {
  const Vector& factors = kind == BandKind::path ? calibration.path : calibration.pointwise;
  const Vector& levels = calibration.levels;
  if (level <= levels[0]) return factors[0] * level / levels[0];
  for (Eigen::Index i = 1; i < levels.size(); ++i) {
    if (level > levels[i]) continue;
    const double share = (level - levels[i - 1]) / (levels[i] - levels[i - 1]);
    return factors[i - 1] + share * (factors[i] - factors[i - 1]);
  }
  return factors[factors.size() - 1];
}

}  // namespace

const std::vector<double>& nominal_levels() {
  static const std::vector<double> levels = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99};
  return levels;
}

Samples PositionVariance::of_mean(const Vector& extra, double repetitions) const {
  return unit * (latent + extra + noise / repetitions).asDiagonal();
}

PositionVariance position_variance(const SkillPredictor& predictor, const Reach& reach, const Vector& phases) {
  const Skill& skill = predictor.skill();
  const Eigen::Index D = reach.change.size();
  const Eigen::Index N = skill.dmp.bases();
  const Matrix R = response_matrix(skill.dmp, 1.0, phases);
  PositionVariance result{Samples::Zero(phases.size(), D), Vector::Zero(D), Vector::Zero(D)};
  for (std::size_t m = 0; m < skill.models.size(); ++m) {
    const SkillModel& model = skill.models[m];
    const MvgpPredictor& process = predictor.processes()[m];
    const double latent = process.predict(inputs_of(model, reach)).variance;
    const Matrix covariance = process.weight_covariance(1);
    const double noise = model.process.noise.size() > 0 ? model.process.noise.mean() : model.process.noise_variance;
    for (std::size_t j = 0; j < model.outputs.size(); ++j) {
      const Eigen::Index axis = model.outputs[j];
      const Eigen::Index from = static_cast<Eigen::Index>(j) * N;
      const Matrix block = covariance.block(from, from, N, N);
      result.unit.col(axis) = ((R * block).array() * R.array()).rowwise().sum().max(0.0);
      if (skill.dmp.scaling == DmpScaling::goal) result.unit.col(axis) *= reach.change[axis] * reach.change[axis];
      result.latent[axis] = latent;
      result.noise[axis] = noise;
    }
  }
  return result;
}

Samples band(const SkillPredictor& predictor, const Reach& reach, const Vector& phases, BandKind kind, double level,
             double repetitions) {
  const PositionVariance variance = position_variance(predictor, reach, phases);
  const auto& calibration = predictor.skill().calibration;
  if (!calibration) {
    const double nu =
        predictor.processes().front().predict(inputs_of(predictor.skill().models.front(), reach)).degrees_of_freedom;
    // The covariance is nu / (nu - 2) times the squared scale that the quantile multiplies.
    const double scale = std::isfinite(nu) ? std::sqrt((nu - 2) / nu) : 1.0;
    return student_t_quantile(0.5 + level / 2, nu) * scale *
           variance.of_mean(Vector::Zero(variance.latent.size()), repetitions).cwiseSqrt();
  }
  const double scale = factor(*calibration, kind, level);
  const double pointwise = factor(*calibration, BandKind::pointwise, level);
  const double noise = (pointwise > 0 ? scale / pointwise : 1) * student_t_quantile(0.5 + level / 2, infinite);
  return (scale * scale * of_intention(variance, *calibration) + noise * noise * of_noise(variance, repetitions))
      .cwiseSqrt();
}

Vector covariance_factors(const SkillPredictor& predictor, const Reach& reach) {
  const auto& calibration = predictor.skill().calibration;
  if (!calibration) return {};
  constexpr double level = 0.95;
  const double share = factor(*calibration, BandKind::pointwise, level) / student_t_quantile((1 + level) / 2, infinite);
  const Vector latent = position_variance(predictor, reach, linspace(0, 1, 2)).latent.cwiseMax(1e-300);
  return share * share * (Vector::Ones(latent.size()) + calibration->target_variance.cwiseQuotient(latent));
}

std::optional<Calibration> calibrate(const Skill& skill, const std::vector<SkillRow>& rows,
                                     const SkillOptions& options) {
  const auto groups = groups_to_leave_out(rows);
  if (groups.size() < 3) return {};
  SkillOptions searching = options;
  searching.starts = 1;
  searching.jobs = 1;
  searching.teachers = sees_teachers(skill) ? SkillTeachers::apart : SkillTeachers::together;
  searching.inputs = sees_starts(skill) ? SkillInputs::change_and_start : SkillInputs::change;
  SkillOptions knowing = searching;
  knowing.hyperparameters = &skill;
  const Matrix R = response_matrix(rows.front().primitive.settings, 1.0, linspace(0, 1, phase_count));
  std::vector<std::vector<Miss>> misses(groups.size());
  parallel_for(groups.size(), options.jobs, [&](std::size_t g) {
    const auto rest = without(rows, groups[g]);
    const SkillPredictor searched(train_skill(skill.columns, rest, searching));
    const SkillPredictor known(train_skill(skill.columns, rest, knowing));
    for (const auto& repeated : repetitions_in(rows, groups[g])) {
      misses[g].push_back(miss(searched, known, rows, repeated, R));
    }
  });

  Calibration calibration;
  calibration.targets = static_cast<int>(groups.size());
  calibration.target_variance = effect_of_target(misses);
  calibration.reproduction = Vector::Zero(rows.front().primitive.dimensions());
  for (const auto& row : rows)
    calibration.reproduction += row.primitive.rmse.cwiseAbs2() / static_cast<double>(rows.size());
  calibration.reproduction = calibration.reproduction.cwiseSqrt();

  set_factors(calibration, misses);
  return calibration;
}

}  // namespace lfd
