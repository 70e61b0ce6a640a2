// What a user asks skill-generate for, and how it is answered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/skill_file.hpp"

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
};

/// Motions (or weights) of a skill for the goals asked for.
/// @throws UsageError [generate.no_goal], [generate.no_target], [usage.arity]; Error(Fault::gate) gate.region,
/// gate.start;
///         those of read_goals and generate
void generate_from_skill(const SkillFile& file, const MotionRequest& request, Run& run);

/// Replays a primitive as it is; a goal, start or duration of the request takes the place of its own.
/// @throws UsageError [generate.which] unless the request names one of several, [generate.no_target],
/// [generate.weights]
void replay(std::vector<DmpFile> files, const MotionRequest& request, Run& run);

}  // namespace lfd::cli
