// Signed distance between a capsule and what it may touch: solids and other capsules.
#pragma once

#include "lfdtools/scene.hpp"

namespace lfd {

/// A straight line between two points, which may coincide [m].
struct Segment {
  Vector3 from = Vector3::Zero();
  Vector3 to = Vector3::Zero();
};

/// How far two bodies are from each other. Negative where they overlap: minus the shortest translation that parts them.
struct Separation {
  double distance = 0.0;              ///< signed [m]
  Vector3 point = Vector3::Zero();    ///< nearest (or deepest) point on the axis of the first body [m]
  Vector3 normal = Vector3::UnitZ();  ///< unit; the distance grows one to one as `point` moves along it
};

/// A capsule (all points within `radius` of `axis`) against a solid whose pose is in the frame of the axis. Box,
/// sphere, capsule and plane in closed form; a cylinder's distance is a convex minimum along the axis, its depth one of
/// three maxima, both to 1e-12 m. A plane is the half space z < 0 of its pose.
[[nodiscard]] Separation separation(const Segment& axis, double radius, const Solid& solid);

/// Two capsules; `point` and `normal` belong to the first.
[[nodiscard]] Separation separation(const Segment& a, double radius_a, const Segment& b, double radius_b);

}  // namespace lfd
