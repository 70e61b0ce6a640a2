// By how much a motion passes its limits: the stretch of time that they ask for. For retime.cpp alone.
#pragma once

#include "lfdtools/interpolation.hpp"
#include "lfdtools/retime.hpp"

namespace lfd::retiming {

/// The limits of a motion. A motion whose times are stretched by a factor has speeds less by that factor and
/// accelerations less by its square, so the excess is a share of a limit of speed or the root of one of acceleration.
class Limits {
 public:
  /// @param options  kept as a reference, as the robot is
  Limits(const Robot& robot, const RetimeOptions& options) : robot_(robot), options_(options) {}

  /// Largest share of a limit of speed, that of the tip among them.
  [[nodiscard]] double speed_share(const Joints& position, const Joints& velocity) const;
  /// Largest share of a limit of acceleration.
  [[nodiscard]] double acceleration_share(const Joints& acceleration) const;

  /// Of a spline through rows, for each of them, the excess there and on the way from the row before; up to 1 the
  /// limits are kept. The tip is looked at in quarters of that way.
  /// @param times  of the rows [s]
  [[nodiscard]] Vector excess_of(const CubicSpline& spline, const Vector& times) const;

 private:
  [[nodiscard]] double tip_share(const Joints& position, const Joints& velocity) const;

  const Robot& robot_;
  const RetimeOptions& options_;
};

/// The largest amounts that parabolas reach between their values at 0, 1/2 and 1.
[[nodiscard]] Joints largest_between(const Joints& begin, const Joints& middle, const Joints& end);

}  // namespace lfd::retiming
