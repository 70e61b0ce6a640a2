// The course of a primitive: a motion that may begin at speed, and whose goal may change on the way.
#pragma once

#include "lfdtools/dmp.hpp"

namespace lfd {

/// From `time` on the goal is another one, with weights of its own.
struct GoalChange {
  double time = 0;  ///< [s], positive
  Vector goal;      ///< D [m]
  Matrix weights;   ///< D x N, as they stand in a primitive for this goal
};

/// A primitive, and what happens to it. Each change fades in over `blend` durations with
///     b(r) = r^3 (10 - 15 r + 6 r^2),  r = (t - time) / (blend tau) in [0, 1],
/// whose first and second derivatives vanish at both ends. With G_0 and W_0 those of the primitive and W_k = s_k w_k,
///     g(t) = G_0 + sum_k b_k(t) (G_k - G_(k-1)),   W(t) = W_0 + sum_k b_k(t) (W_k - W_(k-1)),
///     tau^2 y'' = alpha_z (beta_z (g(t) - y) - tau y') + W(t) psi(x) x / sum psi(x)
/// of paper eq. (10)-(12). So y'' is continuous, and once a change has faded in, the equation is that of the primitive
/// for its goal: the motion closes up with that one like exp(-alpha_z t / (2 tau)), or, where the change comes late,
/// goes on until it rests. Clock and duration stay those of the primitive.
struct Course {
  Dmp primitive;
  Vector start_velocity;            ///< y'(0), D [m/s]; empty: rest
  std::vector<GoalChange> changes;  ///< by time
  double blend = 0.2;               ///< share of tau

  /// No change and no speed: the motion of the primitive.
  [[nodiscard]] bool plain() const { return changes.empty() && start_velocity.size() == 0; }
  /// The last one.
  [[nodiscard]] const Vector& goal() const { return changes.empty() ? primitive.goal : changes.back().goal; }
};

/// @throws DataError as check(Dmp); [course.shape], [course.not_finite], [course.times] unless the times of the changes
///         are positive, rise, and lie under 100 tau
void check(const Course& course);

/// The motion at the given times, as rollout(Dmp) and to the same accuracy: steps end where a change begins and ends.
/// @param times  T, from 0, not falling [s]   @throws DataError as check(Course); [dmp.times]
[[nodiscard]] Motion rollout(const Course& course, const Vector& times);

/// As settle_time(Dmp); not before the last change has faded in.
/// @throws DataError as check(Course); [dmp.does_not_settle]
[[nodiscard]] double settle_time(const Course& course, const SettleOptions& options = {});

/// The motion on times 0, dt, 2 dt, ... tau and on until it rests on its last goal.
/// @param dt  [s]; tau / 200 if empty
/// @throws DataError [skill.dt] if that makes over 10^7 samples; those of settle_time
[[nodiscard]] Motion generate(const Course& course, std::optional<double> dt = {});

}  // namespace lfd
