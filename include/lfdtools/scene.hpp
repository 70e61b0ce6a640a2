// What stands around the arm: solids in the robot's base.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/dh.hpp"

namespace lfd {

enum class SolidShape {
  box,       ///< edges along the axes of its pose, centred
  sphere,    ///< about its position
  cylinder,  ///< along the z axis of its pose, centred, flat ends
  capsule,   ///< the same with half spheres beyond both ends
  plane      ///< z = 0 of its pose; the side z > 0 is free
};

/// An obstacle.
struct Solid {
  std::string name;
  SolidShape shape = SolidShape::box;
  Pose pose;                       ///< in the frame of the scene [m]
  Vector3 size = Vector3::Zero();  ///< full edges of a box [m]
  double radius = 0;               ///< of sphere, cylinder and capsule [m]
  double length = 0;               ///< of cylinder and capsule, without the half spheres [m]

  /// Its name or, without one, its number from 1. @param index  in its scene, from 0
  [[nodiscard]] std::string called(std::size_t index) const { return name.empty() ? std::to_string(index + 1) : name; }
};

/// Obstacles, and the frame in which they are told.
struct Scene {
  std::string frame = "base";  ///< base (DH frame 0) or base_link (ROS: turned by pi about z)
  std::vector<Solid> obstacles;

  /// The obstacles in DH frame 0. @param robot  its own frame of that name is meant, if it has one
  [[nodiscard]] std::vector<Solid> in_base(const Robot& robot = {}) const;
};

}  // namespace lfd
