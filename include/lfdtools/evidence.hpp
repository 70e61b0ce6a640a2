// Negative log evidence of the multivariate process and its gradient, paper eq. (18), Omega integrated or free.
#pragma once

#include <vector>

#include "lfdtools/kernel.hpp"

namespace lfd {

enum class MeanType { zero, constant, linear };
enum class OmegaRule {
  integrated,  ///< Omega ~ inverse-Wishart(Psi, nu), integrated out
  ml           ///< the paper's reading: Omega free, at its maximum S / n
};

/// Which process, of those of Chen, Wang and Gorban (reference [34] of the paper).
enum class ProcessType {
  gaussian,  ///< nu of the inverse-Wishart is given
  /// The matrix-variate t, MT(nu_t, M, K', Omega), whose Omega is fixed up to its scale: left free its likelihood has
  /// no bound, as with the Gaussian process. It is the evidence of an integrated Omega with nu = nu_t + d - 1, and its
  /// nu is one of the hyperparameters.
  student_t
};

/// Rows of the basis of an explicit mean: n x 0, n x 1 (ones) or n x (1+p) (ones, X).
[[nodiscard]] Matrix mean_basis(MeanType mean, const Eigen::Ref<const Matrix>& X);

/// What the evidence needs beside X, Y and the kernel.
struct EvidenceSettings {
  OmegaRule omega = OmegaRule::integrated;
  MeanType mean = MeanType::zero;
  Matrix psi;        ///< 1 x 1: psi times the identity; or d x d, positive definite [unit of Y squared]
  double nu = 0;     ///< degrees of freedom of the inverse-Wishart, > d - 1
  Vector row_noise;  ///< factor on the noise variance of each row, n, positive; empty: ones
  /// student_t: nu and Psi follow from theta, nu = d + 1 + delta and Psi = delta times the psi given here, so that psi
  /// is the prior mean of Omega whatever nu is; delta = nu_t - 2 is how many rows the prior counts for in E[Omega | Y].
  ProcessType process = ProcessType::gaussian;
};

/// Outputs with an Omega of their own.
struct OutputBlock {
  Matrix Y;       ///< n x d
  Matrix psi;     ///< 1 x 1: psi times the identity; or d x d, positive definite [unit of Y squared]
  double nu = 0;  ///< > d - 1
};

/// -ln p(Y | X, theta) for Y ~ MN(M, K', Omega), K' = K + sigma_n^2 diag(row_noise), as a function of
/// theta = (log_hyperparameters of the kernel, ln sigma_n^2) and, of a Student-t process, ln delta. With S = (Y-M)^T
/// K'^-1 (Y-M):
///   integrated  nd/2 ln pi + d/2 ln|K'| + (n+nu)/2 ln|Psi+S| - nu/2 ln|Psi| - lnGamma_d((n+nu)/2) + lnGamma_d(nu/2)
///   ml          nd/2 ln 2pi + d/2 ln|K'| + n/2 ln|S/n| + nd/2
/// Both depend on Y only through Y Psi^-1 Y^T, so Y is turned once into at most n columns: an evaluation costs n^3
/// whatever d is. The coefficients of an explicit mean are those of generalised least squares at each K': they make S
/// smallest in the Loewner order, so they maximise either form, and the gradient needs no derivative of them (envelope
/// theorem). An object holds its working memory: one a thread.
///
/// Several blocks of outputs may share K' and differ in Omega: independent given theta, so their evidence adds up, and
/// K' is factorised once for all.
class Evidence {
 public:
  /// @param X  n x p [m]   @param Y  n x d
  /// @throws DataError [mvgp.mean_rank] if the rows do not determine the explicit mean;
  ///         [mvgp.omega_unbounded] if Omega is free and the rows left by the mean are not more than d, or the outputs
  ///         are linearly dependent
  Evidence(const Eigen::Ref<const Matrix>& X, const Eigen::Ref<const Matrix>& Y, const Kernel& kernel,
           const EvidenceSettings& settings);
  /// The same for several blocks; psi and nu of the settings are not used.
  Evidence(const Eigen::Ref<const Matrix>& X, const std::vector<OutputBlock>& blocks, const Kernel& kernel,
           const EvidenceSettings& settings);

  [[nodiscard]] Eigen::Index size() const { return kernel_size_ + (student_t_ ? 2 : 1); }

  /// Value at theta, and with it the gradient when a pointer is given. +inf if K' is not numerically positive definite.
  double operator()(const Vector& theta, Vector* gradient = nullptr);

 private:
  struct Block {
    Matrix Y;       // n x r, r = min(n, d): Y Psi^-1/2 turned
    double d;       // outputs
    double weight;  // n + nu or n; of a Student-t process set by theta
    Matrix Z, S;    // working memory
  };
  [[nodiscard]] Block turned(const OutputBlock& outputs);
  bool factorize(const Vector& theta);  // sets K_ to L; false: not positive definite

  Kernel kernel_;
  KernelMatrix kernel_matrix_;
  Vector row_noise_;
  Matrix H_;  // n x q, basis of the explicit mean
  Eigen::Index kernel_size_, n_;
  bool integrated_, student_t_;
  double constant_ = 0;  // terms without theta
  std::vector<Block> blocks_;
  Matrix K_;  // working memory
};

}  // namespace lfd
