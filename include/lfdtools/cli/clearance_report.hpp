// What a user asks arm-clearance for, and how it is answered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/poses.hpp"

namespace lfd::cli {

/// The options of arm-clearance.
struct ClearanceRequest {
  std::string robot = "ur10";
  std::string scene;  ///< empty: none
  bool self = false;
  PoseOptions pose;           ///< tool, and frame of the covariance
  double tool_radius = 0.01;  ///< [m]
  double margin = 0.0;        ///< [m]

  // How sure the path of the hand is.
  std::string covariance;                      ///< file, empty: none
  std::optional<std::vector<double>> goal_sd;  ///< one, or x,y,z [m]
  std::optional<double> max_probability;

  [[nodiscard]] bool asks_probability() const { return !covariance.empty() || goal_sd; }
};

/// Declares the options, gates, checks and examples.
void declare_clearance(Program& program, ClearanceRequest& request);

/// Reads joint paths, writes the distance of every link at every sample, and judges each path.
/// @throws as load_robot_with_links, load_scene, read_covariance; Error(Fault::gate) gate.clearance,
/// gate.self_clearance,
///         gate.probability;
///         DataError [clearance.covariance_target], [clearance.covariance_samples], [clearance.covariance_columns]
void report_clearance(const ClearanceRequest& request, Run& run);

}  // namespace lfd::cli
