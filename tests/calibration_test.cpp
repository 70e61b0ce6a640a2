#include "lfdtools/calibration.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> xy = {"x", "y"};
const Vector phases = linspace(0, 1, 200);

/// What is meant for a goal: minimum jerk and a bump that bends with the goal, on x; y goes straight.
Samples meant(double goal) {
  const Vector line = phases.array().cube() * (10 + phases.array() * (-15 + 6 * phases.array()));
  Samples path(200, 2);
  path.col(0) = goal * line;
  path.col(1) = 0.2 * line;
  path.col(0).array() += 0.05 * std::sin(6 * goal) * (std::numbers::pi * phases.array()).sin().square();
  return path;
}

/// Demonstrations of one target: what is meant, what sets the target apart, and what sets each apart.
std::vector<SkillRow> demonstrate(const std::string& target, double goal, int repetitions, double target_sd,
                                  double own_sd, Random& random) {
  const auto wave = [&](double sd) {
    Samples wander = Samples::Zero(200, 2);
    for (int j = 0; j < 2; ++j) {
      for (const int k : {1, 2}) {
        wander.col(j).array() += sd * random.normal() * (k * std::numbers::pi * phases.array()).sin().square();
      }
    }
    return wander;
  };
  const Samples shared = meant(goal) + wave(target_sd);
  std::vector<SkillRow> rows;
  for (int r = 0; r < repetitions; ++r) {
    DmpFitOptions fit;
    fit.bases = 10;
    rows.push_back({{target, {}, std::to_string(r + 1), {}}, fit_dmp({2 * phases, shared + wave(own_sd)}, fit)});
  }
  return rows;
}

std::vector<SkillRow> demonstrations(int targets, int repetitions, double target_sd, double own_sd, Random& random) {
  std::vector<SkillRow> rows;
  for (int i = 0; i < targets; ++i) {
    const auto more = demonstrate(std::to_string(i + 1), 0.3 + 0.1 * i, repetitions, target_sd, own_sd, random);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

Vector change_to(double goal) {
  Vector change(2);
  change << goal, 0.2;
  return change;
}

}  // namespace

TEST_CASE("the unit variance is that of motions whose weights have the covariance Omega") {
  Random random(1);
  const SkillPredictor predictor(train_skill(xy, demonstrations(4, 3, 0.01, 0.01, random)));
  const Vector change = change_to(0.45);
  const PositionVariance variance = position_variance(predictor, change, phases);
  const Matrix covariance = predictor.processes()[1].weight_covariance(1);
  Dmp dmp = predictor.primitive({{}, change, Vector::Zero(2), 1.0});
  const Samples mean = rollout(dmp, phases).positions;
  Vector sum = Vector::Zero(200);
  const Matrix L = cholesky(covariance);
  constexpr int draws = 4000;
  const Matrix weights = dmp.weights;
  for (int i = 0; i < draws; ++i) {
    const Vector z = Vector::NullaryExpr(10, [&] { return random.normal(); });
    dmp.weights.row(1) = weights.row(1) + (L * z).transpose();
    sum += (rollout(dmp, phases).positions - mean).col(1).cwiseAbs2() / draws;
  }
  CHECK((sum - variance.unit.col(1)).cwiseAbs().maxCoeff() < 0.1 * variance.unit.col(1).maxCoeff());
  CHECK(variance.latent[1] == predictor.processes()[1].predict(change).variance);
  const Samples expected = variance.unit * (variance.latent + variance.noise / 4).asDiagonal();
  CHECK((variance.of_mean(Vector::Zero(2), 4) - expected).norm() < 1e-15);
}

TEST_CASE("factors are the quantiles of what was missed on targets left out, measured on rolled-out motions") {
  Random random(2);
  const auto rows = demonstrations(5, 4, 0.01, 0.02, random);
  SkillOptions options;
  const Skill skill = train_skill(xy, rows, options);
  const auto calibration = calibrate(skill, rows, options);
  REQUIRE(calibration);
  CHECK(calibration->targets == 5);
  options.starts = 1;
  SkillOptions knowing = options;
  knowing.hyperparameters = &skill;
  const auto quantile_at = [](std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    const double position = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    return values[below] + (position - std::floor(position)) * (values[below + 1] - values[below]);
  };
  const auto levels = nominal_levels();
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> q;
  for (const double level : levels) q.push_back(student_t_quantile((1 + level) / 2, infinite));
  std::vector<std::vector<double>> scores(levels.size()), greatest(levels.size());
  Vector effect = Vector::Zero(2);
  Vector latent = Vector::Zero(2);
  for (int pass = 0; pass < 2; ++pass) {  // the second uses the effect that the first found
    for (int target = 1; target <= 5; ++target) {
      std::vector<SkillRow> rest;
      Samples mean = Samples::Zero(200, 2);
      Vector change = Vector::Zero(2);
      for (const auto& row : rows) {
        if (row.labels.target != std::to_string(target)) {
          rest.push_back(row);
          continue;
        }
        Dmp unit = row.primitive;
        unit.tau = 1;
        mean += rollout(unit, phases).positions / 4;
        change += row.change() / 4;
      }
      const SkillPredictor predictor(train_skill(xy, rest, options));
      const Samples predicted = rollout(predictor.primitive({{}, change, Vector::Zero(2), 1.0}), phases).positions;
      const PositionVariance variance =
          position_variance(SkillPredictor(train_skill(xy, rest, knowing)), change, phases);
      if (pass == 0) {
        for (int j = 0; j < 2; ++j) {
          const double missed = (predicted - mean).col(j).squaredNorm();
          effect[j] += (missed / variance.unit.col(j).sum() - variance.noise[j] / 4) / 5;
        }
        latent += variance.latent / 5;
        continue;
      }
      for (std::size_t l = 0; l < levels.size(); ++l) {
        double most = 0;
        for (int k = 1; k < 199; ++k) {
          for (int j = 0; j < 2; ++j) {
            const double intention = variance.unit(k, j) * (variance.latent[j] + std::max(effect[j], latent[j])) +
                                     calibration->reproduction[j] * calibration->reproduction[j];
            const double noise = variance.unit(k, j) * variance.noise[j] / 4;
            const double missed =
                std::pow(predicted(k, j) - mean(k, j), 2) + calibration->reproduction[j] * calibration->reproduction[j];
            scores[l].push_back(std::sqrt(std::max(0.0, missed - q[l] * q[l] * noise) / intention));
            const double factor = calibration->pointwise[static_cast<Eigen::Index>(l)];
            most = std::max(most, std::sqrt(missed / (intention + std::pow(q[l] / factor, 2) * noise)));
          }
        }
        greatest[l].push_back(most);
      }
    }
  }
  CHECK((calibration->target_variance - effect.cwiseMax(latent)).norm() < 1e-6 * effect.norm());
  double pointwise = 0, path = 0;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const auto i = static_cast<Eigen::Index>(l);
    CHECK(calibration->levels[i] == levels[l]);
    // Four degrees of freedom of whole targets, eight of both axes.
    const double few = student_t_quantile((1 + levels[l]) / 2, 4) / q[l];
    const double few_of_both_axes = student_t_quantile((1 + levels[l]) / 2, 8) / q[l];
    pointwise = std::max({pointwise, 0.5 * q[l], quantile_at(scores[l], levels[l])});
    CHECK(calibration->pointwise[i] == Approx(few_of_both_axes * pointwise).epsilon(1e-6));
    std::sort(greatest[l].begin(), greatest[l].end());
    const int rank = std::min(5, static_cast<int>(std::ceil(6 * levels[l])));
    path = std::max({path, pointwise, greatest[l][static_cast<std::size_t>(rank - 1)]});
    CHECK(calibration->path[i] == Approx(few * path).epsilon(1e-6));
  }
}

TEST_CASE("bands hold what they promise on new targets of the same kind") {
  Random random(3);
  double samples = 0;
  double paths = 0;
  constexpr int trials = 30;
  for (int trial = 0; trial < trials; ++trial) {
    auto rows = demonstrations(6, 5, 0.02, 0.01, random);
    SkillOptions options;
    options.starts = 1;
    Skill skill = train_skill(xy, rows, options);
    skill.calibration = calibrate(skill, rows, options);
    const SkillPredictor predictor(skill);
    const Vector change = change_to(0.55);
    const auto fresh = demonstrate("new", 0.55, 50, 0.02, 0.01, random);
    Samples truth = Samples::Zero(200, 2);
    for (const auto& row : fresh) {
      Dmp unit = row.primitive;
      unit.tau = 1;
      truth += rollout(unit, phases).positions / 50;
    }
    const Samples error =
        (rollout(predictor.primitive({{}, change, Vector::Zero(2), 1.0}), phases).positions - truth).cwiseAbs();
    const auto inside = [&](const Samples& half_width) {
      return (error.array() <= half_width.array()).middleRows(1, 198).cast<double>().eval();
    };
    samples += inside(band(predictor, change, phases, BandKind::pointwise)).mean() / trials;
    paths += inside(band(predictor, change, phases, BandKind::path)).minCoeff() / trials;
  }
  INFO("pointwise " << samples << ", paths " << paths);
  CHECK(samples > 0.88);
  CHECK(samples < 1);
  CHECK(paths > 0.7);  // 6 / 7 but for chance: two sd of thirty trials
}

TEST_CASE("a target that two teachers showed is left out with the rows of both") {
  Random random(6);
  auto rows = demonstrations(6, 3, 0.03, 0.001, random);
  SkillOptions options;
  options.starts = 1;
  // Widest half-width of a skill's band on the way to a new goal [m].
  const auto width = [&options](const std::vector<SkillRow>& of) {
    Skill skill = train_skill(xy, of, options);
    skill.calibration = calibrate(skill, of, options);
    REQUIRE(skill.calibration);
    CHECK(skill.calibration->targets == 6);
    return band(SkillPredictor(skill), change_to(0.55), phases, BandKind::pointwise).maxCoeff();
  };
  const double alone = width(rows);
  for (std::size_t i = 0; i < 18; ++i) {
    rows[i].labels.teacher = "anna";
    rows.push_back(rows[i]);
    rows.back().labels.teacher = "bert";
    rows.back().primitive.weights *= 1.001;
  }
  // The rows of bert would tell nearly all of what sets a target of anna apart.
  CHECK(width(rows) > 0.7 * alone);
}

TEST_CASE("without a calibration the band is the process's own") {
  Random random(4);
  const SkillPredictor predictor(train_skill(xy, demonstrations(4, 2, 0.01, 0.01, random)));
  const Vector change = change_to(0.5);
  const double nu = predictor.processes()[0].predict(change).degrees_of_freedom;
  const Samples sd = position_variance(predictor, change, phases).of_mean(Vector::Zero(2), 1).cwiseSqrt();
  const Samples half = band(predictor, change, phases, BandKind::pointwise, 0.9, 1);
  const double factor = student_t_quantile(0.95, nu) * std::sqrt((nu - 2) / nu);
  CHECK((half - factor * sd).norm() < 1e-12);
}

TEST_CASE("too few targets that differ are not calibrated") {
  Random random(5);
  auto rows = demonstrations(2, 3, 0.01, 0.01, random);
  CHECK_FALSE(calibrate(train_skill(xy, rows), rows, {}));
  rows = demonstrations(3, 3, 0.01, 0.01, random);
  for (auto& row : rows) {
    if (row.labels.target == "2") row.primitive.goal = rows.front().primitive.goal;
  }
  CHECK_FALSE(calibrate(train_skill(xy, rows), rows, {}));
}

TEST_CASE("the kernel is chosen by targets left out: inputs that act together need their common term") {
  std::vector<SkillRow> rows;
  DmpFitOptions fit;
  fit.bases = 8;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      Vector goal(2);
      goal << 0.3 + 0.1 * i, 0.1 + 0.1 * k;
      const Vector line = phases.array().cube() * (10 + phases.array() * (-15 + 6 * phases.array()));
      Samples path = line * goal.transpose();
      const double together = 4 * (goal[0] - 0.45) * (goal[1] - 0.25);  // no sum of functions of one input each
      path.col(0).array() += together * (std::numbers::pi * phases.array()).sin().square();
      rows.push_back({{std::to_string(4 * i + k), {}, {}, {}}, fit_dmp({2 * phases, path}, fit)});
    }
  }
  CHECK(choose_kernel(xy, rows, {}) == SkillKernel::sum);
  SkillOptions options;
  options.kernel = SkillKernel::matern52;
  CHECK(choose_kernel(xy, rows, options) == SkillKernel::matern52);
  options = {};
  options.paper = true;
  CHECK(choose_kernel(xy, rows, options) == SkillKernel::automatic);
  rows.resize(2);
  CHECK(choose_kernel(xy, rows, {}) == SkillKernel::sum);
}
