// Gaussian mixture regression: one path from the demonstrations of a target, paper eq. (4)-(7).
#pragma once

#include "lfdtools/gmm.hpp"

namespace lfd {

/// T covariances of D x D in one piece of memory; reads like a list of matrices.
class CovarianceList {
 public:
  CovarianceList() = default;
  CovarianceList(Eigen::Index count, Eigen::Index dimensions)
      : entries_(count, dimensions * dimensions), dimensions_(dimensions) {}

  [[nodiscard]] Eigen::Index size() const { return entries_.rows(); }
  [[nodiscard]] bool empty() const { return entries_.rows() == 0; }
  [[nodiscard]] Eigen::Index dimensions() const { return dimensions_; }
  /// Matrix i, D x D, symmetric.
  [[nodiscard]] Eigen::Map<const Matrix> operator[](Eigen::Index i) const {
    return {entries_.data() + i * entries_.cols(), dimensions_, dimensions_};
  }
  [[nodiscard]] Eigen::Map<Matrix> operator[](Eigen::Index i) {
    return {entries_.data() + i * entries_.cols(), dimensions_, dimensions_};
  }

 private:
  Samples entries_;  // T x D*D
  Eigen::Index dimensions_ = 0;
};

struct GmrOptions {
  bool covariance = true;   ///< fill GmrPath::covariance
  bool derivative = false;  ///< fill GmrPath::derivative
  int vector_width = 0;     ///< one of vector_widths() (lanes.hpp); 0: the widest. The result does not depend on it
};

/// The signal given the time.
struct GmrPath {
  Vector times;               ///< T [s]
  Samples mean;               ///< xi^, T x D
  CovarianceList covariance;  ///< T of D x D, positive definite; empty unless asked for
  Samples derivative;         ///< d xi^ / dt, closed form, T x D; 0 x 0 unless asked for
};

/// Conditional mean and covariance of the signal given the time, paper eq. (4)-(7). h_k is the responsibility of
/// component k for the time alone, pi_k N(t; mu_k^t, Sigma_k^t), normalised; the mixture over k becomes one Gaussian by
/// moment matching: covariance = sum_k h_k (Sigma^_k + (xi^_k - xi^)(xi^_k - xi^)^T).
/// @param gmm    over (t, signal): 1 + D dimensions, time first
/// @param times  T queries [s], finite, in any order; far outside the data the component with the widest time rules
/// @throws DataError as check(gmm); [gmr.shape] if the mixture has the time alone or over 64 dimensions,
/// [gmr.not_finite] for a query,
///         [gmr.out_of_range] for a query so far away that its distance in standard deviations overflows when squared;
///         UsageError [gmr.vector_width]
[[nodiscard]] GmrPath gmr(const Gmm& gmm, const Vector& times, const GmrOptions& options = {});

}  // namespace lfd
