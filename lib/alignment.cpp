#include "lfdtools/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lfdtools/dtw.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/interpolation.hpp"
#include "lfdtools/parallel.hpp"

// How warp_onto finds its minimum: DTW gives the basin. The tie means of its path, made strictly rising, are smoothed
// with the squared speed as weight; Gauss-Newton steps, each the same pentadiagonal system, refine them. Where the hand
// stands still the weight is zero and the stiffness alone decides: idle ends make no plateaus, and noise decides
// nothing.

namespace lfd {
namespace {

using Eigen::Index;

constexpr Index grid = 201;  // phases at which a warp is sought
constexpr int gauss_newton_steps = 12;
constexpr int barycentre_rounds = 5;

/// A demonstration over phase.
class PhasePath {
 public:
  explicit PhasePath(const Trajectory& clean) : spline_(clean.times / clean.duration(), clean.positions) {}
  [[nodiscard]] Samples operator()(const Vector& s) const { return spline_(s); }
  [[nodiscard]] Samples derivative(const Vector& s) const { return spline_.derivative(s); }

 private:
  CubicSpline spline_;
};

/// Elapsed times from 0; samples nearer than a tenth of the median interval to the one before are merged with it, those
/// so near to the first or the last, which stay as they are, left out.
Trajectory cleaned(const Trajectory& demonstration) {
  check(demonstration);
  const Index n = demonstration.samples();
  const Vector t = demonstration.times.array() - demonstration.times[0];
  std::vector<double> intervals;
  for (Index i = 1; i < n; ++i) intervals.push_back(t[i] - t[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  const double least = 0.1 * *middle;
  Trajectory out{Vector::Zero(n), demonstration.positions};
  Index kept = 1;
  for (Index i = 1, end = 0; i < n - 1; i = end) {
    for (end = i + 1; end < n - 1 && t[end] - t[i] < least;) ++end;
    if (t[i] < least || t[n - 1] - t[end - 1] < least) continue;
    out.times[kept] = t.segment(i, end - i).mean();
    out.positions.row(kept) = demonstration.positions.middleRows(i, end - i).colwise().mean();
    ++kept;
  }
  out.times[kept] = t[n - 1];
  out.positions.row(kept) = demonstration.positions.row(n - 1);
  out.times.conservativeResize(kept + 1);
  out.positions.conservativeResize(kept + 1, Eigen::NoChange);
  return out;
}

/// The strictly rising curve through the tie means of a path between two series on the grid, at the grid: ties of j for
/// one i are averaged, then ties of i for one such mean.
Vector through_ties(const std::vector<std::pair<Index, Index>>& steps) {
  Vector sum = Vector::Zero(grid);
  Vector count = Vector::Zero(grid);
  for (const auto& [i, j] : steps) {
    sum[i] += static_cast<double>(j);
    count[i] += 1;
  }
  const Vector mean = sum.cwiseQuotient(count);
  const auto last = static_cast<double>(grid - 1);
  Vector x = Vector::Zero(grid + 2);
  Vector y = Vector::Zero(grid + 2);
  Index n = 1;  // (0, 0) stands
  for (Index i = 0, end = 0; i < grid; i = end) {
    for (end = i + 1; end < grid && mean[end] == mean[i];) ++end;
    const double centre = 0.5 * static_cast<double>(i + end - 1);
    if (centre <= 0 || mean[i] <= 0 || centre >= last || mean[i] >= last) continue;
    x[n] = centre / last;
    y[n++] = mean[i] / last;
  }
  x[n] = y[n] = 1;
  return Pchip(x.head(n + 1), y.head(n + 1))(linspace(0, 1, grid));
}

/// The displacement u, 0 at both ends of the grid, that minimises  sum_i w_i (u_i - v_i)^2 + warp_stiffness * integral
/// u''^2, given w and b_i = w_i v_i: Whittaker smoothing, one pentadiagonal L D L^T.
Vector smooth(const Vector& w, const Vector& b) {
  const Index n = grid - 2;
  const double step = 1.0 / static_cast<double>(grid - 1);
  const double p = warp_stiffness / (step * step * step);
  Vector D(n);
  Vector L1 = Vector::Zero(n);
  Vector L2 = Vector::Zero(n);
  Vector u = Vector::Zero(grid);
  auto z = u.segment(1, n);
  for (Index i = 0; i < n; ++i) {
    D[i] = w[i + 1] + p * (i == 0 || i == n - 1 ? 5 : 6);
    z[i] = b[i + 1];
    if (i > 1) {
      L2[i] = p / D[i - 2];
      D[i] -= L2[i] * p;
      z[i] -= L2[i] * z[i - 2];
    }
    if (i > 0) {
      const double off = -4 * p - (i > 1 ? p * L1[i - 1] : 0.0);
      L1[i] = off / D[i - 1];
      D[i] -= L1[i] * off;
      z[i] -= L1[i] * z[i - 1];
    }
  }
  for (Index i = n - 1; i >= 0; --i) {
    z[i] /= D[i];
    if (i + 1 < n) z[i] -= L1[i + 1] * z[i + 1];
    if (i + 2 < n) z[i] -= L2[i + 2] * z[i + 2];
  }
  return u;
}

/// A warp brought within the limits of slope and band by moving it towards the identity, no farther than needed.
Vector limited(const Vector& phi, std::optional<double> window) {
  const Vector s = linspace(0, 1, grid);
  const Vector slope = (phi.tail(grid - 1) - phi.head(grid - 1)) * static_cast<double>(grid - 1);
  const Vector off = phi - s;
  double share = 1;
  share = std::min(share, (steepest_warp - 1) / std::max(slope.maxCoeff() - 1, 1e-300));
  share = std::min(share, (1 - 1 / steepest_warp) / std::max(1 - slope.minCoeff(), 1e-300));
  if (window) share = std::min(share, *window / std::max(off.cwiseAbs().maxCoeff(), 1e-300));
  return s + share * off;
}

/// phi at the grid phases. @param reference  grid x D
Vector phase_warp(const Samples& reference, const PhasePath& path, std::optional<double> window) {
  const Vector s = linspace(0, 1, grid);
  const double V = (reference.rowwise() - reference.colwise().mean()).rowwise().squaredNorm().mean();
  if (!(V > 0)) return s;  // a reference that stands still says nothing about time
  const double weight = 1.0 / (V * static_cast<double>(grid));
  const auto speed_weights = [&](const Samples& velocity) -> Vector {
    return weight * velocity.rowwise().squaredNorm();
  };
  const auto objective = [&](const Vector& phi) {
    const Vector bend = phi.head(grid - 2) - 2 * phi.segment(1, grid - 2) + phi.tail(grid - 2);
    return weight * (path(phi) - reference).squaredNorm() +
           warp_stiffness * bend.squaredNorm() * std::pow(static_cast<double>(grid - 1), 3);
  };
  Vector phi = through_ties(dtw(reference, path(s), DtwOptions{window}).steps);
  Vector w = speed_weights(path.derivative(phi));
  phi = limited(s + smooth(w, w.cwiseProduct(phi - s)), window);
  double best = objective(phi);
  for (int iteration = 0; iteration < gauss_newton_steps; ++iteration) {
    const Samples velocity = path.derivative(phi);
    const Vector pull = weight * (path(phi) - reference).cwiseProduct(velocity).rowwise().sum();
    w = speed_weights(velocity);
    const Vector whole = s + smooth(w, w.cwiseProduct(phi - s) - pull);
    double gain = 0;
    for (double length = 1; length > 0.1 && !(gain > 0); length /= 2) {
      const Vector trial = limited(phi + length * (whole - phi), window);
      gain = best - objective(trial);
      if (gain > 0) phi = trial;
    }
    if (!(gain > 1e-4 * best)) break;
    best -= gain;
  }
  return phi;
}

/// DTW barycentre averaging (Petitjean et al. 2011): each sample becomes the mean of all samples matched with it.
Samples barycentre(Samples mean, const std::vector<Samples>& paths, std::optional<double> window) {
  for (int round = 0; round < barycentre_rounds; ++round) {
    Samples sum = Samples::Zero(mean.rows(), mean.cols());
    Vector count = Vector::Zero(mean.rows());
    for (const Samples& path : paths) {
      for (const auto& [i, j] : dtw(mean, path, DtwOptions{window}).steps) {
        sum.row(i) += path.row(j);
        count[i] += 1;
      }
    }
    mean = sum.array().colwise() / count.array();
  }
  return mean;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void check_group(const std::vector<Trajectory>& demonstrations, const AlignmentOptions& options) {
  if (demonstrations.empty()) throw DataError("alignment.empty", "there are no demonstrations to align");
  if (options.samples && *options.samples < 2) {
    throw UsageError("alignment.samples", "an aligned demonstration needs at least two samples");
  }
  const auto M = static_cast<Index>(demonstrations.size());
  if (options.reference == Reference::chosen && (options.chosen < 0 || options.chosen >= M)) {
    throw UsageError("alignment.chosen",
                     fmt::format("there is no demonstration {} in a group of {}", options.chosen, M));
  }
  for (const Trajectory& demonstration : demonstrations) {
    check(demonstration);
    if (demonstration.dimensions() != demonstrations[0].dimensions()) {
      throw DataError("alignment.dimensions", "the demonstrations of a group differ in their signals");
    }
  }
}

/// Place in `kept` of the demonstration that the others are warped to.
std::size_t reference_place(const GroupAlignment& group, const AlignmentOptions& options) {
  std::size_t best = 0;
  double best_score = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < group.kept.size(); ++k) {
    const Index m = group.kept[k];
    double score = 0;
    if (options.reference == Reference::chosen) {
      score = m == options.chosen ? 1 : 0;
    } else if (options.reference == Reference::longest) {
      score = group.trimmed[static_cast<std::size_t>(m)].trajectory.duration();
    } else {
      for (const Index other : group.kept) score -= group.costs(m, other);
    }
    if (score > best_score) {
      best = k;
      best_score = score;
    }
  }
  return best;
}

}  // namespace

Vector Warp::operator()(const Vector& s) const {
  return Pchip(phases, elapsed)(s);
}

Trimmed trim(const Trajectory& demonstration, double threshold) {
  check(demonstration);
  if (!(threshold > 0 && threshold < 1)) {
    throw UsageError("alignment.trim", fmt::format("the trim threshold {} is not in (0, 1)", threshold));
  }
  const Vector& t = demonstration.times;
  const Index n = t.size();
  const double half = 0.5 * std::min(0.2, demonstration.duration() / 20);
  Vector speed(n);
  for (Index i = 0, from = 0, to = 0; i < n; ++i) {
    const double middle = std::clamp(t[i], t[0] + half, t[n - 1] - half);
    while (from < n - 2 && t[from + 1] <= middle - half) ++from;
    while (to < n - 1 && (t[to] < middle + half || to <= from)) ++to;
    speed[i] = (demonstration.positions.row(to) - demonstration.positions.row(from)).norm() / (t[to] - t[from]);
  }
  const double limit = threshold * speed.maxCoeff();
  if (!(limit > 0)) throw DataError("alignment.no_motion", "nothing moves in a demonstration that is to be trimmed");
  Index first = 0;
  while (speed[first] < limit) ++first;
  Index last = n - 1;
  while (speed[last] < limit) --last;
  first = std::max<Index>(first - 1, 0);
  last = std::min(last + 1, n - 1);
  const Index left = last - first + 1;
  return {
      {t.segment(first, left), demonstration.positions.middleRows(first, left)}, t[first] - t[0], t[n - 1] - t[last]};
}

Matrix pairwise_costs(const std::vector<Trajectory>& demonstrations, std::optional<double> window, unsigned jobs) {
  const auto M = static_cast<Index>(demonstrations.size());
  std::vector<std::pair<Index, Index>> pairs;
  for (Index a = 0; a < M; ++a) {
    for (Index b = a + 1; b < M; ++b) pairs.emplace_back(a, b);
  }
  Matrix costs = Matrix::Zero(M, M);
  parallel_for(pairs.size(), jobs, [&](std::size_t k) {
    const auto [a, b] = pairs[k];
    costs(a, b) = dtw_cost(demonstrations[static_cast<std::size_t>(a)].positions,
                           demonstrations[static_cast<std::size_t>(b)].positions, DtwOptions{window});
    costs(b, a) = costs(a, b);
  });
  return costs;
}

std::vector<bool> find_outliers(const Matrix& costs, double deviations) {
  const Index M = costs.rows();
  std::vector<bool> flags(static_cast<std::size_t>(M), false);
  if (M < 4) return flags;
  std::vector<double> means;
  for (Index m = 0; m < M; ++m) means.push_back(costs.row(m).sum() / static_cast<double>(M - 1));
  const double middle = median(means);
  std::vector<double> distances;
  for (const double mean : means) distances.push_back(std::abs(mean - middle));
  const double limit = middle + std::max(deviations * 1.4826 * median(distances), 0.1 * middle);
  std::transform(means.begin(), means.end(), flags.begin(), [&](double mean) { return mean > limit; });
  return flags;
}

Warp warp_onto(const Trajectory& reference, const Trajectory& demonstration, std::optional<double> window) {
  const Vector s = linspace(0, 1, grid);
  const Trajectory own = cleaned(demonstration);
  const Vector phi = phase_warp(PhasePath(cleaned(reference))(s), PhasePath(own), window);
  return {s, own.duration() * phi};
}

GroupAlignment align(const std::vector<Trajectory>& demonstrations, const AlignmentOptions& options) {
  check_group(demonstrations, options);
  GroupAlignment out;
  std::vector<Trajectory> recorded;
  for (const Trajectory& demonstration : demonstrations) {
    out.trimmed.push_back(options.trim ? trim(demonstration, *options.trim) : Trimmed{demonstration, 0, 0});
    recorded.push_back(out.trimmed.back().trajectory);
  }
  out.costs = pairwise_costs(recorded, options.window, options.jobs);
  out.outliers = find_outliers(out.costs, options.outlier_deviations);
  for (std::size_t m = 0; m < recorded.size(); ++m) {
    const bool asked_for = options.reference == Reference::chosen && options.chosen == static_cast<Index>(m);
    if (!options.leave_out_outliers || !out.outliers[m] || asked_for) out.kept.push_back(static_cast<Index>(m));
  }
  const std::size_t r = reference_place(out, options);
  out.reference = out.kept[r];

  const std::size_t K = out.kept.size();
  const Vector s = linspace(0, 1, grid);
  std::vector<Trajectory> own;
  std::vector<PhasePath> paths;
  std::vector<Samples> sampled;
  for (const Index m : out.kept) {
    own.push_back(cleaned(recorded[static_cast<std::size_t>(m)]));
    paths.emplace_back(own.back());
    sampled.push_back(paths.back()(s));
  }
  const bool averaged = options.reference == Reference::barycentre;
  const Samples reference = averaged ? barycentre(sampled[r], sampled, options.window) : sampled[r];
  out.warps.resize(K);
  parallel_for(K, options.jobs, [&](std::size_t k) {
    const Vector phi = k == r && !averaged ? s : phase_warp(reference, paths[k], options.window);
    out.warps[k].elapsed = own[k].duration() * phi;
  });

  // The same knots serve every warp: at knot i all hands are at the same place of the motion. What remains is to say
  // when that is on the group's clock; composing with the inverse of the mean warp means no more than taking its values
  // as phases.
  Vector clock = Vector::Zero(grid);
  for (const Warp& warp : out.warps) clock += warp.elapsed / static_cast<double>(K);
  const double duration = clock[grid - 1];
  if (options.clock == Clock::reference) clock = out.warps[r].elapsed;
  const Vector phases = clock / clock[grid - 1];
  const Index samples = options.samples.value_or(recorded[static_cast<std::size_t>(out.reference)].samples());
  const Trajectory blank{linspace(0, duration, samples), Samples()};
  out.aligned.assign(K, blank);
  parallel_for(K, options.jobs, [&](std::size_t k) {
    out.warps[k].phases = phases;
    out.aligned[k].positions = CubicSpline(own[k].times, own[k].positions)(out.warps[k](linspace(0, 1, samples)));
  });
  return out;
}

}  // namespace lfd
