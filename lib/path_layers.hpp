// The layers of the graph that a joint path is a way through: the solutions of inverse kinematics at every sample,
// those of singular wrists connected to their neighbours. For path.cpp alone.
#pragma once

#include <vector>

#include "lfdtools/ur10.hpp"

namespace lfd {

/// The solutions at one sample; empty where the pose is out of reach. With a singular wrist there may be many of one
/// branch, each with another q6.
using SolutionLayer = std::vector<IkSolution>;

/// Solves every sample. Where the wrist is singular over some samples q6 is free there, and besides the solver's own
/// choice it goes evenly in time from every solution of the sample before to every one of the sample after, with the
/// same shoulder and elbow; at an end of the path it stays as on the one side there is, and where the wrist is singular
/// throughout, at eight constant values.
/// @param flange  T >= 1 poses of the flange in the base [m]   @param times  T, strictly rising [s]
/// @return T layers; joints in (-pi, pi] [rad]
[[nodiscard]] std::vector<SolutionLayer> solve_layers(const InverseKinematics& arm, const std::vector<Pose>& flange,
                                                      const Vector& times, const IkOptions& options);

}  // namespace lfd
