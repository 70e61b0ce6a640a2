// Second opinion on capsule distances: the Flexible Collision Library.
#include <ccd/ccd.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <iostream>
#include <memory>

#include "lfdtools/random.hpp"
#include "lfdtools/solid_distance.hpp"

using namespace lfd;

namespace {

constexpr int pairs = 100'000;

struct Pair {
  Segment axis;
  double radius;
  Solid solid;
};

Vector3 point_in(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

Pair pair_of(SolidShape shape, Random& random) {
  Pair pair;
  pair.axis = {point_in(random, 1.0), point_in(random, 1.0)};
  pair.radius = random.uniform(0.02, 0.15);
  pair.solid.shape = shape;
  pair.solid.size = {random.uniform(0.05, 0.8), random.uniform(0.05, 0.8), random.uniform(0.05, 0.8)};
  pair.solid.radius = random.uniform(0.02, 0.3);
  pair.solid.length = random.uniform(0.05, 0.8);
  pair.solid.pose = {rotation_from_vector(point_in(random, 1.8)), point_in(random, 1.0)};
  return pair;
}

fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d T = fcl::Transform3d::Identity();
  T.linear() = pose.rotation;
  T.translation() = pose.position;
  return T;
}

fcl::Transform3d transform(const Segment& axis) {
  Pose pose;
  pose.rotation = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), axis.to - axis.from).toRotationMatrix();
  pose.position = 0.5 * (axis.from + axis.to);
  return transform(pose);
}

std::shared_ptr<fcl::CollisionGeometryd> geometry(const Solid& solid, double off) {
  switch (solid.shape) {
    case SolidShape::box:
      return std::make_shared<fcl::Boxd>(solid.size);
    case SolidShape::sphere:
      return std::make_shared<fcl::Sphered>(solid.radius - off);
    case SolidShape::cylinder:
      return std::make_shared<fcl::Cylinderd>(solid.radius, solid.length);
    case SolidShape::capsule:
      return std::make_shared<fcl::Capsuled>(solid.radius - off, solid.length);
    default:
      return std::make_shared<fcl::Halfspaced>(Vector3::UnitZ(), 0.0);
  }
}

/// FCL's distance of a pair. Where the two overlap, both are made thinner until they do not, and the answer is less by
/// what was taken off the radii: FCL's own depths are no shortest translations.
/// @param gap  ours, positive once the radii are taken off
double fcl_distance(const Pair& pair, double gap) {
  double off_axis = 0.0, off_solid = 0.0;
  if (gap < 0) {
    const bool round = pair.solid.shape == SolidShape::sphere || pair.solid.shape == SolidShape::capsule;
    const double all = pair.radius + (round ? pair.solid.radius : 0.0);
    const double part = (all - 0.5 * (all + gap)) / all;  // leaves half of the distance between the cores
    off_axis = part * pair.radius;
    off_solid = round ? part * pair.solid.radius : 0.0;
  }
  const fcl::Capsuled capsule(pair.radius - off_axis, (pair.axis.to - pair.axis.from).norm());
  const auto other = geometry(pair.solid, off_solid);
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-9;
  fcl::DistanceResultd result;
  fcl::distance(&capsule, transform(pair.axis), other.get(), transform(pair.solid.pose), request, result);
  return result.min_distance - off_axis - off_solid;
}

// The axis alone inside a box or cylinder: the expanding polytope of libccd, on which FCL's depths rest. It grows
// inside the Minkowski sum, so that its depth is never too large.

void axis_support(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const auto& axis = *static_cast<const Segment*>(body);
  const Vector3 n(direction->v[0], direction->v[1], direction->v[2]);
  const Vector3& end = n.dot(axis.from) > n.dot(axis.to) ? axis.from : axis.to;
  ccdVec3Set(point, end[0], end[1], end[2]);
}

void solid_support(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const auto& solid = *static_cast<const Solid*>(body);
  const Vector3 n = solid.pose.rotation.transpose() * Vector3(direction->v[0], direction->v[1], direction->v[2]);
  Vector3 p = 0.5 * solid.size;
  for (int i = 0; i < 3; ++i) p[i] = std::copysign(p[i], n[i]);
  if (solid.shape == SolidShape::cylinder) {
    const double flat = n.head<2>().norm();
    p << (flat > 0 ? solid.radius / flat : 0.0) * n.head<2>(), std::copysign(0.5 * solid.length, n[2]);
  }
  const Vector3 out = solid.pose.rotation * p + solid.pose.position;
  ccdVec3Set(point, out[0], out[1], out[2]);
}

/// @return minus depth and radius
double ccd_depth(const Pair& pair) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = axis_support;
  ccd.support2 = solid_support;
  ccd.max_iterations = 1000;
  ccd.epa_tolerance = 1e-7;
  double depth = 0.0;
  ccd_vec3_t direction, position;
  REQUIRE(ccdGJKPenetration(&pair.axis, &pair.solid, &ccd, &depth, &direction, &position) == 0);
  return -depth - pair.radius;
}

/// Worst differences [m] and counts.
struct Worst {
  double apart = 0.0, overlapping = 0.0;  ///< FCL's distance, see fcl_distance
  double parted = 0.0;                    ///< axis inside: FCL's distance once moved out by our depth and 10 mm
  double too_deep = 0.0, shallow = 0.0;   ///< axis inside: libccd's depth over ours, and the mean of it under ours
  int overlaps = 0, through = 0;
};

Worst worst_difference(SolidShape shape) {
  Random random(11);
  Worst worst;
  for (int i = 0; i < pairs; ++i) {
    Pair pair = pair_of(shape, random);
    const Separation ours = separation(pair.axis, pair.radius, pair.solid);
    const bool edged = shape == SolidShape::box || shape == SolidShape::cylinder;
    if (edged && ours.distance <= -pair.radius) {
      ++worst.through;
      const double theirs = ccd_depth(pair);
      worst.too_deep = std::max(worst.too_deep, ours.distance - theirs);
      worst.shallow += theirs - ours.distance;
      constexpr double gap = 0.01;
      pair.axis.from += (gap - ours.distance) * ours.normal;
      pair.axis.to += (gap - ours.distance) * ours.normal;
      worst.parted = std::max(worst.parted, std::abs(fcl_distance(pair, gap) - gap));
      continue;
    }
    double& slot = ours.distance < 0 ? worst.overlapping : worst.apart;
    slot = std::max(slot, std::abs(fcl_distance(pair, ours.distance) - ours.distance));
    if (ours.distance < 0) ++worst.overlaps;
  }
  if (worst.through > 0) worst.shallow /= worst.through;
  return worst;
}

/// A plane: FCL knows contacts with a half space only, so it is raised until the capsule is in it.
double worst_plane_difference() {
  Random random(12);
  double worst = 0.0;
  for (int i = 0; i < pairs; ++i) {
    const Pair pair = pair_of(SolidShape::plane, random);
    const double ours = separation(pair.axis, pair.radius, pair.solid).distance;
    constexpr double raised = 10.0;
    Pose pose = pair.solid.pose;
    pose.position += raised * pose.rotation.col(2);
    const fcl::Capsuled capsule(pair.radius, (pair.axis.to - pair.axis.from).norm());
    const fcl::Halfspaced half_space(Vector3::UnitZ(), 0.0);
    fcl::CollisionResultd result;
    fcl::collide(&capsule, transform(pair.axis), &half_space, transform(pose), fcl::CollisionRequestd(1, true), result);
    REQUIRE(result.numContacts() > 0);
    worst = std::max(worst, std::abs(raised - result.getContact(0).penetration_depth - ours));
  }
  return worst;
}

}  // namespace

TEST_CASE("100000 random pairs of each kind agree with FCL as far as FCL is exact") {
  const auto report = [](const char* kind, const Worst& worst) {
    std::cout << "FCL, capsule and " << kind << ": worst difference " << worst.apart << " m apart, "
              << worst.overlapping << " m in " << worst.overlaps << " overlapping pairs; " << worst.through
              << " with the axis inside: " << worst.parted << " m once parted, libccd's depth less by " << worst.shallow
              << " m on average\n";
    CHECK(worst.overlaps > 1000);
    CHECK(worst.overlapping < 1e-5);
    CHECK(worst.too_deep < 1e-7);
    return worst;
  };
  SECTION("box") {
    const Worst worst = report("box", worst_difference(SolidShape::box));
    CHECK(worst.apart < 1e-5);
    CHECK(worst.parted < 1e-5);
    CHECK(worst.shallow < 1e-6);
  }
  SECTION("sphere") {
    CHECK(report("sphere", worst_difference(SolidShape::sphere)).apart < 1e-10);
  }
  SECTION("cylinder: FCL is off by up to 6e-5 m") {
    const Worst worst = report("cylinder", worst_difference(SolidShape::cylinder));
    CHECK(worst.apart < 1e-4);
    CHECK(worst.parted < 1e-4);
    CHECK(worst.shallow < 1e-3);
  }
  SECTION("capsule") {
    CHECK(report("capsule", worst_difference(SolidShape::capsule)).apart < 1e-10);
  }
  SECTION("plane") {
    const double worst = worst_plane_difference();
    std::cout << "FCL, capsule and plane: worst difference " << worst << " m\n";
    CHECK(worst < 1e-12);
  }
}
