#include <cmath>
#include <numbers>

#include "axis_distance.hpp"

namespace lfd {
namespace {

Vector3 excess(const Vector3& p, double R, double H) {
  const double rho = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  const double out = rho > R ? (rho - R) / rho : 0.0;
  return {out * p[0], out * p[1], beyond(p[2], H)};
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
    if (rho > touching_distance) {
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

}  // namespace

Separation axis_to_cylinder(const Vector3& from, const Vector3& along, double R, double H) {
  const auto half_slope = [&](double t) { return excess(Vector3(from + t * along), R, H).dot(along); };
  const double a = along.head<2>().squaredNorm();
  const double b = from.head<2>().dot(along.head<2>());
  const double root = std::sqrt(std::max(0.0, b * b - a * (from.head<2>().squaredNorm() - R * R)));
  const std::array<double, 4> breaks = {(-H - from[2]) / along[2], (H - from[2]) / along[2], (-b - root) / a,
                                        (-b + root) / a};
  const Bracket bracket = bracket_minimum(half_slope, breaks);
  // Where the axis goes in stands among the breaks.
  if (excess(Vector3(from + bracket.high * along), R, H).norm() < touching_distance) {
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
  if (result.distance < touching_distance) return depth_in_cylinder(from, along, R, H);
  result.normal = away / result.distance;
  return result;
}

}  // namespace lfd
