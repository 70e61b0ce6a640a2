#include <cmath>
#include <limits>

#include "axis_distance.hpp"

namespace lfd {
namespace {

Vector3 excess(const Vector3& p, const Vector3& h) {
  return {beyond(p[0], h[0]), beyond(p[1], h[1]), beyond(p[2], h[2])};
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
    if (s > best.distance + touching_distance) {
      best.distance = s;
      best.normal = std::copysign(1.0, n.dot(middle)) * n;
      edge = i;
    }
  }
  double t = best.normal.dot(along) < 0 ? 1.0 : 0.0;
  if (edge < 0 && std::abs(best.normal.dot(along)) < touching_distance) t = nearest_to_origin(from, along);
  if (edge >= 0) {
    // Across an edge the axis touches where it passes that edge: both seen along the edge.
    Vector3 corner = h.cwiseProduct(best.normal.cwiseSign()) - from, flat = along;
    corner[edge] = flat[edge] = 0;
    t = share(corner.dot(flat) / flat.squaredNorm());
  }
  best.point = from + t * along;
  return best;
}

}  // namespace

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
  if (result.distance < touching_distance) return depth_in_box(from, along, h);
  result.normal = away / result.distance;
  return result;
}

}  // namespace lfd
