// Multivariate Gaussian process regression from targets to DMP weights, paper eq. (15)-(27).
#pragma once

#include <cstdint>

#include "lfdtools/evidence.hpp"

namespace lfd {

/// Everything a prediction needs; the fields of a model in a skill file.
///   w(x*) A = m(x*) + k(x*, X) K'^-1 (Y - m(X)),   K' = K(X, X) + diag(noise)
/// For a given K' this mean does not depend on Omega: Omega shapes the uncertainty and, through the evidence, K'.
struct MvgpModel {
  Kernel kernel;
  double noise_variance = 0;       ///< relative to Omega as the kernel is; includes any jitter
  Vector noise;                    ///< noise variance of each row, n, in place of noise_variance; or empty
  MeanType mean = MeanType::zero;  ///< m(x)
  Matrix coefficients;             ///< of m: 0, 1 or 1+p rows (ones, x) times d
  Matrix X;                        ///< n x p [m]
  Matrix Y;                        ///< n x d, transformed: Y = W A
  Matrix output_transform;         ///< A, d x d, invertible; empty: the identity
  OmegaRule omega_rule = OmegaRule::integrated;
  Matrix omega;   ///< d x d: E[Omega | Y] = (Psi + S) / (n + nu - d - 1), or S / n with OmegaRule::ml
  double nu = 0;  ///< prior degrees of freedom; 0 with OmegaRule::ml
  Matrix psi;     ///< 1 x 1 (times the identity) or d x d; empty with OmegaRule::ml
  double log_marginal_likelihood = 0;  ///< ln p(Y | X) of `Evidence`, in the space of Y
};

/// Width of a log-normal prior on a hyperparameter: its logarithm is normal with the median's logarithm as mean.
struct LogNormalPrior {
  double median = 1;
  double log_sd = 0;  ///< 0: no prior
};

struct MvgpOptions {
  /// Terms to use; their length scales and free variances are starting values, found from the data when `optimise` is
  /// set. No terms: `sum_kernel`.
  Kernel kernel;
  double noise_variance = 0.01;  ///< used as it is when `optimise` is not set
  MeanType mean = MeanType::zero;
  /// Of `mean`, 1 or 1+p rows times d, in the space of weights (before A): known beforehand. Empty: by generalised
  /// least squares.
  Matrix coefficients;
  OmegaRule omega = OmegaRule::integrated;
  /// Psi, 1 x 1 or d x d. Empty: psi times the identity, psi = mean square of Y - M where M is known beforehand (of Y
  /// about its column means where an explicit mean is estimated), at least (1e-9)^2. With nu = d + 2 the prior mean of
  /// Omega is Psi, so all kernel and noise variances are shares of the data's mean square, and Psi itself needs no
  /// optimising.
  Matrix psi;
  /// student_t: nu, over d + 1, is searched for with the others, one for all groups, and Psi = (nu - d - 1) times `psi`
  /// of above, so that this stays the prior mean of Omega and kernel variances keep their meaning.
  ProcessType process = ProcessType::gaussian;
  double nu = 0;     ///< 0: d + 2
  Vector row_noise;  ///< factor on the noise variance of each row (0.1: mean of ten demonstrations); empty: ones
  LogNormalPrior length_scale;  ///< median in units of each input's range
  LogNormalPrior variance;      ///< of the terms of a sum
  LogNormalPrior noise;
  LogNormalPrior delta;  ///< nu - d - 1 of a Student-t process
  /// Power of the evidence beside the priors, in (0, 1]. Rows that repeat each other say less than the process, for
  /// which they are independent given the motion meant, believes: with targets / rows a target counts once.
  double evidence_power = 1;
  /// Hyperparameters come from the principal directions of Y - M whose mean square is at least this share of the whole
  /// group's, or of the largest group's: the evidence of those outputs alone (Omega's prior is marginalised with them).
  /// A direction in which nothing ever happens would be proof of no noise at all, with a weight that has no bound.
  double smallest_share = 0;
  bool optimise = true;
  int starts = 8;  ///< one from the distances of the rows, the others the best of seeded draws
  std::uint64_t seed = 1;
  unsigned jobs = 1;  ///< threads, 0: one a processor; the result is the same for any number
};

/// The published formulation: se-ard, zero mean, no priors, Omega integrated with Psi = mean square of Y times I.
[[nodiscard]] MvgpOptions paper_mvgp_options(int p);

/// The default: `sum_kernel`, zero mean (the constant and linear terms are a linear mean with a proper prior),
/// weak priors on all hyperparameters.
[[nodiscard]] MvgpOptions default_mvgp_options(int p);

/// Hyperparameters at the maximum of evidence (times priors, where given) inside a box: length scales 1e-3 to 1e3 times
/// the range of their input, variances 1e-12 to 1e4, noise variance 1e-14 to 1e2, nu - d - 1 of a Student-t process
/// 1e-3 to 1e4.
/// @param X  n x p, goal - start of each row [m], n >= 1
/// @param W  n x d, weights
/// @param A  d x d, invertible: distances of W A are distances of trajectories; empty: the identity
/// @throws DataError [mvgp.no_rows], [mvgp.not_finite], [mvgp.shape], [mvgp.bad_transform], [mvgp.bad_prior], those of
///         `Evidence` and `check_kernel`
[[nodiscard]] MvgpModel train_mvgp(const Eigen::Ref<const Matrix>& X, const Eigen::Ref<const Matrix>& W,
                                   const Matrix& A, const MvgpOptions& options);

/// The same for several groups of outputs, each with an Omega of its own, that share kernel and noise: the
/// hyperparameters at the maximum of the sum of their evidence.
/// @param W  groups, n x d each   @param A  of every group
/// @param coefficients  MvgpOptions::coefficients of each group; empty: of the options
[[nodiscard]] std::vector<MvgpModel> train_mvgp(const Eigen::Ref<const Matrix>& X, const std::vector<Matrix>& W,
                                                const Matrix& A, const MvgpOptions& options,
                                                const std::vector<Matrix>& coefficients = {});

struct MvgpPrediction {
  Vector mean;              ///< d, weights
  Vector mean_transformed;  ///< d, mean A
  /// k^ = k(x*,x*) - k K'^-1 k^T of (21), latent: without the noise of a demonstration, which adds noise_variance.
  /// The uncertainty of explicit mean coefficients is not in it (constant and linear kernel terms are the way to have
  /// it).
  double variance = 0;
  /// Of the multivariate Student-t of the row: nu + n - d + 1; its covariance is variance * omega. Infinite (Gaussian)
  /// with OmegaRule::ml.
  double degrees_of_freedom = 0;
};

/// Predictions from one model; factorises K' once.
class MvgpPredictor {
 public:
  /// @throws DataError [mvgp.bad_model] if fields disagree in size or value, or K' is not positive definite
  explicit MvgpPredictor(const MvgpModel& model);

  /// @param x  p [m]   @throws DataError [mvgp.shape], [mvgp.not_finite]
  [[nodiscard]] MvgpPrediction predict(const Eigen::Ref<const Vector>& x) const;

  /// Sigma^ of (21), m x m: cov(vec) of the transformed rows is Sigma^ kron omega, (22)-(23).  @param Xs  m x p [m]
  [[nodiscard]] Matrix latent_covariance(const Eigen::Ref<const Matrix>& Xs) const;

  /// Row covariance in the space of weights for a relative variance (latent, or latent plus noise):
  /// variance * A^-T omega A^-1, d x d.
  [[nodiscard]] Matrix weight_covariance(double variance) const;

 private:
  MvgpModel model_;
  Matrix L_;          // Cholesky factor of K'
  Matrix alpha_;      // K'^-1 (Y - m(X))
  Matrix A_inverse_;  // empty: the identity
};

/// One prediction; `MvgpPredictor` for several.
[[nodiscard]] MvgpPrediction predict(const MvgpModel& model, const Eigen::Ref<const Vector>& x);

/// ln p(Y | X) recomputed from the fields (explicit mean coefficients: those of the model's K').
[[nodiscard]] double log_evidence(const MvgpModel& model);

/// What is left of each row when its whole group is left out and predicted from the others, hyperparameters and mean
/// kept: e_g = ([K'^-1]_gg)^-1 [K'^-1 (Y - m(X))]_g, n x d, transformed as Y is. No process is trained again: the
/// inverse of a block of K'^-1 is the covariance of the group given the others.
/// @param groups  rows of each group, from 0; rows of no group are left at 0
[[nodiscard]] Matrix left_out_residuals(const MvgpModel& model, const std::vector<std::vector<std::size_t>>& groups);

/// K' of the model, n x n.
[[nodiscard]] Matrix noisy_covariance(const MvgpModel& model);

}  // namespace lfd
