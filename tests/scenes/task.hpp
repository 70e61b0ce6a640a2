// Scenes of experiment B: boxes between a start and a box of holes, round which there is one way or two.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lfdtools/random.hpp"
#include "lfdtools/scene.hpp"
#include "lfdtools/synthesis.hpp"

namespace lfd::scenes {

/// What a teacher shows and what learners are asked for.
struct Task {
  Vector3 start = Vector3::Zero();
  std::vector<Hole> holes;                    ///< six, demonstrated
  std::vector<Hole> new_holes;                ///< four between them
  Matrix3 orientation = Matrix3::Identity();  ///< of the flange, throughout: z into the holes, +y
  std::vector<Solid> obstacles;               ///< in the base
  std::vector<Solid> ground;                  ///< the table that the arm stands on: a box, its top at z = 0
  std::vector<Vector3> ways;                  ///< unit, across the way from start to holes: one or two opposite ones
  double berth = 0;                           ///< how far off the straight way the obstacle's edge lies, largest [m]
};

/// A wall between start and holes that ends beside the straight way on one side (one way round), or a beam that ends
/// on both (two).
[[nodiscard]] Task draw_task(bool two_ways, Random random);

}  // namespace lfd::scenes
