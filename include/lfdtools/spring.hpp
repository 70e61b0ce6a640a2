// The spring and damper under a movement primitive, without its forcing term, in closed form.
#pragma once

namespace lfd {

/// Exact step of e'' + alpha_z e' + alpha_z beta_z e = 0 in relative time s = t / tau, with e = y - g the deviation
/// from the goal: paper eq. (10) and (11) without f, and e' = de/ds = z.
///     e(s)  = ee e(0) + ev e'(0)
///     e'(s) = ve e(0) + vv e'(0)
/// (ev, vv) is at the same time the response (e, e') to a unit impulse of f.
struct SpringStep {
  double ee = 1;
  double ev = 0;
  double ve = 0;
  double vv = 1;
};

/// tau z' = alpha_z (beta_z (g - y) - z), tau y' = z.
struct Spring {
  double alpha_z = 25;          ///< damping [1], positive
  double beta_z = alpha_z / 4;  ///< stiffness over damping [1], positive; alpha_z / 4 is critical damping

  /// The step over relative time s >= 0 [1]: one closed form for every damping, continuous at the critical one.
  [[nodiscard]] SpringStep step(double s) const;
  /// Real part of the slower root, negated [1]: free deviations vanish like exp(-rate s).
  [[nodiscard]] double slow_rate() const;
  /// Largest modulus of the two roots [1].
  [[nodiscard]] double fast_rate() const;
};

/// @throws DataError [dmp.spring] unless alpha_z and beta_z are finite and positive
void check(const Spring& spring);

}  // namespace lfd
