// Covariance functions of the process: the kernel K of K' = K + sigma_n^2 I, paper eq. (16)-(18).
#pragma once

#include <string_view>
#include <vector>

#include "lfdtools/linalg.hpp"

namespace lfd {

enum class KernelType { se_ard, matern32, matern52, linear, constant };

/// Name in model files: "se-ard", "matern32", "matern52", "linear", "constant".
[[nodiscard]] std::string_view kernel_type_name(KernelType type);

/// @throws DataError [kernel.unknown_type]
[[nodiscard]] KernelType kernel_type_from_name(std::string_view name);

/// One term. With r^2 = sum_j ((a_j - b_j) / l_j)^2 over its inputs j:
///   se_ard    variance * exp(-r^2 / 2)                                      (the paper names it without writing it)
///   matern32  variance * (1 + sqrt(3) r) exp(-sqrt(3) r)
///   matern52  variance * (1 + sqrt(5) r + 5 r^2 / 3) exp(-sqrt(5) r)
///   linear    variance * sum_j a_j b_j / l_j^2                              (through the origin; add a constant term)
///   constant  variance
/// In a linear term variance and length scales say the same twice, so training moves the variance alone and keeps the
/// length scales, which only give the variance its unit.
struct KernelTerm {
  KernelType type = KernelType::se_ard;
  double variance = 1;      ///< relative to Omega, no unit, positive
  std::vector<int> inputs;  ///< columns of X that it sees, from 0, each once; empty for a constant
  Vector length_scales;     ///< one per input [m], positive; empty for a constant
  /// Column of X in which two rows must agree, else the term is 0 between them: what rows of one teacher share. -1:
  /// none.
  int within = -1;
};

/// A term or a sum of terms.
struct Kernel {
  std::vector<KernelTerm> terms;
};

/// The paper's kernel: one se-ard term over all p inputs, variance and length scales 1.
[[nodiscard]] Kernel se_ard_kernel(int p);

/// constant + one linear term a group of inputs + one Matern-3/2 term an input: each input acts for itself.
[[nodiscard]] Kernel additive_kernel(const std::vector<std::vector<int>>& groups);
/// All inputs in one group.
[[nodiscard]] Kernel additive_kernel(int p);

/// The additive kernel + one se-ard term over the first group (left out where that is one input): what inputs do only
/// together.
[[nodiscard]] Kernel sum_kernel(const std::vector<std::vector<int>>& groups);
/// All inputs in one group.
[[nodiscard]] Kernel sum_kernel(int p);

/// The kernel + a constant and one linear term a group that hold within equal values of a column alone: a smooth
/// function that all share, and each one's own departure from it.
/// @param within  column of X
[[nodiscard]] Kernel with_own_part(Kernel kernel, const std::vector<std::vector<int>>& groups, int within);

/// Refuses a kernel that cannot be used with p inputs.
/// @throws DataError [kernel.no_terms], [kernel.bad_inputs], [kernel.bad_length_scales], [kernel.bad_variance]
void check_kernel(const Kernel& kernel, int p);

/// K(A, B), m x n.  @param A  m x p [m]   @param B  n x p [m]
[[nodiscard]] Matrix covariance(const Kernel& kernel, const Eigen::Ref<const Matrix>& A,
                                const Eigen::Ref<const Matrix>& B);

/// K(X, X), n x n, both triangles, without noise.  @param X  n x p [m]
[[nodiscard]] Matrix covariance(const Kernel& kernel, const Eigen::Ref<const Matrix>& X);

/// k(x, x).  @param x  p [m]
[[nodiscard]] double prior_variance(const Kernel& kernel, const Eigen::Ref<const Vector>& x);

/// Free hyperparameters in logarithms, term by term: ln variance (in a sum of several terms only: of a single term the
/// variance and the scale of Omega are one parameter, so it stays), then ln length scales (se-ard and Matern terms).
[[nodiscard]] Vector log_hyperparameters(const Kernel& kernel);

/// The kernel with these hyperparameters; the inverse of `log_hyperparameters`.
/// @throws DataError [kernel.hyperparameter_count]
[[nodiscard]] Kernel with_log_hyperparameters(Kernel kernel, const Eigen::Ref<const Vector>& theta);

/// K(X, X) and gradients for one set of rows, again and again with other hyperparameters: memory is kept between calls.
class KernelMatrix {
 public:
  /// @param X  n x p [m], copied
  KernelMatrix(const Eigen::Ref<const Matrix>& X, const Kernel& kernel);

  /// Sets the lower triangle of K to K(X, X) under `kernel`, which has the terms of the constructor's.
  void evaluate(const Kernel& kernel, Matrix& K);

  /// sum_ij V_ij dK_ij / dtheta for each theta of `log_hyperparameters`, at the kernel of the last `evaluate`.
  /// @param V  n x n, symmetric; only the lower triangle is read
  void gradient(const Matrix& V, Eigen::Ref<Vector> gradient) const;

 private:
  Matrix X_;
  Kernel kernel_;
  std::vector<Matrix> K_;      // lower triangle of each term; empty for a constant that holds between all rows
  std::vector<Matrix> slope_;  // dk / d ln l_j = slope * ((a_j - b_j) / l_j)^2; empty where that is K itself (se-ard)
};

}  // namespace lfd
