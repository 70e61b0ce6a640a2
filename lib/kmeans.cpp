#include "lfdtools/kmeans.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

using Eigen::Index;

/// Lowers `nearest` (N, squared distances) by those to center c, and sets the label where it did.
void assign(const Matrix& samples, const Samples& centers, Index c, std::vector<double>& nearest,
            std::vector<int>& labels) {
  constexpr Index block = 512;
  const Index N = samples.rows();
  double distance[block];
  double* best = nearest.data();
  int* label = labels.data();
  const int name = static_cast<int>(c);
  for (Index first = 0; first < N; first += block) {
    const Index count = std::min(block, N - first);
    std::fill(distance, distance + count, 0.0);
    for (Index j = 0; j < samples.cols(); ++j) {
      const double* x = samples.data() + j * N + first;
      const double m = centers(c, j);
      for (Index i = 0; i < count; ++i) distance[i] += (x[i] - m) * (x[i] - m);
    }
    for (Index i = 0; i < count; ++i) {
      const bool closer = distance[i] < best[first + i];
      best[first + i] = closer ? distance[i] : best[first + i];
      label[first + i] = closer ? name : label[first + i];
    }
  }
}

/// Index drawn with a chance proportional to the weight; any index when all weights are 0.
Index draw(const std::vector<double>& weights, Random& random) {
  double total = 0.0;
  for (const double w : weights) total += w;
  const double u = random.uniform() * total;
  if (!(total > 0.0)) return static_cast<Index>(random.below(weights.size()));
  double below = 0.0;
  Index last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    below += weights[i];
    last = static_cast<Index>(i);
    if (u < below) break;
  }
  return last;
}

}  // namespace

KMeans kmeans(const Matrix& samples, Index k, Random& random, int max_iterations) {
  const Index N = samples.rows();
  if (k < 1 || N < k) {
    throw DataError("kmeans.too_few_samples", std::to_string(k) + " clusters for " + std::to_string(N) + " samples");
  }
  if (!samples.allFinite()) throw DataError("kmeans.not_finite", "a sample is not a finite number");
  const auto size = static_cast<std::size_t>(N);
  KMeans result;
  result.centers.resize(k, samples.cols());
  result.labels.assign(size, 0);
  std::vector<double> nearest(size, std::numeric_limits<double>::max());
  result.centers.row(0) = samples.row(static_cast<Index>(random.below(size)));
  assign(samples, result.centers, 0, nearest, result.labels);
  for (Index c = 1; c < k; ++c) {
    result.centers.row(c) = samples.row(draw(nearest, random));
    assign(samples, result.centers, c, nearest, result.labels);
  }

  std::vector<int> before;
  Samples sums(k, samples.cols());
  Vector counts(k);
  while (result.iterations < max_iterations && before != result.labels) {
    before = result.labels;
    ++result.iterations;
    sums.setZero();
    counts.setZero();
    for (Index i = 0; i < N; ++i) {
      const int c = result.labels[static_cast<std::size_t>(i)];
      sums.row(c) += samples.row(i);
      counts[c] += 1.0;
    }
    for (Index c = 0; c < k; ++c) {
      if (counts[c] > 0.0) {
        result.centers.row(c) = sums.row(c) / counts[c];
      } else {
        const auto farthest = std::max_element(nearest.begin(), nearest.end());
        result.centers.row(c) = samples.row(farthest - nearest.begin());
        *farthest = 0.0;  // the next empty cluster takes another
      }
    }
    std::fill(nearest.begin(), nearest.end(), std::numeric_limits<double>::max());
    for (Index c = 0; c < k; ++c) assign(samples, result.centers, c, nearest, result.labels);
  }
  for (const double d : nearest) result.inertia += d;
  return result;
}

}  // namespace lfd
