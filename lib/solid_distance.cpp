#include "lfdtools/solid_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lfd {
namespace {

// Under this the direction between two points is rounding: the bodies count as touching [m].
constexpr double touching = 1e-13;
// A cross product with an edge shorter than this spans no face that could matter [m].
constexpr double no_face = 1e-12;

double share(double value) {
  return std::clamp(value, 0.0, 1.0);
}

/// Parameter of the point of from + t along, 0 <= t <= 1, that is nearest to the origin.
template <typename VectorN>
double nearest_to_origin(const VectorN& from, const VectorN& along) {
  const double square = along.squaredNorm();
  return square > 0 ? share(-from.dot(along) / square) : 0.0;
}

Vector3 any_normal_to(const Vector3& along) {
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

// Box, in its own frame: half edges h, axis from + t along.

double excess(double x, double h) {
  return x > h ? x - h : x < -h ? x + h : 0.0;
}

Vector3 excess(const Vector3& p, const Vector3& h) {
  return {excess(p[0], h[0]), excess(p[1], h[1]), excess(p[2], h[2])};
}

/// The axis touches the box. The Minkowski sum of box and axis is a zonotope with the face normals e_i and e_i x along;
/// its least depth at the origin is the largest separation along them.
Separation depth_in_box(const Vector3& from, const Vector3& along, const Vector3& h) {
  const Vector3 middle = from + 0.5 * along;
  Separation best;
  best.distance = -std::numeric_limits<double>::infinity();
  int edge = -1;  // box edge whose cross product won; -1: a face of the box
  for (int i = 0; i < 3; ++i) {
    const double s = std::abs(middle[i]) - 0.5 * std::abs(along[i]) - h[i];
    if (s > best.distance) {
      best.distance = s;
      best.normal = std::copysign(1.0, middle[i]) * Vector3::Unit(i);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const Vector3 cross = Vector3::Unit(i).cross(along);
    const double norm = cross.norm();
    if (norm < no_face) continue;
    const Vector3 n = cross / norm;
    const double s = std::abs(n.dot(middle)) - n.cwiseAbs().dot(h);
    // A tie goes to the face, whose deepest point is plain.
    if (s > best.distance + touching) {
      best.distance = s;
      best.normal = std::copysign(1.0, n.dot(middle)) * n;
      edge = i;
    }
  }
  double t = best.normal.dot(along) < 0 ? 1.0 : 0.0;
  if (edge < 0 && std::abs(best.normal.dot(along)) < touching) t = nearest_to_origin(from, along);
  if (edge >= 0) {
    // Across an edge the axis touches where it passes that edge: both seen along the edge.
    Vector3 corner = h.cwiseProduct(best.normal.cwiseSign()) - from, flat = along;
    corner[edge] = flat[edge] = 0;
    t = share(corner.dot(flat) / flat.squaredNorm());
  }
  best.point = from + t * along;
  return best;
}

Separation axis_to_box(const Vector3& from, const Vector3& along, const Vector3& h) {
  const auto half_slope = [&](double t) { return excess(Vector3(from + t * along), h).dot(along); };
  std::array<double, 6> breaks;
  for (int i = 0; i < 3; ++i) {
    // Along an edge there is no break: the division gives an infinity or NaN, which no bracket contains.
    breaks[static_cast<std::size_t>(2 * i)] = (-h[i] - from[i]) / along[i];
    breaks[static_cast<std::size_t>(2 * i + 1)] = (h[i] - from[i]) / along[i];
  }
  const Bracket b = bracket_minimum(half_slope, breaks);
  // Inside one piece the squared distance is a parabola, its slope a straight line.
  double t = b.low;
  if (b.high > b.low && b.slope_high > b.slope_low) {
    t += (b.high - b.low) * (-b.slope_low / (b.slope_high - b.slope_low));
  }
  Separation result;
  result.point = from + t * along;
  const Vector3 away = excess(result.point, h);
  result.distance = away.norm();
  if (result.distance < touching) return depth_in_box(from, along, h);
  result.normal = away / result.distance;
  return result;
}

// Cylinder, in its own frame: radius R, half length H.

Vector3 excess(const Vector3& p, double R, double H) {
  const double rho = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  const double out = rho > R ? (rho - R) / rho : 0.0;
  return {out * p[0], out * p[1], excess(p[2], H)};
}

/// Largest x cos(a) + y sin(a) - R sqrt(cos(a)^2 + c^2 sin(a)^2) over 0 < a < pi/2: how far the point (x, y), x >= 0,
/// is beyond the tangents to the first quarter of an ellipse with the half axes R and R c. There is at most one maximum
/// between the ends for a point in that quarter or under it; the ends belong to side and cap.
/// @return the angle, or 0 if there is no maximum between the ends
double steepest_rim_angle(double x, double y, double R, double c) {
  const auto slope = [&](double a) {
    const double cosine = std::cos(a), sine = std::sin(a);
    return y * cosine - x * sine + R * (1 - c * c) * sine * cosine / std::hypot(cosine, c * sine);
  };
  constexpr int pieces = 32;
  constexpr double quarter = std::numbers::pi / 2;
  for (int i = pieces; i > 0; --i) {
    double low = quarter * (i - 1) / pieces, high = quarter * i / pieces;
    if (!(slope(low) > 0 && slope(high) <= 0)) continue;
    for (int k = 0; k < 60 && high - low > 1e-15; ++k) {
      const double middle = 0.5 * (low + high);
      (slope(middle) > 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return 0.0;
}

/// The axis touches the cylinder: the least depth in the Minkowski sum of both, whose surface consists of the caps, the
/// side (of the cylinder, moved along the axis), and the rims drawn along the axis. Every direction gives a lower bound
/// of the signed distance, so the largest of the three is it.
Separation depth_in_cylinder(const Vector3& from, const Vector3& along, double R, double H) {
  const Vector3 to = from + along;
  Separation best;
  const bool upwards = from[2] + to[2] >= 0;
  best.normal = upwards ? Vector3(Vector3::UnitZ()) : Vector3(-Vector3::UnitZ());
  best.point = (from[2] < to[2]) == upwards ? from : to;
  best.distance = best.normal.dot(best.point) - H;

  const Eigen::Vector2d from_xy = from.head<2>(), along_xy = along.head<2>();
  const double t = nearest_to_origin(from_xy, along_xy);
  const Eigen::Vector2d near_xy = from_xy + t * along_xy;
  const double rho = near_xy.norm();
  if (rho - R > best.distance) {
    best.distance = rho - R;
    best.point = from + t * along;
    best.normal = Vector3::UnitX();
    if (rho > touching) {
      best.normal << near_xy / rho, 0.0;
    } else if (along_xy.norm() > no_face) {
      best.normal << Eigen::Vector2d(-along[1], along[0]).normalized(), 0.0;
    }
  }

  const double length = along.norm(), flat = along_xy.norm();
  if (flat < no_face) return best;
  // Seen along the axis the cylinder is the hull of two ellipses with half axes R (across, u) and R c (v).
  const Vector3 u(-along[1] / flat, along[0] / flat, 0.0);
  const Vector3 v = (along / length).cross(u);
  const double c = std::abs(along[2]) / length, s = flat / length;
  const double x = u.dot(from), y = v.dot(from);
  const double angle = steepest_rim_angle(std::abs(x), std::abs(y) - H * s, R, c);
  if (angle <= 0) return best;
  const Vector3 n = std::copysign(std::cos(angle), x) * u + std::copysign(std::sin(angle), y) * v;
  const double n_flat = n.head<2>().norm();
  const double distance = n.dot(from) - R * n_flat - H * std::abs(n[2]);
  if (distance > best.distance) {
    best.distance = distance;
    best.normal = n;
    Vector3 rim(0.0, 0.0, std::copysign(H, n[2]));
    if (n_flat > 0) rim.head<2>() = R / n_flat * n.head<2>();
    best.point = from + share((rim - from).dot(along) / along.squaredNorm()) * along;
  }
  return best;
}

Separation axis_to_cylinder(const Vector3& from, const Vector3& along, double R, double H) {
  const auto half_slope = [&](double t) { return excess(Vector3(from + t * along), R, H).dot(along); };
  const double a = along.head<2>().squaredNorm();
  const double b = from.head<2>().dot(along.head<2>());
  const double root = std::sqrt(std::max(0.0, b * b - a * (from.head<2>().squaredNorm() - R * R)));
  const std::array<double, 4> breaks = {(-H - from[2]) / along[2], (H - from[2]) / along[2], (-b - root) / a,
                                        (-b + root) / a};
  const Bracket bracket = bracket_minimum(half_slope, breaks);
  // Where the axis goes in stands among the breaks.
  if (excess(Vector3(from + bracket.high * along), R, H).norm() < touching) {
    return depth_in_cylinder(from, along, R, H);
  }
  double low = bracket.low, high = bracket.high, t = 0.5 * (low + high);
  // Newton's steps on the rising slope, halving where one would leave the bracket. The distance is flat at its minimum:
  // 1e-9 of the axis is far under 1e-12 m.
  for (int k = 0; k < 60 && high - low > 1e-9; ++k) {
    const Vector3 p = from + t * along;
    const Vector3 away = excess(p, R, H);
    const double slope = away.dot(along);
    (slope < 0 ? low : high) = t;
    const double rho = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    double curvature = away[2] != 0 ? along[2] * along[2] : 0.0;
    if (rho > R) {
      const double radial = p.head<2>().dot(along.head<2>()) / rho;
      curvature += a * (1 - R / rho) + R / rho * radial * radial;
    }
    const double next = t - slope / curvature;
    if (std::abs(next - t) < 1e-12) break;
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  Separation result;
  result.point = from + t * along;
  const Vector3 away = excess(result.point, R, H);
  result.distance = away.norm();
  if (result.distance < touching) return depth_in_cylinder(from, along, R, H);
  result.normal = away / result.distance;
  return result;
}

Separation axis_to_point(const Segment& axis, const Vector3& centre) {
  const Vector3 along = axis.to - axis.from;
  const Vector3 from = axis.from - centre;
  Separation result;
  const double t = nearest_to_origin(from, along);
  result.point = axis.from + t * along;
  const Vector3 away = from + t * along;
  result.distance = away.norm();
  result.normal = result.distance < touching ? any_normal_to(along) : Vector3(away / result.distance);
  return result;
}

Separation axis_to_axis(const Segment& a, const Segment& b) {
  const Vector3 u = a.to - a.from, v = b.to - b.from, between = b.from - a.from;
  const Vector3 across = u.cross(v);
  const double square = across.squaredNorm();
  // Where the two lines are nearest; the cross product keeps its digits where they are nearly parallel.
  double s = square > 0 ? share(between.cross(v).dot(across) / square) : 0.0;
  const double t = nearest_to_origin(Vector3(between - s * u), v);
  const Vector3 on_b = b.from + t * v;
  s = nearest_to_origin(Vector3(a.from - on_b), u);
  Separation result;
  result.point = a.from + s * u;
  const Vector3 away = result.point - on_b;
  result.distance = away.norm();
  if (result.distance >= touching) {
    result.normal = away / result.distance;
  } else {
    result.normal = square > 0 ? Vector3(across.normalized()) : any_normal_to(u.squaredNorm() > 0 ? u : v);
  }
  return result;
}

}  // namespace

Separation separation(const Segment& axis, double radius, const Solid& solid) {
  Separation result;
  const Matrix3& R = solid.pose.rotation;
  switch (solid.shape) {
    case SolidShape::box:
    case SolidShape::cylinder: {
      const Vector3 from = R.transpose() * (axis.from - solid.pose.position);
      const Vector3 along = R.transpose() * (axis.to - axis.from);
      result = solid.shape == SolidShape::box ? axis_to_box(from, along, 0.5 * solid.size)
                                              : axis_to_cylinder(from, along, solid.radius, 0.5 * solid.length);
      result.point = R * result.point + solid.pose.position;
      result.normal = R * result.normal;
      break;
    }
    case SolidShape::sphere:
      result = axis_to_point(axis, solid.pose.position);
      result.distance -= solid.radius;
      break;
    case SolidShape::capsule: {
      const Vector3 half = 0.5 * solid.length * R.col(2);
      result = axis_to_axis(axis, {solid.pose.position - half, solid.pose.position + half});
      result.distance -= solid.radius;
      break;
    }
    case SolidShape::plane: {
      const Vector3 up = R.col(2);
      const double from = up.dot(axis.from - solid.pose.position), to = up.dot(axis.to - solid.pose.position);
      result = {std::min(from, to), from <= to ? axis.from : axis.to, up};
      break;
    }
  }
  result.distance -= radius;
  return result;
}

Separation separation(const Segment& a, double radius_a, const Segment& b, double radius_b) {
  Separation result = axis_to_axis(a, b);
  result.distance -= radius_a + radius_b;
  return result;
}

}  // namespace lfd
