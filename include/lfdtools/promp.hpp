// Probabilistic movement primitives (Paraschos, Daniel, Peters and Neumann 2013).
#pragma once

#include "lfdtools/prediction.hpp"

namespace lfd {

/// Motions are y(s) = Phi(s) w with weights w ~ N(mu, Sigma) over all examples of all targets, and N normalised
/// Gaussian basis functions over the phase a signal, fitted to each example by least squares. A query conditions the
/// distribution on its start and goal with a standard deviation of 1 mm. Of fewer examples than weights the sample
/// covariance is singular: it is shrunk towards a multiple of the identity as far as the data ask for
/// (shrunk_covariance). The band is that of the conditioned distribution: of one demonstration.
[[nodiscard]] Predictor train_promp(const Fold& fold, const PreparationOptions& options);

/// Gaussian distribution of weights.
struct WeightDistribution {
  Vector mean;        ///< d
  Matrix covariance;  ///< d x d
};

/// w given H w = values + N(0, variance I).   @param H  m x d   @param values  m
[[nodiscard]] WeightDistribution conditioned(const WeightDistribution& prior, const Matrix& H, const Vector& values,
                                             double variance);

/// Ledoit and Wolf (2004): (1 - r) S + r (tr S / d) I, S = sum of outer products of the centred rows over n, with the
/// share r that makes the expected squared error least, estimated from the rows.
/// @param rows  n x d, n >= 1
[[nodiscard]] Matrix shrunk_covariance(const Matrix& rows);

/// Normalised Gaussian basis functions over the phase, centres equally spaced, widths 0.8 times the spacing; T x N.
/// @param phases  T   @param bases  N >= 2
[[nodiscard]] Matrix phase_basis(const Vector& phases, Eigen::Index bases);

}  // namespace lfd
