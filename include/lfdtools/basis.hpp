// Gaussian basis functions of the phase, and the forcing features made of them.
#pragma once

#include "lfdtools/canonical.hpp"
#include "lfdtools/linalg.hpp"

namespace lfd {

/// psi_i(x) = exp(-(x - c_i)^2 / (2 sigma_i^2)), paper eq. (13).
struct Basis {
  Vector centers;  ///< c_i, N, in phase [1]
  Vector widths;   ///< sigma_i, N, in phase [1], positive

  [[nodiscard]] Eigen::Index size() const { return centers.size(); }
};

/// N centres equally spaced in time over the motion, c_i = exp(-alpha_x (i - 1) / (N - 1)); the width is 0.8 times the
/// distance to the next centre, the last width is that of the one before.
/// @param bases  N >= 2
/// @throws DataError [dmp.basis] for N < 2 and for so many that neighbouring centres coincide; [dmp.alpha_x]
[[nodiscard]] Basis make_basis(Eigen::Index bases, const CanonicalSystem& canonical = {});

/// @throws DataError [dmp.basis] unless there are as many centres as widths, at least one, all finite, widths positive
void check(const Basis& basis);

/// psi_i(x), N values, paper eq. (13). @param x  phase
[[nodiscard]] Vector activations(const Basis& basis, double x);

/// psi_i(x) / sum_j psi_j(x), N values that sum to 1. Computed relative to the strongest function, so that it is
/// defined where every psi_i underflows, far from all centres.
[[nodiscard]] Vector normalized_activations(const Basis& basis, double x);

/// Forcing features of unit scale, paper eq. (12) and (24): row k is x_k psi_i(x_k) / sum_j psi_j(x_k), so that the
/// forcing term is forcing_features(...) * w * s.
/// @param x  T phases   @return T x N
[[nodiscard]] Matrix forcing_features(const Basis& basis, const Vector& x);

/// The shortest relative time t / tau in which a normalised activation changes from one function to the next: what a
/// quadrature over time has to resolve.
[[nodiscard]] double time_resolution(const Basis& basis, const CanonicalSystem& canonical);

}  // namespace lfd
