#include "lfdtools/solid_distance.hpp"

#include "axis_distance.hpp"

namespace lfd {
namespace {

Separation axis_to_point(const Segment& axis, const Vector3& centre) {
  const Vector3 along = axis.to - axis.from;
  const Vector3 from = axis.from - centre;
  Separation result;
  const double t = nearest_to_origin(from, along);
  result.point = axis.from + t * along;
  const Vector3 away = from + t * along;
  result.distance = away.norm();
  result.normal = result.distance < touching_distance ? any_normal_to(along) : Vector3(away / result.distance);
  return result;
}

Separation axis_to_axis(const Segment& a, const Segment& b) {
  const Vector3 u = a.to - a.from, v = b.to - b.from, between = b.from - a.from;
  const Vector3 across = u.cross(v);
  // Of lines that are parallel, but for rounding, the cross product is no direction.
  const bool parallel = across.squaredNorm() <= 1e-24 * u.squaredNorm() * v.squaredNorm();
  const double square = parallel ? 0.0 : across.squaredNorm();
  // Where the two lines are nearest; the cross product keeps its digits where they are nearly parallel.
  double s = square > 0 ? share(between.cross(v).dot(across) / square) : 0.0;
  const double t = nearest_to_origin(Vector3(between - s * u), v);
  const Vector3 on_b = b.from + t * v;
  s = nearest_to_origin(Vector3(a.from - on_b), u);
  Separation result;
  result.point = a.from + s * u;
  const Vector3 away = result.point - on_b;
  result.distance = away.norm();
  if (result.distance >= touching_distance) {
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
