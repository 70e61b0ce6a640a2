// What a user asks skill-generate for, and how it is answered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/skill_file.hpp"
#include "lfdtools/posterior.hpp"
#include "lfdtools/rotation.hpp"

namespace lfd::cli {

/// The options of skill-generate.
struct MotionRequest {
  std::vector<std::vector<double>> goals;
  std::string goals_file;
  std::string target;
  std::optional<std::vector<double>> start;
  std::optional<double> duration;
  std::optional<double> dt;
  bool weights = false;
  bool derivatives = false;

  // Where and how it shall go.
  std::vector<std::vector<double>> via;      ///< t, a number a signal, and perhaps an sd
  std::vector<std::vector<double>> goal_at;  ///< t, a number a signal
  std::optional<std::vector<double>> start_velocity;
  std::optional<std::vector<double>> end_velocity;
  std::optional<std::vector<double>> approach;
  std::string camera;
  std::optional<Pose> camera_pose;  ///< read from `camera`

  // How sure it is.
  std::string sd;  ///< latent, predictive, or empty
  std::int64_t samples = 0;
  std::string covariance;
  std::optional<BandKind> band;
  std::optional<double> max_sd;

  [[nodiscard]] Spread spread() const { return sd == "predictive" ? Spread::predictive : Spread::latent; }
  /// The first option given that speaks of the spread of a motion, or asks for the nearest motion that meets a demand;
  /// empty if there is none.
  [[nodiscard]] std::string needs_posterior() const;
};

/// Declares the options, gates, checks and examples.
void declare_motion_request(Program& program, MotionRequest& request);

/// Motions (or weights) of a skill for the goals asked for.
/// @param sha256  of the skill's bytes, for the provenance of what is written
/// @throws UsageError [generate.no_goal], [generate.no_target], [generate.camera], [generate.one_goal], [usage.arity];
///         Error(Fault::gate) gate.region, gate.start, gate.sd; those of read_goals, predict_motion and generate
void generate_from_skill(const SkillFile& file, const MotionRequest& request, const std::string& sha256, Run& run);

/// Replays a primitive as it is; a goal, start or duration of the request takes the place of its own.
/// @throws UsageError [generate.which] unless the request names one of several, [generate.no_target],
///         [generate.weights], [generate.no_posterior]
void replay(std::vector<DmpFile> files, const MotionRequest& request, Run& run);

}  // namespace lfd::cli
