#include "lfdtools/plot/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lfd::plot {
namespace {

constexpr int round_corners = 96;
constexpr double edge_on = 0.017;  // sine of a degree

double turn(const Point& o, const Point& a, const Point& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

Point seen(const Vector3& place, PlaneView view) {
  return {place[view.across], place[view.up]};
}

void add_disc(std::vector<Point>& points, Point middle, double radius) {
  for (int k = 0; k < round_corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / round_corners;
    points.push_back({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
  }
}

/// The rim of a flat end: a circle in space about the z axis of the pose.
void add_rim(std::vector<Point>& points, const Solid& solid, double z, PlaneView view) {
  for (int k = 0; k < round_corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / round_corners;
    const Vector3 place(solid.radius * std::cos(angle), solid.radius * std::sin(angle), z);
    points.push_back(seen(solid.pose.rotation * place + solid.pose.position, view));
  }
}

std::vector<Point> half_plane(const Solid& solid, PlaneView view, double extent) {
  const Vector3 normal = solid.pose.rotation.col(2);
  const Point n = seen(normal, view);
  const double length = std::hypot(n.x, n.y);
  if (length < std::cos(std::asin(edge_on))) return {};
  const Point middle = seen(solid.pose.position, view);
  const Point along{-n.y / length * extent, n.x / length * extent};
  const Point into{-n.x / length * extent, -n.y / length * extent};
  return {{middle.x - along.x, middle.y - along.y},
          {middle.x + along.x, middle.y + along.y},
          {middle.x + along.x + into.x, middle.y + along.y + into.y},
          {middle.x - along.x + into.x, middle.y - along.y + into.y}};
}

}  // namespace

std::vector<Point> convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Point> hull;
  // Lower chain from left to right, then the upper one back.
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();  // the other chain begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<Point> silhouette(const Solid& solid, PlaneView view, double extent) {
  std::vector<Point> points;
  const Vector3 half_axis = solid.pose.rotation.col(2) * (solid.length / 2);
  switch (solid.shape) {
    case SolidShape::box:
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                           (corner & 4) != 0 ? 0.5 : -0.5);
        points.push_back(seen(solid.pose.rotation * solid.size.cwiseProduct(sign) + solid.pose.position, view));
      }
      break;
    case SolidShape::sphere:
      add_disc(points, seen(solid.pose.position, view), solid.radius);
      break;
    case SolidShape::cylinder:
      add_rim(points, solid, -solid.length / 2, view);
      add_rim(points, solid, solid.length / 2, view);
      break;
    case SolidShape::capsule:
      add_disc(points, seen(solid.pose.position - half_axis, view), solid.radius);
      add_disc(points, seen(solid.pose.position + half_axis, view), solid.radius);
      break;
    case SolidShape::plane:
      return half_plane(solid, view, extent);
  }
  return convex_hull(std::move(points));
}

}  // namespace lfd::plot
