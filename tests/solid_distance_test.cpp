#include "lfdtools/solid_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numbers>

#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

constexpr SolidShape shapes[] = {SolidShape::box, SolidShape::sphere, SolidShape::cylinder, SolidShape::capsule,
                                 SolidShape::plane};

Vector3 point_in(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

Solid solid_of(SolidShape shape, Random& random, bool turned = true) {
  Solid solid;
  solid.shape = shape;
  solid.size = {random.uniform(0.05, 0.6), random.uniform(0.05, 0.6), random.uniform(0.05, 0.6)};
  solid.radius = random.uniform(0.02, 0.3);
  solid.length = random.uniform(0.05, 0.6);
  if (turned) {
    solid.pose.position = point_in(random, 0.2);
    solid.pose.rotation = rotation_from_vector(point_in(random, 1.8));
  }
  return solid;
}

/// Segments of every kind: across, along an axis of the solid, in one plane with it, points.
Segment segment_for(const Solid& solid, Random& random, double reach = 0.6) {
  Segment axis{point_in(random, reach), point_in(random, reach)};
  const auto kind = random.below(8);
  if (kind == 0) axis.to = axis.from + solid.pose.rotation.col(2) * random.uniform(-0.5, 0.5);
  if (kind == 1) axis.to = axis.from + solid.pose.rotation.col(0) * random.uniform(-0.5, 0.5);
  if (kind == 2) axis.to = axis.from + solid.pose.rotation.col(1) * 0.3 + solid.pose.rotation.col(0) * 0.1;
  if (kind == 3) axis.to = axis.from;
  return axis;
}

/// Support function of a solid in its own frame: the farthest it reaches along n.
double reach_along(const Solid& solid, const Vector3& n) {
  switch (solid.shape) {
    case SolidShape::box:
      return 0.5 * n.cwiseAbs().dot(solid.size);
    case SolidShape::sphere:
      return solid.radius;
    case SolidShape::cylinder:
      return solid.radius * n.head<2>().norm() + 0.5 * solid.length * std::abs(n[2]);
    default:
      return solid.radius + 0.5 * solid.length * std::abs(n[2]);
  }
}

/// The point of a solid nearest to p.
Vector3 nearest_of(const Solid& solid, const Vector3& p) {
  Vector3 q = solid.pose.rotation.transpose() * (p - solid.pose.position);
  const double half = 0.5 * solid.length;
  if (solid.shape == SolidShape::box) q = q.cwiseMax(-0.5 * solid.size).cwiseMin(0.5 * solid.size);
  if (solid.shape == SolidShape::sphere) q *= std::min(1.0, solid.radius / q.norm());
  if (solid.shape == SolidShape::cylinder) {
    q.head<2>() *= std::min(1.0, solid.radius / q.head<2>().norm());
    q[2] = std::clamp(q[2], -half, half);
  }
  if (solid.shape == SolidShape::capsule) {
    const Vector3 core(0, 0, std::clamp(q[2], -half, half));
    q = core + std::min(1.0, solid.radius / (q - core).norm()) * (q - core);
  }
  return solid.pose.rotation * q + solid.pose.position;
}

/// How far a direction parts axis and solid: never over the signed distance, and equal to it for the best direction.
double parted_along(const Solid& solid, const Segment& axis, const Vector3& normal) {
  const Vector3 n = solid.pose.rotation.transpose() * normal;
  return std::min(normal.dot(axis.from - solid.pose.position), normal.dot(axis.to - solid.pose.position)) -
         reach_along(solid, n);
}

/// The largest of parted_along over a dense set of directions, improved by a shrinking search about the best of them.
double largest_parting(const Solid& solid, const Segment& axis, Random& random) {
  std::vector<std::pair<double, Vector3>> best;
  constexpr int directions = 2000;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, a = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vector3 n(std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z);
    best.emplace_back(parted_along(solid, axis, n), n);
  }
  std::partial_sort(best.begin(), best.begin() + 6, best.end(),
                    [](const auto& p, const auto& q) { return p.first > q.first; });
  double largest = best[0].first;
  for (int start = 0; start < 6; ++start) {
    auto [value, n] = best[static_cast<std::size_t>(start)];
    for (double step = 0.1; step > 1e-9; step *= 0.9) {
      for (int k = 0; k < 40; ++k) {
        const Vector3 trial = (n + step * point_in(random, 1.0)).normalized();
        const double parted = parted_along(solid, axis, trial);
        if (parted > value) {
          value = parted;
          n = trial;
        }
      }
    }
    largest = std::max(largest, value);
  }
  return largest;
}

}  // namespace

TEST_CASE("distances that can be worked out by hand") {
  Solid solid;
  solid.pose.position = {1, 0, 0};
  SECTION("box: beside a face, an edge, a corner, and inside") {
    solid.size = {0.2, 0.4, 0.6};
    CHECK(separation({{0, 0, -1}, {0, 0, 1}}, 0.1, solid).distance == Approx(0.8).margin(1e-15));
    CHECK(separation({{0.6, 0.6, -1}, {0.6, 0.6, 1}}, 0.1, solid).distance == Approx(std::hypot(0.3, 0.4) - 0.1));
    const Separation corner = separation({{1.3, 0.4, 0.6}, {2, 2, 2}}, 0, solid);
    CHECK(corner.distance == Approx(std::sqrt(0.04 + 0.04 + 0.09)));
    CHECK(corner.point == Vector3(1.3, 0.4, 0.6));
    const Separation inside = separation({{1.02, 0, -1}, {1.02, 0, 1}}, 0.05, solid);
    CHECK(inside.distance == Approx(-0.08 - 0.05));
    CHECK((inside.normal - Vector3::UnitX()).norm() < 1e-15);
    // Across a corner of the cross-section: the way out is along the diagonal.
    solid.size = {2, 2, 2};
    const Separation diagonal = separation({{1.8, 1.4, 0}, {2.2, 0.6, 0}}, 0, solid);
    CHECK(diagonal.distance == Approx(-(0.0 + 2 * 1 + 1 - (2 * 0.8 + 1.4)) / std::sqrt(5.0)).margin(1e-12));
  }
  SECTION("sphere") {
    solid.shape = SolidShape::sphere;
    solid.radius = 0.3;
    const Separation s = separation({{0, -1, 0}, {0, 3, 0}}, 0.2, solid);
    CHECK(s.distance == Approx(0.5));
    CHECK((s.normal + Vector3::UnitX()).norm() < 1e-15);
    CHECK(separation({{0, 0, 0}, {2, 0, 0}}, 0.2, solid).distance == Approx(-0.5));
  }
  SECTION("cylinder: beside the side, over the cap, past the rim, and inside") {
    solid.shape = SolidShape::cylinder;
    solid.radius = 0.5;
    solid.length = 2;
    CHECK(separation({{0, -1, 0.5}, {0, 1, 0.5}}, 0.1, solid).distance == Approx(0.4));
    CHECK(separation({{0, 0, 1.3}, {2, 0, 1.4}}, 0.1, solid).distance == Approx(0.2 + 0.05 * 0.5).margin(0.003));
    CHECK(separation({{1.8, 0, 1.4}, {3, 0, 1.4}}, 0, solid).distance == Approx(0.5));
    CHECK(separation({{1.2, 0, 0}, {1.2, 0, 0.3}}, 0.1, solid).distance == Approx(-0.4));
    CHECK(separation({{1, 0, 0}, {1, 0, 0.9}}, 0, solid).distance == Approx(-0.5));
    CHECK(separation({{1, 0, 0.8}, {1.1, 0, 0.8}}, 0, solid).distance == Approx(-0.2));
    CHECK(separation({{1, -1, 0}, {1, 1, 0}}, 0, solid).distance == Approx(-0.5));
  }
  SECTION("capsules: crossing, parallel, in one line, points") {
    const Segment x{{-1, 0, 0}, {1, 0, 0}};
    CHECK(separation(x, 0.1, {{0, -1, 0.5}, {0, 1, 0.5}}, 0.2).distance == Approx(0.2));
    CHECK(separation(x, 0.1, {{0, -1, 0}, {0, 1, 0}}, 0.2).distance == Approx(-0.3));
    CHECK(separation(x, 0.1, {{5, 0.4, 0}, {0.5, 0.4, 0}}, 0.2).distance == Approx(0.1));
    CHECK(separation(x, 0.1, {{3, 0, 0}, {2, 0, 0}}, 0.2).distance == Approx(0.7));
    CHECK(separation({{0, 0, 0}, {0, 0, 0}}, 0.1, {{0, 0, 1}, {0, 0, 1}}, 0.2).distance == Approx(0.7));
    solid.shape = SolidShape::capsule;
    solid.radius = 0.2;
    solid.length = 1;
    CHECK(separation({{0, 0, 0.4}, {0, 0, 2}}, 0.1, solid).distance == Approx(0.7));
    CHECK(separation({{1, 0, 1}, {1, 0, 2}}, 0.1, solid).distance == Approx(0.2));
  }
  SECTION("plane: above and below") {
    solid.shape = SolidShape::plane;
    const Separation s = separation({{0, 0, 0.5}, {1, 0, 0.2}}, 0.1, solid);
    CHECK(s.distance == Approx(0.1));
    CHECK(s.point == Vector3(1, 0, 0.2));
    CHECK(separation({{0, 0, 0.5}, {1, 0, -0.2}}, 0.1, solid).distance == Approx(-0.3));
  }
}

TEST_CASE("each distance is certified from both sides") {
  Random random(7);
  const SolidShape shape = GENERATE(SolidShape::box, SolidShape::sphere, SolidShape::cylinder, SolidShape::capsule);
  int inside = 0;
  double gap = 0;
  for (int i = 0; i < 400; ++i) {
    const Solid solid = solid_of(shape, random);
    const Segment axis = segment_for(solid, random, i % 2 == 0 ? 0.6 : 0.2);
    const Separation s = separation(axis, 0, solid);
    // No less: the normal parts axis and solid by as much.
    CHECK(parted_along(solid, axis, s.normal) == Approx(s.distance).margin(1e-12));
    // No more: the solid has a point that near; where they overlap, no direction of a dense search parts them further.
    if (s.distance > 0) {
      CHECK((nearest_of(solid, s.point) - s.point).norm() == Approx(s.distance).margin(1e-12));
      continue;
    }
    ++inside;
    const double searched = largest_parting(solid, axis, random);
    CHECK(searched <= s.distance + 1e-12);
    gap = std::max(gap, s.distance - searched);
  }
  CHECK(gap < 1e-3);  // the search is dense enough to mean something
  CHECK(inside > 60);
}

TEST_CASE("the normal is the derivative of the distance, and the point lies on the axis") {
  Random random(3);
  const SolidShape shape = GENERATE(from_range(std::begin(shapes), std::end(shapes)));
  const double radius = 0.05, step = 1e-6;
  int kinks = 0;
  for (int i = 0; i < 2000; ++i) {
    const Solid solid = solid_of(shape, random);
    const Segment axis = segment_for(solid, random);
    const Separation s = separation(axis, radius, solid);
    CHECK(s.normal.norm() == Approx(1).margin(1e-12));
    const Vector3 along = axis.to - axis.from;
    const double t = along.squaredNorm() > 0 ? (s.point - axis.from).dot(along) / along.squaredNorm() : 0.0;
    CHECK(t * along.norm() > -1e-12);
    CHECK((t - 1) * along.norm() < 1e-12);
    CHECK((axis.from + t * along - s.point).norm() < 1e-12);
    Vector3 gradient;
    bool kink = false;
    for (int k = 0; k < 3; ++k) {
      const Vector3 shift = step * Vector3::Unit(k);
      const double ahead = separation({axis.from + shift, axis.to + shift}, radius, solid).distance - s.distance;
      const double behind = s.distance - separation({axis.from - shift, axis.to - shift}, radius, solid).distance;
      kink = kink || std::abs(ahead - behind) > 1e-3 * step;  // where two features are equally deep
      gradient[k] = (ahead + behind) / (2 * step);
    }
    kinks += kink ? 1 : 0;
    if (!kink) CHECK((gradient - s.normal).norm() < 1e-3);
  }
  CHECK(kinks < 20);
}

TEST_CASE("turning the axis about its point changes the distance by nothing, moving the point by its velocity") {
  Random random(4);
  const SolidShape shape = GENERATE(from_range(std::begin(shapes), std::end(shapes)));
  int checked = 0;
  for (int i = 0; i < 500; ++i) {
    const Solid solid = solid_of(shape, random);
    const Segment axis{point_in(random, 0.5), point_in(random, 0.5)};
    const Separation s = separation(axis, 0.02, solid);
    const double step = 1e-6;
    const Vector3 pivot = point_in(random, 0.5), turn = point_in(random, 1.0).normalized();
    const auto turned = [&](double angle) {
      const Matrix3 R = rotation_from_vector(angle * turn);
      return separation({pivot + R * (axis.from - pivot), pivot + R * (axis.to - pivot)}, 0.02, solid).distance;
    };
    const double ahead = turned(step) - s.distance, behind = s.distance - turned(-step);
    if (std::abs(ahead - behind) > 1e-3 * step) continue;
    ++checked;
    CHECK((ahead + behind) / (2 * step) == Approx(s.normal.dot(turn.cross(s.point - pivot))).margin(1e-3));
  }
  CHECK(checked > 450);
}

TEST_CASE("the distance is continuous where the axis meets the solid") {
  Random random(5);
  const SolidShape shape = GENERATE(from_range(std::begin(shapes), std::end(shapes)));
  for (int i = 0; i < 200; ++i) {
    const Solid solid = solid_of(shape, random);
    const Segment axis = segment_for(solid, random);
    const Vector3 way = point_in(random, 1.0).normalized();
    double last = 0;
    for (int k = 0; k <= 400; ++k) {
      const Vector3 shift = (k * 0.003 - 0.6) * way;
      const double now = separation({axis.from + shift, axis.to + shift}, 0.03, solid).distance;
      if (k > 0) CHECK(std::abs(now - last) <= 0.003 + 1e-12);
      last = now;
    }
  }
}

TEST_CASE("two capsules: the same both ways round, and as the solid capsule") {
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const Solid solid = solid_of(SolidShape::capsule, random);
    const Segment a = segment_for(solid, random);
    const Vector3 half = 0.5 * solid.length * solid.pose.rotation.col(2);
    const Segment b{solid.pose.position - half, solid.pose.position + half};
    const Separation there = separation(a, 0.05, b, solid.radius), back = separation(b, solid.radius, a, 0.05);
    CHECK(there.distance == Approx(back.distance).margin(1e-12));
    CHECK(there.distance == Approx(separation(a, 0.05, solid).distance).margin(1e-12));
  }
  // Nearly parallel, and crossing: the hardest case for the digits.
  for (double angle = 1e-3; angle > 1e-12; angle *= 0.1) {
    const Vector3 d(std::cos(angle), std::sin(angle), 0);
    const Separation s =
        separation({{-1, 0, 0}, {1, 0, 0}}, 0, {-0.7 * d + Vector3(0.1, 0, 0), d + Vector3(0.1, 0, 0)}, 0);
    CHECK(std::abs(s.distance) < 1e-12);
  }
}
