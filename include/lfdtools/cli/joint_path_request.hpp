// What ur10-ik is asked for: joint paths along hand paths, or every solution of each pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/cli/arm_gates.hpp"
#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/poses.hpp"

namespace lfd::cli {

/// The options of ur10-ik.
struct JointPathRequest {
  PoseOptions pose;
  ArmLimits limits;
  std::string robot = "ur10";
  std::optional<std::vector<double>> seed;  ///< the arm's current joints [rad]
  double start_tolerance = 0.1;             ///< of the path's start about them [rad]
  std::string posture;                      ///< file of demonstrations whose branch is kept; empty: any branch
  bool all = false;                         ///< every solution of every pose instead of a path
  bool given_rows = false;                  ///< no rows between those of the input
  bool retime = false;                      ///< as fast as the limits allow
  std::optional<double> acceleration;       ///< of every joint, in place of the robot file's [rad/s^2]
  bool speeds = false;
  bool accelerations = false;
  bool diagnostics = false;
  bool singularities = false;
};

/// Declares options, gates, checks and examples.
void declare_joint_path_request(Program& program, JointPathRequest& request);

/// Reads robot, posture and hand paths, writes what is asked for.
/// @throws UsageError [ik.no_orientation]; those of load_robot, DemonstrationSource, solve_path, judge and judge_start
void answer(const JointPathRequest& request, Run& run);

}  // namespace lfd::cli
