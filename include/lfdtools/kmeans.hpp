// k-means: the starts of EM.
#pragma once

#include <vector>

#include "lfdtools/linalg.hpp"
#include "lfdtools/random.hpp"

namespace lfd {

struct KMeans {
  Samples centers;          ///< K x D
  std::vector<int> labels;  ///< N, index of the nearest center
  double inertia = 0;       ///< sum of squared distances to the nearest center
  int iterations = 0;       ///< Lloyd's iterations done
};

/// k-means++ seeding (Arthur and Vassilvitskii 2007), then Lloyd's iterations until no label changes. A cluster that
/// runs empty takes the sample farthest from its center.
/// @param samples  N x D, stored column by column   @param k  1 .. N
/// @throws DataError [kmeans.too_few_samples] if N < k, [kmeans.not_finite]
[[nodiscard]] KMeans kmeans(const Matrix& samples, Eigen::Index k, Random& random, int max_iterations);

}  // namespace lfd
