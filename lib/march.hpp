// The integrator under every motion of a primitive; inside the library.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "lfdtools/dmp.hpp"
#include "lfdtools/error.hpp"

namespace lfd {

// Gauss-Legendre with six nodes, exact for polynomials of degree 11, on [0, 1].
inline constexpr int nodes = 6;
inline constexpr std::array<double, nodes> node_at = {0.033765242898423975, 0.169395306766867743, 0.380690406958401545,
                                                      0.619309593041598455, 0.830604693233132257, 0.966234757101576025};
inline constexpr std::array<double, nodes> node_weight = {0.085662246189585173, 0.180380786524069303,
                                                          0.233956967286345524, 0.233956967286345524,
                                                          0.180380786524069303, 0.085662246189585173};

// @throws DataError [dmp.times] unless the times are finite, not negative and do not fall
inline void check_times(const Vector& times) {
  if (!times.allFinite()) throw DataError("dmp.times", "a time is not a finite number");
  double last = 0;
  for (const double t : times) {
    if (t < last) throw DataError("dmp.times", fmt::format("time {} s comes after {} s", t, last));
    last = t;
  }
}

// Below this phase the forcing term is far under the rounding of any position, and the spring alone goes on.
inline constexpr double quiet_phase = 1e-30;

// Equal steps a unit of relative time, so that s = 1 lies on the grid. Six nodes a step leave an error of rounding for
// steps of the lengths below (dmp_test.cpp). Settings from elsewhere with needle-like functions stop at 10^5 steps.
inline Eigen::Index steps_per_unit(const DmpSettings& settings) {
  const double resolution = time_resolution(settings.basis(), settings.canonical());
  const double h = std::min({resolution / 2, 1 / settings.alpha_x, 1 / settings.spring().fast_rate()});
  return static_cast<Eigen::Index>(std::ceil(1 / std::clamp(h, 1e-5, 1.0)));
}

// Marches M systems e'' + alpha_z e' + alpha_z beta_z e = f_m(s, x(s)) through relative time. State and forcing are
// vectors of length M; forcing(s, x) returns the M forces at relative time s, where the phase is x. The forcing is
// smooth but for the knots, at which steps end.
template <typename Forcing>
class March {
 public:
  March(const DmpSettings& settings, Forcing forcing, Vector deviation, Vector rate = {},
        std::vector<double> knots = {})
      : spring_(settings.spring()),
        canonical_(settings.canonical()),
        forcing_(std::move(forcing)),
        steps_(steps_per_unit(settings)),
        knots_(std::move(knots)),
        quiet_(canonical_.relative_time(quiet_phase)),
        e_(std::move(deviation)),
        v_(rate.size() > 0 ? std::move(rate) : Vector(Vector::Zero(e_.size()))) {
    std::sort(knots_.begin(), knots_.end());
    if (!knots_.empty()) quiet_ = std::max(quiet_, knots_.back());
  }

  // Moves on to relative time s, not before that of the last call.
  void to(double s) {
    while (next() <= std::min(s, quiet_)) advance();
    e = e_;
    v = v_;
    step(e, v, at_, std::min(s, std::max(quiet_, at_)) - at_);
    if (s > std::max(quiet_, at_)) apply(spring_.step(s - std::max(quiet_, at_)), e, v);
    f = forcing_(s, canonical_.phase(s));
  }

  // e'' from the differential equation itself.
  [[nodiscard]] Vector acceleration() const { return f - spring_.alpha_z * v - (spring_.alpha_z * spring_.beta_z) * e; }

  Vector e;  // deviation at s
  Vector v;  // e' at s
  Vector f;  // forcing term at s

 private:
  [[nodiscard]] double grid_time(Eigen::Index k) const { return static_cast<double>(k) / static_cast<double>(steps_); }
  [[nodiscard]] bool knot_ahead() const { return knot_ < knots_.size() && knots_[knot_] < grid_time(k_ + 1); }
  [[nodiscard]] double next() const { return knot_ahead() ? knots_[knot_] : grid_time(k_ + 1); }

  void advance() {
    const double end = next();
    // The same step length all along where there are no knots.
    const double h = knot_ahead() || at_ != grid_time(k_) ? end - at_ : 1 / static_cast<double>(steps_);
    step(e_, v_, at_, h);
    knot_ahead() ? static_cast<void>(++knot_) : static_cast<void>(++k_);
    at_ = end;
  }

  static void apply(const SpringStep& A, Vector& a, Vector& b) {
    const Vector was = a;
    a = A.ee * was + A.ev * b;
    b = A.ve * was + A.vv * b;
  }

  // Variation of constants over [s, s + h]: the state moves on freely, and each force adds its response to an impulse.
  void step(Vector& a, Vector& b, double s, double h) const {
    if (!(h > 0)) return;
    apply(spring_.step(h), a, b);
    for (std::size_t j = 0; j < nodes; ++j) {
      const SpringStep impulse = spring_.step(h * (1 - node_at[j]));
      const double at = s + h * node_at[j];
      const Vector force = forcing_(at, canonical_.phase(at));
      a += (h * node_weight[j] * impulse.ev) * force;
      b += (h * node_weight[j] * impulse.vv) * force;
    }
  }

  Spring spring_;
  CanonicalSystem canonical_;
  Forcing forcing_;
  Eigen::Index steps_;
  std::vector<double> knots_;  // rising
  double quiet_;
  Eigen::Index k_ = 0;    // grid times passed
  std::size_t knot_ = 0;  // knots passed
  double at_ = 0;         // where e_ and v_ stand
  Vector e_;
  Vector v_;
};

}  // namespace lfd
