// The options of skill-generate.
#include <fmt/format.h>

#include "lfdtools/cli/motion_request.hpp"

namespace lfd::cli {
namespace {

void check_request(const MotionRequest& request) {
  if (!request.goals.empty() && !request.goals_file.empty()) {
    throw UsageError("usage.exclusive", "--goal and --goals exclude each other");
  }
  if (request.goals_file == "-") throw UsageError("usage.value", "--goals takes a file, not standard input");
  if (request.camera == "-") throw UsageError("usage.value", "--camera takes a file, not standard input");
  if (request.covariance == "-") throw UsageError("usage.value", "--covariance takes a file, not standard output");
  const std::string spread = request.needs_posterior();
  if (!request.goal_at.empty() && !spread.empty()) {
    throw UsageError("usage.exclusive", fmt::format("--goal-at and {} exclude each other: what is known of a motion "
                                                    "speaks of one goal",
                                                    spread));
  }
  if (request.weights && (!spread.empty() || !request.goal_at.empty() || request.approach || request.derivatives)) {
    throw UsageError("usage.exclusive", "--weights writes no motion, so it excludes the options of one");
  }
  if (request.approach &&
      Eigen::Map<const Vector>(request.approach->data(), static_cast<Eigen::Index>(request.approach->size()))
          .isZero(0)) {
    throw UsageError("usage.value", "--approach takes a direction, not zero");
  }
  if (request.samples > 0 && request.band) {
    throw UsageError("usage.exclusive", "--samples and --band exclude each other: a band belongs to the mean");
  }
}

}  // namespace

std::string MotionRequest::needs_posterior() const {
  if (!sd.empty()) return "--sd";
  if (samples > 0) return "--samples";
  if (!covariance.empty()) return "--covariance";
  if (band) return "--band";
  if (max_sd) return "--max-sd";
  if (!via.empty()) return "--via";
  if (end_velocity) return "--end-velocity";
  return {};
}

void declare_motion_request(Program& program, MotionRequest& request) {
  program.number_lists("--goal", request.goals, 0, "goal X,Y,Z [m]; repeatable");
  program.path("--goals", request.goals_file,
               "goals CSV: [target,][teacher,]x,y,z[,start_x,...][,sd_x,...][,duration]");
  program.text("--target", request.target, "of the goals, or of a file of primitives, this one alone");
  program.numbers("--start", request.start, {}, "start of the motion [m] (default: the skill's)");
  program.number("--duration", request.duration, positive, "duration [s] (default: the skill's for this goal)");
  program.number("--dt", request.dt, positive, "time step [s] (default: a 200th of the duration)");
  program.flag("--weights", request.weights,
               "write the predicted weights and their latent standard deviations instead");
  program.flag("--derivatives", request.derivatives, "add columns v_ and a_: velocity and acceleration");
  program.path("--camera", request.camera, "transform JSON: goals, and starts beside them, are in camera coordinates");
  program.number_lists("--via", request.via, 0,
                       "T,X,Y,Z[,SD]: pass there at time T [s], exactly or with this sd [m]; repeatable");
  program.number_lists("--goal-at", request.goal_at, 0, "T,X,Y,Z: from time T [s] on this is the goal; repeatable");
  program.numbers("--start-velocity", request.start_velocity, {}, "velocity at the start [m/s] (default: rest)");
  program.numbers("--end-velocity", request.end_velocity, {}, "velocity at the duration's end [m/s] (default: free)");
  program.numbers("--approach", request.approach, {}, "report how the motion arrives along this direction");
  program.word_or_default("--sd", request.sd, "latent", {"latent", "predictive"},
                          "add columns sd_: of the intention, or of one demonstration");
  program.choice<std::optional<BandKind>>("--band", request.band,
                                          {{"pointwise", BandKind::pointwise}, {"path", BandKind::path}},
                                          "add columns band_: half-widths of a 95 % band about the intention");
  program.integer("--samples", request.samples, {0, 1'000'000},
                  "write this many draws a goal instead of the mean, of what --sd says (0: none)");
  program.written_path("--covariance", request.covariance, "write the covariance of each motion to this file");
  program.number("--max-sd", request.max_sd, positive, "gate sd: largest predictive sd allowed [m]");
  program.gate("region", "goal outside the demonstrated region");
  program.gate("start", "no start is given though the demonstrations start over 20 mm apart");
  program.gate("sd", "predictive sd over --max-sd");
  program.check([&] { check_request(request); });
  program.example("skill-generate skill.json --goal 0.1,0.8,0.3", "one motion, to standard output");
  program.example("skill-generate skill.json --goals goals.csv --dt 0.01 -o motions.csv", "several, at 100 Hz");
  program.example("skill-generate skill.json --goal 0.1,0.8,0.3 --via 1.2,-0.13,0.49,0.61 --sd",
                  "the nearest motion that passes a point, and how sure it is");
  program.example("skill-generate skill.json --goal 0.1,0.8,0.3 --samples 20 --seed 7", "twenty motions it might be");
  program.example("demo-align demos.csv | gmm-fit -k 4 | gmr-regress | dmp-fit | skill-generate --target 3",
                  "what the primitive of target 3 does by itself");
}

}  // namespace lfd::cli
