#include "lfdtools/basis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"

namespace lfd {

Basis make_basis(Eigen::Index bases, const CanonicalSystem& canonical) {
  check(canonical);
  if (bases < 2) throw DataError("dmp.basis", fmt::format("{} basis functions, but at least 2 are needed", bases));
  const Eigen::Index N = bases;
  Basis basis{Vector(N), Vector(N)};
  for (Eigen::Index i = 0; i < N; ++i) {
    basis.centers[i] = canonical.phase(static_cast<double>(i) / static_cast<double>(N - 1));
  }
  for (Eigen::Index i = 0; i + 1 < N; ++i) basis.widths[i] = 0.8 * (basis.centers[i] - basis.centers[i + 1]);
  basis.widths[N - 1] = basis.widths[N - 2];
  if (!(basis.widths.minCoeff() > 0)) {
    throw DataError("dmp.basis", fmt::format("{} basis functions with alpha_x {} have centres that coincide", bases,
                                             canonical.alpha_x));
  }
  return basis;
}

void check(const Basis& basis) {
  const auto& [c, sigma] = basis;
  if (c.size() != sigma.size() || c.size() == 0) {
    throw DataError("dmp.basis", fmt::format("{} centres but {} widths", c.size(), sigma.size()));
  }
  if (!c.allFinite() || !sigma.allFinite() || !(sigma.minCoeff() > 0)) {
    throw DataError("dmp.basis", "a centre is not a finite number or a width is not a positive one");
  }
}

Vector activations(const Basis& basis, double x) {
  const auto& [c, sigma] = basis;
  Vector psi(c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const double u = (x - c[i]) / sigma[i];
    psi[i] = std::exp(-0.5 * u * u);
  }
  return psi;
}

Vector normalized_activations(const Basis& basis, double x) {
  const auto& [c, sigma] = basis;
  Vector psi(c.size());
  // Exponents relative to the largest: the quotient is the same, and its denominator is never under 1.
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const double u = (x - c[i]) / sigma[i];
    psi[i] = -0.5 * u * u;
  }
  const double largest = psi.maxCoeff();
  double sum = 0;
  for (Eigen::Index i = 0; i < c.size(); ++i) sum += psi[i] = std::exp(psi[i] - largest);
  psi /= sum;
  return psi;
}

Matrix forcing_features(const Basis& basis, const Vector& x) {
  Matrix Phi(x.size(), basis.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) Phi.row(k) = x[k] * normalized_activations(basis, x[k]).transpose();
  return Phi;
}

double time_resolution(const Basis& basis, const CanonicalSystem& canonical) {
  // Between two centres a gap apart the exponents differ by gap (x - x_mid) / sigma^2: the change takes sigma^2 / gap
  // of phase where functions are narrow, sigma where they overlap. Phase turns into time by |dx/ds| = alpha_x x.
  const auto& [c, sigma] = basis;
  double shortest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    double gap = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < c.size(); ++j) {
      if (j != i) gap = std::min(gap, std::abs(c[i] - c[j]));
    }
    const double change = std::isfinite(gap) && gap > 0 ? std::min(sigma[i], sigma[i] * sigma[i] / gap) : sigma[i];
    const double x = std::clamp(c[i], 1e-300, 1.0);
    shortest = std::min(shortest, change / (canonical.alpha_x * x));
  }
  return shortest;
}

}  // namespace lfd
