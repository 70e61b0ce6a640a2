#include "lfdtools/fold.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/gmm.hpp"
#include "lfdtools/gmr.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/random.hpp"

namespace lfd {
namespace {

constexpr Eigen::Index reference_samples = 200;

/// `count` of the recordings, drawn without replacement, in their order; all where there are no more.
std::vector<Trajectory> drawn(const std::vector<Trajectory>& recordings, std::size_t count, Random random) {
  if (count >= recordings.size()) return recordings;
  std::vector<std::size_t> order(recordings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = 0; i < count; ++i) std::swap(order[i], order[i + random.below(order.size() - i)]);
  order.resize(count);
  std::sort(order.begin(), order.end());
  std::vector<Trajectory> chosen;
  for (const std::size_t i : order) chosen.push_back(recordings[i]);
  return chosen;
}

Example example(const Trajectory& motion, const Vector& start, const Vector& goal, const PreparationOptions& options,
                bool primitive) {
  Example result{start, goal, at_phases(motion, phase_count), {}};
  if (primitive) {
    DmpFitOptions fit;
    fit.bases = options.bases;
    fit.start = start;
    fit.goal = goal;
    result.primitive = fit_dmp(motion, fit);
  }
  return result;
}

/// The published fit. Its gate on small |g - y0| is lifted, and its verdict kept.
void add_paper(TrainingTarget& target, const ReferencePath& reference, const PreparationOptions& options) {
  DmpFitOptions fit;
  fit.bases = options.bases;
  fit.start = reference.start;
  fit.goal = reference.goal;
  fit.fit = DmpFitMethod::lwr;
  fit.scaling = DmpScaling::goal;
  fit.allow_small_scale = true;
  target.paper = fit_dmp(reference.path, fit);
  for (const bool small : small_goal_change(reference.path, reference.start, reference.goal)) {
    target.small_change = target.small_change || small;
  }
}

}  // namespace

Samples Example::deviation() const {
  return path - straight_line(start, goal, linspace(0, 1, path.rows()));
}

std::vector<Trajectory> recorded(const TargetDemonstrations& target, const AlignmentOptions& options) {
  std::vector<Trajectory> recordings;
  for (const auto& demonstration : target.demonstrations) {
    recordings.push_back(options.trim ? trim(demonstration, *options.trim).trajectory : demonstration);
  }
  if (!options.leave_out_outliers) return recordings;
  const auto outliers =
      find_outliers(pairwise_costs(recordings, options.window, options.jobs), options.outlier_deviations);
  std::vector<Trajectory> kept;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!outliers[i]) kept.push_back(recordings[i]);
  }
  return kept;
}

JudgedTarget judged_target(const Labels& labels, const std::vector<Trajectory>& recordings) {
  JudgedTarget target;
  target.labels = labels;
  target.mean_path = mean_path(recordings, phase_count);
  target.query = {target.mean_path.row(0).transpose(), target.mean_path.row(phase_count - 1).transpose(),
                  static_cast<double>(recordings.size()), labels.teacher};
  const Vector phases = linspace(0, 1, phase_count);
  double squares = 0;
  for (const auto& recording : recordings) {
    const Samples path = at_phases(recording, phase_count);
    squares += (path - target.mean_path).rowwise().squaredNorm().mean();
    target.deviations.push_back(path - straight_line(recording.start(), recording.goal(), phases));
  }
  const auto M = static_cast<double>(recordings.size());
  if (recordings.size() > 1) target.noise_floor = std::sqrt(squares / (M - 1) / M);
  return target;
}

TrainingTarget training_target(const Labels& labels, const std::vector<Trajectory>& recordings,
                               const PreparationOptions& options, const Needs& needs, std::uint64_t stream) {
  TrainingTarget target;
  target.labels = labels;
  const auto chosen =
      options.repetitions ? drawn(recordings, *options.repetitions, Random(options.seed).split(stream)) : recordings;
  if (options.road == Road::recordings) {
    for (const auto& motion : chosen) {
      target.examples.push_back(example(motion, motion.start(), motion.goal(), options, needs.primitives));
    }
  }
  if (options.road != Road::recordings || needs.paper) {
    AlignmentOptions alignment = options.alignment;  // idle ends and outliers are gone already
    alignment.trim.reset();
    alignment.leave_out_outliers = false;
    const auto aligned = align(chosen, alignment).aligned;
    if (options.road == Road::demonstrations) {
      for (const auto& motion : aligned) {
        target.examples.push_back(example(motion, motion.start(), motion.goal(), options, needs.primitives));
      }
    }
    if (options.road == Road::references || needs.paper) {
      const ReferencePath reference = reference_path(aligned, options);
      if (options.road == Road::references) {
        target.examples.push_back(example(reference.path, reference.start, reference.goal, options, needs.primitives));
      }
      if (needs.paper) add_paper(target, reference, options);
    }
  }
  target.start = Vector::Zero(target.examples.front().start.size());
  target.goal = target.start;
  for (const auto& row : target.examples) {
    target.start += row.start / static_cast<double>(target.examples.size());
    target.goal += row.goal / static_cast<double>(target.examples.size());
  }
  return target;
}

Samples straight_line(const Vector& start, const Vector& goal, const Vector& phases) {
  const Vector mj = phases.array().cube() * (10 + phases.array() * (-15 + 6 * phases.array()));
  return (mj * (goal - start).transpose()).rowwise() + start.transpose();
}

ReferencePath reference_path(const std::vector<Trajectory>& aligned, const PreparationOptions& options) {
  const Eigen::Index T = aligned.front().samples();
  const Eigen::Index D = aligned.front().dimensions();
  Samples pooled(T * static_cast<Eigen::Index>(aligned.size()), 1 + D);
  ReferencePath reference{{}, Vector::Zero(D), Vector::Zero(D)};
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    pooled.middleRows(static_cast<Eigen::Index>(i) * T, T) << aligned[i].times, aligned[i].positions;
    reference.start += aligned[i].start() / static_cast<double>(aligned.size());
    reference.goal += aligned[i].goal() / static_cast<double>(aligned.size());
  }
  EmOptions em;
  em.seed = options.seed;
  const auto selection = select_components(pooled, options.k_from, options.k_to, {}, em);
  const Vector times = linspace(pooled.col(0).minCoeff(), pooled.col(0).maxCoeff(), reference_samples);
  GmrOptions mean_alone;
  mean_alone.covariance = false;
  reference.path = {times, gmr(selection.fit.gmm, times, mean_alone).mean};
  return reference;
}

}  // namespace lfd
