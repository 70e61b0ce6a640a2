#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/plot/silhouette.hpp"

using namespace lfd;
using namespace lfd::plot;

namespace {

constexpr PlaneView xy{0, 1};
constexpr PlaneView yz{1, 2};

Solid solid(SolidShape shape, const Vector3& position) {
  Solid solid;
  solid.shape = shape;
  solid.pose.position = position;
  return solid;
}

double area(const std::vector<Point>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return twice / 2;  // positive: counter-clockwise
}

}  // namespace

TEST_CASE("The hull of points has their corners, counter-clockwise, without those inside or on an edge") {
  const auto hull = convex_hull({{1, 1}, {0, 0}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {0.5, 0.7}, {0, 0}});
  CHECK(hull.size() == 4);
  CHECK(area(hull) == Approx(4));
}

TEST_CASE("The hull of points on a line is its two ends, of one point nothing with an area") {
  CHECK(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size() == 2);
  CHECK(area(convex_hull({{3, 3}, {3, 3}})) == 0);
  CHECK(convex_hull({}).empty());
}

TEST_CASE("A box along the axes is a rectangle in every plane") {
  Solid box = solid(SolidShape::box, {1, 2, 3});
  box.size << 0.2, 0.4, 0.6;
  CHECK(silhouette(box, xy).size() == 4);
  CHECK(area(silhouette(box, xy)) == Approx(0.08));
  CHECK(area(silhouette(box, yz)) == Approx(0.24));
}

TEST_CASE("A turned box is the hull of its corners") {
  Solid box = solid(SolidShape::box, {0, 0, 0});
  box.size << 1, 1, 1;
  box.pose.rotation = rotation_about_z(std::numbers::pi / 4);
  CHECK(area(silhouette(box, xy)) == Approx(1));
  CHECK(area(silhouette(box, yz)) == Approx(std::numbers::sqrt2));
  // A cube seen along its diagonal is a regular hexagon of area sqrt(3).
  box.pose.rotation = rotation_from_vector(Vector3(1, -1, 0).normalized() * std::acos(1 / std::sqrt(3.0)));
  CHECK(silhouette(box, xy).size() == 6);
  CHECK(area(silhouette(box, xy)) == Approx(std::sqrt(3.0)));
}

TEST_CASE("Round solids: disc, stadium, rectangle") {
  Solid sphere = solid(SolidShape::sphere, {0.1, 0.2, 0.3});
  sphere.radius = 0.5;
  const double disc = std::numbers::pi * 0.25;
  CHECK(area(silhouette(sphere, xy)) == Approx(disc).epsilon(0.002));
  Solid capsule = solid(SolidShape::capsule, {0, 0, 0});
  capsule.radius = 0.5;
  capsule.length = 2;
  CHECK(area(silhouette(capsule, xy)) == Approx(disc).epsilon(0.002));
  CHECK(area(silhouette(capsule, yz)) == Approx(disc + 2).epsilon(0.002));
  Solid cylinder = capsule;
  cylinder.shape = SolidShape::cylinder;
  CHECK(area(silhouette(cylinder, xy)) == Approx(disc).epsilon(0.002));
  CHECK(area(silhouette(cylinder, yz)) == Approx(2));
}

TEST_CASE("A plane is its blocked half where it is seen edge-on, and nothing elsewhere") {
  const Solid floor = solid(SolidShape::plane, {0, 0, 0.1});
  CHECK(silhouette(floor, xy).empty());
  const auto below = silhouette(floor, yz, 10);
  CHECK(area(below) == Approx(200));
  for (const Point& point : below) CHECK(point.y <= 0.1 + 1e-12);
}
