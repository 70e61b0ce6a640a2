// The canonical system: the phase x that replaces time in a movement primitive.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

/// tau x' = -alpha_x x with x(0) = 1, paper eq. (8), solved in closed form: x(t) = exp(-alpha_x t / tau).
struct CanonicalSystem {
  /// ln 100: the phase has fallen to 0.01 at t = tau.
  static constexpr double default_alpha_x = 4.605170185988091368;

  double alpha_x = default_alpha_x;  ///< decay of the phase [1], positive

  /// Phase at relative time s = t / tau [1], in (0, 1] for s >= 0.
  [[nodiscard]] double phase(double s) const;
  /// Phase at times t [s] of a motion of duration tau [s], same length as t.
  [[nodiscard]] Vector phase(const Vector& t, double tau) const;
  /// Relative time s = t / tau at which the phase is x; the inverse of phase(s). @param x  positive
  [[nodiscard]] double relative_time(double x) const;
};

/// @throws DataError [dmp.alpha_x] unless alpha_x is finite and positive
void check(const CanonicalSystem& canonical);

}  // namespace lfd
