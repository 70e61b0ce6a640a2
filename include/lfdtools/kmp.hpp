// Kernelized movement primitives (Huang, Rozo, Silverio and Caldwell 2019).
#pragma once

#include "lfdtools/gmr.hpp"
#include "lfdtools/prediction.hpp"

namespace lfd {

/// Local KMPs, the formulation of theirs that generalises to new ends by local frames: every motion seen from a frame
/// at its start and from one at its goal. In each frame a GMM over (phase, position) of all examples and its GMR give a
/// reference distribution; start and goal of the query replace its first and last point (their desired points); the
/// KMP predicts mean and covariance; the two frames are fused by the product of Gaussians. 8 components, 41 reference
/// points, k(a, b) = exp(-8 (a - b)^2), lambda = 1, desired points with variance 1e-6 m^2. The band is that of the
/// fused distribution, without demonstration noise of its own.
[[nodiscard]] Predictor train_kmp(const Fold& fold, const PreparationOptions& options);

/// Reference distribution over the phase.
struct KmpReference {
  Vector phases;               ///< n
  Samples means;               ///< n x D
  CovarianceList covariances;  ///< n of D x D
};

struct KmpPrediction {
  Samples mean;                ///< T x D
  CovarianceList covariances;  ///< T of D x D
};

/// Mean k* (K + lambda Sigma)^-1 mu, covariance n / lambda (k** - k* (K + lambda Sigma)^-1
/// k*^T), K made of blocks k(s_i, s_j) I, Sigma block-diagonal.
/// @param phases  T   @param rate  of the kernel exp(-rate (a - b)^2)
[[nodiscard]] KmpPrediction predict_kmp(const KmpReference& reference, const Vector& phases, double rate,
                                        double lambda);

}  // namespace lfd
