// Interpolation through samples: a C2 cubic spline for signals, monotone PCHIP for warps of time.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

/// What a cubic spline does at its ends: its third derivative is the same on both sides of the second and of the last
/// but one sample (a parabola for three samples, a line for two), or its first derivative is zero at both ends.
enum class SplineEnds { not_a_knot, at_rest };

/// Cubic spline through T samples of D signals.
class CubicSpline {
 public:
  /// @param times  T >= 2, strictly rising   @param values  T x D
  /// @throws DataError as check(Trajectory)
  CubicSpline(Vector times, Samples values, SplineEnds ends = SplineEnds::not_a_knot);

  /// Values at t, m x D. Outside the samples the end values hold.
  [[nodiscard]] Samples operator()(const Vector& t) const;
  /// First derivative at t, m x D; zero outside the samples.
  [[nodiscard]] Samples derivative(const Vector& t) const;
  /// Second derivatives at the samples themselves, T x D; between them they go linearly.
  [[nodiscard]] const Samples& second_derivatives() const { return second_; }

 private:
  Vector times_;
  Samples values_;
  Samples second_;  // second derivatives at the samples, T x D
};

/// Monotone piecewise cubic Hermite interpolation (Fritsch and Carlson 1980, with Fritsch and Butland's slopes): rising
/// data give a rising curve.
class Pchip {
 public:
  /// @param x  n >= 2, strictly rising   @param y  n
  Pchip(Vector x, Vector y);
  /// Values at x; outside the data the end values hold.
  [[nodiscard]] Vector operator()(const Vector& x) const;

 private:
  Vector x_;
  Vector y_;
  Vector slopes_;
};

}  // namespace lfd
