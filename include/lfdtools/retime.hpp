// The fastest motion along a joint path that keeps limits of speed and acceleration, the path itself unchanged.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lfdtools/dh.hpp"

namespace lfd {

/// What the motion must keep.
struct RetimeOptions {
  /// Limits are within JointLimits::least_rate and most_rate, that of the tip as well.
  Joints velocity = Joints::Constant(1.0);      ///< [rad/s]
  Joints acceleration = Joints::Constant(1.0);  ///< [rad/s^2]
  std::optional<double> tip_speed;              ///< of the tool tip [m/s]
  Pose tool;                                    ///< pose of the tool tip in the flange frame
  /// Intervals of the grid on which the limits are imposed, at least; never fewer than four between two rows. They are
  /// checked on a grid ten times as fine.
  int grid = 2000;
  /// Keep the limits, that of the tip in quarters of the intervals, too, of the cubic splines through the rows over
  /// their new times, at rest at both ends and not a knot there, as a reader of the rows alone sees the motion, where
  /// there are 50 knots of the JointCurve or more (rows within 1e-4 rad of the one before are none): where an
  /// acceleration leaps they go over it, by a third at worst, so leaps are spread over some rows. Costs on average 2 %
  /// of the duration with 50 rows, 0.4 % with 200.
  bool of_rows = true;
};

/// The law of motion s(t) along a path q(s), the JointCurve through the rows: between grid points the second derivative
/// of s is constant.
class Retiming {
 public:
  /// Times of the rows, the first 0, strictly rising; the motion rests at both ends [s].
  [[nodiscard]] const Vector& times() const { return times_; }
  [[nodiscard]] double duration() const { return times_[times_.size() - 1]; }
  /// Factor by which all times were stretched because a limit was passed between grid points, or by the spline through
  /// the rows; 1: nowhere.
  [[nodiscard]] double stretch() const { return stretch_; }

  /// The motion at a time in [0, duration].
  struct State {
    Joints position;      ///< [rad]
    Joints velocity;      ///< [rad/s]
    Joints acceleration;  ///< [rad/s^2]
  };
  [[nodiscard]] State operator()(double t) const;

 private:
  friend Retiming retime(const Robot& robot, const Samples& joints, const RetimeOptions& options);
  class Solver;
  struct Knot {
    double s = 0.0;
    Joints value, second;  // of the spline
  };
  struct Point {
    double s = 0.0;
    double x = 0.0;  // (ds/dt)^2
    double t = 0.0;
    std::size_t knot = 0;  // of the spline's interval that begins here or before
  };
  [[nodiscard]] State at(const Point& begin, const Point& end, double along) const;

  std::vector<Knot> knots_;
  std::vector<Point> points_;
  Vector times_;
  double stretch_ = 1.0;
};

/// The smallest duration from rest to rest, by the method of Pham and Pham, "A new approach to time-optimal path
/// parameterization based on reachability analysis" (2018): from the end backwards the largest (ds/dt)^2 from which the
/// rest of the path can still be gone, then forwards as fast as these sets allow. The limits of both ends of a grid
/// interval hold for its one acceleration.
/// @param robot  for the speed of the tool tip   @param joints  T x 6, T >= 2 [rad]
/// @throws DataError [retime.shape], [retime.not_finite]; UsageError [retime.options]
[[nodiscard]] Retiming retime(const Robot& robot, const Samples& joints, const RetimeOptions& options);

}  // namespace lfd
