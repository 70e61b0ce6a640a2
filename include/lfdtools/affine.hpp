// Motions affine in dP = goal - start, or in both ends: the opponents to fear.
#pragma once

#include "lfdtools/prediction.hpp"

namespace lfd {

/// Weights (1, dP) B by ordinary least squares, one row an example; of the B that fit equally well the smallest. Needs
/// primitives.
[[nodiscard]] Predictor train_affine(const Fold& fold, const PreparationOptions& options);

/// The same with one row a target: its mean dP and mean weights. Needs primitives.
[[nodiscard]] Predictor train_affine_means(const Fold& fold, const PreparationOptions& options);

/// Deviations from the straight line at equal phases, affine in dP with a proper prior on the slopes, one row an
/// example: Bayesian linear regression (Bishop 2006, Sec. 3.3 and 3.5), see fit_affine_prior. The line is linear in dP,
/// so but for the prior this is the map of `train_affine`.
[[nodiscard]] Predictor train_affine_prior(const Fold& fold, const PreparationOptions& options);

/// The same with both ends, (start, goal), as input: where the hand starts may matter beyond dP.
[[nodiscard]] Predictor train_affine_ends(const Fold& fold, const PreparationOptions& options);

/// B, (1 + p) x d.   @param X  n x p   @param Y  n x d
[[nodiscard]] Matrix fit_affine(const Matrix& X, const Matrix& Y);

/// y = mean_y + slopes^T (x - mean_x).
struct AffinePosterior {
  Vector mean_x;       ///< p
  Vector mean_y;       ///< d
  Matrix slopes;       ///< p x d, posterior mean
  double penalty = 0;  ///< noise variance over slope variance, in the unit of X squared

  [[nodiscard]] Vector operator()(const Vector& x) const { return mean_y + slopes.transpose() * (x - mean_x); }
};

/// Inputs centred, a flat prior on the value at their mean, slopes ~ N(0, slope variance) alike for all inputs and
/// outputs: slopes = (A^T A + penalty I)^-1 A^T (Y - mean_y), A the centred inputs. The penalty maximises the evidence
///   -ln p(Y) = d/2 ln|I + A A^T / penalty| + (n-1) d/2 ln tr(Y_c^T (I + A A^T / penalty)^-1 Y_c) + const,
/// in which the noise variance is at its maximum; searched between 1e-6 and 1e6 times the mean square of A.
/// @param X  n x p   @param Y  n x d, n >= 1
[[nodiscard]] AffinePosterior fit_affine_prior(const Matrix& X, const Matrix& Y);

}  // namespace lfd
