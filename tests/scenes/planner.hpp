// Planners that know the scene (OMPL): what a taught skill is compared with, and a teacher's first idea.
#pragma once

#include <functional>
#include <optional>

#include "lfdtools/dh.hpp"

namespace lfd::scenes {

/// A path of the hand through free space, n x 3, by RRT-Connect, with short cuts; empty if none is found in 20000
/// iterations.
[[nodiscard]] std::optional<Samples> plan_hand(const Vector3& start, const Vector3& goal,
                                               const std::function<bool(const Vector3&)>& free);

enum class Planner { rrt_connect, prm };

struct PlannedJoints {
  Samples joints;      ///< n x 6 [rad], interpolated to steps of 0.02 rad
  double seconds = 0;  ///< processor time of planning and short cuts
};

/// A path in joint space with short cuts, each joint within half a turn of its start.
[[nodiscard]] std::optional<PlannedJoints> plan_joints(Planner planner, const Joints& start, const Joints& goal,
                                                       const std::function<bool(const Joints&)>& free);

/// Makes the planners' random numbers start anew. Before any of them is used, once.
void seed_planners(unsigned seed);

}  // namespace lfd::scenes
