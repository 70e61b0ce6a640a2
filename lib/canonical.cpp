#include "lfdtools/canonical.hpp"

#include <fmt/format.h>

#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd {

double CanonicalSystem::phase(double s) const {
  return std::exp(-alpha_x * s);
}

Vector CanonicalSystem::phase(const Vector& t, double tau) const {
  Vector x(t.size());
  for (Eigen::Index k = 0; k < t.size(); ++k) x[k] = phase(t[k] / tau);
  return x;
}

double CanonicalSystem::relative_time(double x) const {
  return -std::log(x) / alpha_x;
}

void check(const CanonicalSystem& canonical) {
  if (!(canonical.alpha_x > 0) || !std::isfinite(canonical.alpha_x)) {
    throw DataError("dmp.alpha_x", fmt::format("alpha_x is {}, not a positive number", canonical.alpha_x));
  }
}

}  // namespace lfd
