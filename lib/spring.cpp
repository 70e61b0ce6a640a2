#include "lfdtools/spring.hpp"

#include <fmt/format.h>

#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd {

// With a = alpha_z / 2 and D = a^2 - alpha_z beta_z the roots are -a +- sqrt(D), and
//     e(s)  = exp(-a s) (C e0 + S (e0' + a e0)),   C = cosh(sqrt(D) s),  S = sinh(sqrt(D) s) / sqrt(D)
//     e'(s) = exp(-a s) (C e0' - S (a e0' + alpha_z beta_z e0)).
// C and S are even in sqrt(D), hence analytic in D: cosine and sine for D < 0, and 1 and s at D = 0. Each branch is
// computed without a difference of nearly equal numbers, so that the three meet to rounding.
SpringStep Spring::step(double s) const {
  const double a = alpha_z / 2;
  const double k = alpha_z * beta_z;
  const double D = a * a - k;
  const double r = std::sqrt(std::abs(D));
  double C = 0;
  double S = 0;
  if (D < 0) {
    const double decay = std::exp(-a * s);
    C = decay * std::cos(r * s);
    S = decay * (r * s < 1e-9 ? s : std::sin(r * s) / r);
  } else {
    // Factor exp((-a + r) s) out, with -a + r = -k / (a + r): cosh alone would overflow.
    const double slow = std::exp(-k / (a + r) * s);
    C = slow * 0.5 * (1 + std::exp(-2 * r * s));
    S = slow * (r * s < 1e-9 ? s : -std::expm1(-2 * r * s) / (2 * r));
  }
  return {C + a * S, S, -k * S, C - a * S};
}

double Spring::slow_rate() const {
  const double a = alpha_z / 2;
  const double k = alpha_z * beta_z;
  const double D = a * a - k;
  return D > 0 ? k / (a + std::sqrt(D)) : a;
}

double Spring::fast_rate() const {
  const double a = alpha_z / 2;
  const double k = alpha_z * beta_z;
  const double D = a * a - k;
  return D > 0 ? a + std::sqrt(D) : std::sqrt(k);
}

void check(const Spring& spring) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  if (!positive(spring.alpha_z) || !positive(spring.beta_z)) {
    throw DataError("dmp.spring",
                    fmt::format("alpha_z {} and beta_z {} must be positive numbers", spring.alpha_z, spring.beta_z));
  }
}

}  // namespace lfd
