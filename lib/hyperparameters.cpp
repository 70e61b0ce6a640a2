#include "lfdtools/hyperparameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "lfdtools/box_minimum.hpp"
#include "lfdtools/parallel.hpp"
#include "lfdtools/random.hpp"

namespace lfd {

namespace {

constexpr Eigen::Index first_part = 60;  // rows on which the starts compete, where there are clearly more
constexpr int draws_per_start = 40;      // of which the best is descended from
constexpr BoxMinimumOptions competition = {.max_iterations = 60, .gradient_tolerance = 2e-2};

enum class Role { variance, length_scale, noise, degrees_of_freedom };

/// One hyperparameter: its logarithm's bounds, unit, first value, and prior.
struct Hyperparameter {
  Role role;
  double log_unit;  ///< ln of the input's range for a length scale, else 0
  double start;     ///< from the data
  LogNormalPrior prior;

  [[nodiscard]] double lower() const {
    if (role == Role::degrees_of_freedom) return std::log(1e-3);
    return log_unit + std::log(role == Role::length_scale ? 1e-3 : role == Role::variance ? 1e-12 : 1e-14);
  }
  [[nodiscard]] double upper() const {
    if (role == Role::degrees_of_freedom) return std::log(1e4);
    return log_unit + std::log(role == Role::length_scale ? 1e3 : role == Role::variance ? 1e4 : 1e2);
  }
  /// Where draws for further starts are taken, uniform in the logarithm.
  [[nodiscard]] double draw(Random& random) const {
    const double u = random.uniform();
    const bool degrees = role == Role::degrees_of_freedom;
    const double low = degrees ? 0.1 : role == Role::length_scale ? 0.02 : role == Role::variance ? 1e-3 : 1e-6;
    const double high = degrees ? 1e3 : role == Role::length_scale ? 50 : 10;
    return log_unit + std::log(low) + u * std::log(high / low);
  }
  /// Negative log prior density but for a constant, and its derivative added to `slope`.
  double penalty(double theta, double& slope) const {
    if (prior.log_sd <= 0) return 0;
    const double z = (theta - log_unit - std::log(prior.median)) / prior.log_sd;
    slope += z / prior.log_sd;
    return 0.5 * z * z;
  }
};

/// Range of each input; where an input is constant the largest range, or 1 m: any length scale will do there.
Vector input_ranges(const Matrix& X) {
  Vector range = (X.colwise().maxCoeff() - X.colwise().minCoeff()).transpose();
  const double largest = range.maxCoeff() > 0 ? range.maxCoeff() : 1.0;
  return (range.array() > 1e-9 * largest).select(range, largest);
}

double likely(const LogNormalPrior& prior, double without) {
  return std::log(prior.log_sd > 0 ? prior.median : without);
}

/// The hyperparameters in the order of `Evidence`.
std::vector<Hyperparameter> hyperparameters(const Kernel& kernel, const Matrix& X, const MvgpOptions& options) {
  const Vector range = input_ranges(X);
  std::vector<Hyperparameter> all;
  for (const auto& term : kernel.terms) {
    if (kernel.terms.size() > 1) all.push_back({Role::variance, 0, likely(options.variance, 0.3), options.variance});
    if (term.type == KernelType::linear || term.type == KernelType::constant) continue;
    for (const int j : term.inputs) {
      // Root mean square distance of two rows along this input, and as much more as there are inputs to share it.
      const double sd = std::sqrt((X.col(j).array() - X.col(j).mean()).square().mean());
      const double l = std::sqrt(2.0 * static_cast<double>(term.inputs.size())) * sd;
      const double unit = std::log(range(j));
      all.push_back({Role::length_scale, unit, std::max(std::log(l), unit + std::log(0.05)), options.length_scale});
    }
  }
  all.push_back({Role::noise, 0, likely(options.noise, 0.01), options.noise});
  // From nu = d + 2, that of the Gaussian process.
  if (options.process == ProcessType::student_t) all.push_back({Role::degrees_of_freedom, 0, 0, options.delta});
  return all;
}

struct Problem {
  const std::vector<Hyperparameter>& all;
  double power;  // of the evidence
  Vector lower, upper;

  Problem(const std::vector<Hyperparameter>& hyper, double evidence_power)
      : all(hyper), power(evidence_power), lower(static_cast<Eigen::Index>(hyper.size())), upper(lower.size()) {
    for (Eigen::Index i = 0; i < lower.size(); ++i) {
      lower(i) = at(i).lower();
      upper(i) = at(i).upper();
    }
  }
  [[nodiscard]] const Hyperparameter& at(Eigen::Index i) const { return all[static_cast<std::size_t>(i)]; }

  double operator()(Evidence& evidence, const Vector& theta, Vector* gradient) const {
    double value = power * evidence(theta, gradient);
    if (gradient != nullptr) *gradient *= power;
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      double unused = 0;
      value += at(i).penalty(theta(i), gradient != nullptr ? (*gradient)(i) : unused);
    }
    return value;
  }

  [[nodiscard]] BoxMinimum minimize(Evidence& evidence, const Vector& start, const BoxMinimumOptions& stop) const {
    const Objective objective = [&](const Vector& theta, Vector& gradient) {
      return (*this)(evidence, theta, &gradient);
    };
    return minimize_in_box(objective, start, lower, upper, stop);
  }

  /// Start number s: from the data for 0, else the best of a number of draws of its own.
  [[nodiscard]] Vector start(Evidence& evidence, int s, std::uint64_t seed) const {
    Vector best(lower.size());
    for (Eigen::Index i = 0; i < best.size(); ++i) best(i) = at(i).start;
    if (s == 0) return best;
    Random random = Random(seed).split(static_cast<std::uint64_t>(s));
    double best_value = std::numeric_limits<double>::infinity();
    Vector draw(lower.size());
    for (int k = 0; k < draws_per_start; ++k) {
      for (Eigen::Index i = 0; i < draw.size(); ++i) draw(i) = at(i).draw(random);
      const double value = (*this)(evidence, draw, nullptr);
      if (value < best_value) {
        best_value = value;
        best = draw;
      }
    }
    return best;
  }

  /// Short descents from all starts, best first.
  [[nodiscard]] std::vector<BoxMinimum> compete(const Evidence& evidence, const MvgpOptions& options) const {
    std::vector<BoxMinimum> found(static_cast<std::size_t>(std::max(1, options.starts)));
    parallel_for(found.size(), options.jobs, [&](std::size_t s) {
      Evidence own = evidence;
      found[s] = minimize(own, start(own, static_cast<int>(s), options.seed), competition);
    });
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
    return found;
  }
};

/// Rows of a seeded random subset, in rising order.
std::vector<Eigen::Index> random_subset(Eigen::Index n, Eigen::Index count, std::uint64_t seed) {
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(n));
  std::iota(rows.begin(), rows.end(), 0);
  Random random(seed);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    std::swap(rows[i], rows[i + random.below(rows.size() - i)]);
  }
  rows.resize(static_cast<std::size_t>(count));
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace

Vector hyperparameters_of_maximum_evidence(const Matrix& X, const std::vector<OutputBlock>& blocks,
                                           const Kernel& kernel, const EvidenceSettings& settings,
                                           const MvgpOptions& options) {
  const auto all = hyperparameters(kernel, X, options);
  const Problem problem(all, options.evidence_power);
  // An evaluation costs n^3, so with many rows the starts compete on a random part of them, and what wins there is
  // refined on larger and larger parts: the last step, on all rows, starts near its end and takes few evaluations.
  // A free Omega or a linear mean might be undetermined on a part of the rows.
  const bool parts = settings.omega == OmegaRule::integrated && settings.mean != MeanType::linear;
  std::vector<Evidence> stages;
  for (Eigen::Index m = first_part; parts && 3 * m < 2 * X.rows(); m *= 4) {
    const auto rows = random_subset(X.rows(), m, options.seed);
    EvidenceSettings part = settings;
    if (part.row_noise.size() > 0) part.row_noise = settings.row_noise(rows);
    std::vector<OutputBlock> outputs = blocks;
    for (auto& block : outputs) block.Y = block.Y(rows, Eigen::all).eval();
    stages.emplace_back(X(rows, Eigen::all), outputs, kernel, part);
  }
  stages.emplace_back(X, blocks, kernel, settings);

  const auto candidates = problem.compete(stages.front(), options);
  const auto refine = [&](BoxMinimum found) {
    for (std::size_t k = 1; k < stages.size(); ++k) {
      if (k + 1 < stages.size()) found = problem.minimize(stages[k], found.x, competition);
    }
    return problem.minimize(stages.back(), found.x, {});
  };
  const BoxMinimum& first = candidates.front();
  BoxMinimum best = refine(first);
  // A part of the rows says less about which optimum is better, but there another descent costs more.
  const bool partial = stages.size() > 1;
  const double margin = (partial ? 5.0 : 0.5) * options.evidence_power;
  int others = partial ? 1 : 4;
  for (const auto& next : candidates) {
    if (others == 0 || next.value > first.value + margin) break;
    // The same optimum, or another place on its flat ridge.
    if ((partial && next.value < first.value + 0.01) || (next.x - first.x).lpNorm<Eigen::Infinity>() < 0.3) continue;
    const BoxMinimum other = refine(next);
    if (other.value < best.value) best = other;
    --others;
  }
  return best.x;
}

}  // namespace lfd
