// A capsule's axis against one solid, in the solid's own frame: from + t along, 0 <= t <= 1. For solid_distance.cpp
// alone.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "lfdtools/solid_distance.hpp"

namespace lfd {

/// @param h  half edges [m]
[[nodiscard]] Separation axis_to_box(const Vector3& from, const Vector3& along, const Vector3& h);

/// @param R  radius [m]   @param H  half length, along z [m]
[[nodiscard]] Separation axis_to_cylinder(const Vector3& from, const Vector3& along, double R, double H);

// What they share.

// Under this the direction between two points is rounding: the bodies count as touching [m].
inline constexpr double touching_distance = 1e-13;
// A cross product with an edge shorter than this spans no face that could matter [m].
inline constexpr double no_face = 1e-12;

inline double share(double value) {
  return std::clamp(value, 0.0, 1.0);
}

/// Parameter of the point of from + t along, 0 <= t <= 1, that is nearest to the origin.
template <typename VectorN>
double nearest_to_origin(const VectorN& from, const VectorN& along) {
  const double square = along.squaredNorm();
  return square > 0 ? share(-from.dot(along) / square) : 0.0;
}

inline Vector3 any_normal_to(const Vector3& along) {
  return along.squaredNorm() > 0 ? along.unitOrthogonal() : Vector3(Vector3::UnitZ());
}

/// Of a convex function on [0, 1] whose derivative `slope` is smooth between the given breaks: the bracket of its
/// minimum inside one smooth piece. Ends coincide where an end of [0, 1] is the minimum.
struct Bracket {
  double low = 0.0, high = 1.0;
  double slope_low = 0.0, slope_high = 0.0;
};

template <typename Slope, std::size_t N>
Bracket bracket_minimum(const Slope& slope, const std::array<double, N>& breaks) {
  Bracket b;
  b.slope_low = slope(0.0);
  if (b.slope_low >= 0) return {0.0, 0.0, b.slope_low, b.slope_low};
  b.slope_high = slope(1.0);
  if (b.slope_high <= 0) return {1.0, 1.0, b.slope_high, b.slope_high};
  for (const double t : breaks) {
    if (!(t > b.low && t < b.high)) continue;
    const double s = slope(t);
    if (s < 0) {
      b.low = t;
      b.slope_low = s;
    } else {
      b.high = t;
      b.slope_high = s;
    }
  }
  return b;
}

/// How far x is beyond -h and h.
inline double beyond(double x, double h) {
  return x > h ? x - h : x < -h ? x + h : 0.0;
}

}  // namespace lfd
