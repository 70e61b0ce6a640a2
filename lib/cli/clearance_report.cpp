#include "lfdtools/cli/clearance_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hand_spread_source.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/io/scene_file.hpp"
#include "lfdtools/touching.hpp"

namespace lfd::cli {
namespace {

// The least distance along a path is found to this [m].
constexpr double tolerance = 1e-4;
// A step over this between two rows is no way that an arm goes straight [rad].
constexpr double longest_step = 0.5;
// Of joints written with few digits [rad].
constexpr double rounding = 1e-6;
// Where the way between samples comes this much closer than they do, their probability misses it [m].
constexpr double much_closer = 1e-3;
// A share of paths out of reach that is worth a word.
constexpr double often_lost = 0.01;

std::string millimetres(double distance) {
  return distance < 0 ? fmt::format("{:.1f} mm inside", -1e3 * distance)
                      : fmt::format("{:.1f} mm from", 1e3 * distance);
}

/// Refuses joints that the robot cannot take, and steps whose way between is anybody's guess.
void judge_joints(const Recording& recording, const Robot& robot, Run& run) {
  const Samples& joints = recording.demonstration.trajectory.positions;
  const std::string name = prefix_of(recording.demonstration.labels);
  const Joints low = robot.limits.position.col(0), high = robot.limits.position.col(1);
  const auto beyond = [&](Eigen::Index k) {
    const Joints q = joints.row(k).transpose();
    return Joints((low - q).cwiseMax(q - high));
  };
  const auto step = [&](Eigen::Index k) {
    return k == 0 ? Joints(Joints::Zero()) : Joints((joints.row(k) - joints.row(k - 1)).cwiseAbs().transpose());
  };
  for (Eigen::Index k = 0, j = 0; k < joints.rows(); ++k) {
    if (!(beyond(k).maxCoeff(&j) > rounding)) continue;
    run.refuse("joint_range",
               fmt::format("{}joint {} is at {:.4g} rad, outside its range of {:.4g} to {:.4g} rad", name, j + 1,
                           joints(k, j), low[j], high[j]),
               recording.place(k));
    break;
  }
  for (Eigen::Index k = 0, j = 0; k < joints.rows(); ++k) {
    if (!(step(k).maxCoeff(&j) > longest_step + rounding)) continue;
    run.refuse("joint_step",
               fmt::format("{}joint {} moves {:.3g} rad from one row to the next, over {:g} rad", name, j + 1,
                           step(k)[j], longest_step),
               recording.place(k));
    break;
  }
}

/// Where a path comes closest, in words.
std::string approach(const ArmClearance& arm, const ClosestApproach& closest, const Recording& recording) {
  return fmt::format("{}link {} is {} {}{}", prefix_of(recording.demonstration.labels),
                     arm.bodies()[static_cast<std::size_t>(closest.pair.link)].name, millimetres(closest.distance),
                     arm.obstacle_name(closest.pair.obstacle),
                     closest.share > 0 ? " on the way to the next sample" : "");
}

/// Refuses a path that comes too close. @param margin  [m]
void judge(std::string_view gate, double margin, const ArmClearance& arm, const ClosestApproach& closest,
           const Recording& recording, Run& run) {
  if (!std::isfinite(closest.distance)) return;
  const std::string text = approach(arm, closest, recording);
  if (closest.distance < margin) {
    run.refuse(gate, fmt::format("{}, under {:g} mm", text, 1e3 * margin), recording.place(closest.sample));
  }
  if (!closest.complete) {
    run.refuse(gate, fmt::format("{}; it moves too far between rows to tell how close it comes there", text),
               recording.place(closest.sample));
  }
  run.detail(fmt::format("clearance.{}", gate == "clearance" ? "closest" : "closest_self"), text);
}

/// Says where the way between samples, of which the probability knows nothing, comes closer than they do.
/// @param least  of the pairs that `closest` speaks of, at given joints
void warn_of_way(const ArmClearance& arm, double (ArmClearance::*least)(const Joints&) const,
                 const ClosestApproach& closest, const Recording& recording, Run& run) {
  if (!(closest.share > 0)) return;
  const Samples& joints = recording.demonstration.trajectory.positions;
  double at_samples = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < joints.rows(); ++k) {
    at_samples = std::min(at_samples, (arm.*least)(joints.row(k).transpose()));
  }
  if (closest.distance > at_samples - much_closer) return;
  run.messages().warning(
      "clearance.probability_sparse",
      fmt::format("{}, at no sample under {:.1f} mm, and the probability is of the samples alone: a smaller --dt of "
                  "skill-generate puts more of them there",
                  approach(arm, closest, recording), 1e3 * at_samples),
      recording.place(closest.sample));
}

/// A row a link: its closest solid, or, where the arm itself counts, its closest neighbour in either.
std::vector<LinkClearance> rows_of(const ArmClearance& arm, const Joints& q, bool self) {
  std::vector<LinkClearance> rows = arm.links(q);
  if (!self) return rows;
  std::vector<LinkClearance> closest;
  for (const auto& list : {rows, arm.pairs_of_arm_itself(q)}) {
    for (const LinkClearance& pair : list) {
      const auto known = std::find_if(closest.begin(), closest.end(),
                                      [&](const LinkClearance& other) { return other.link == pair.link; });
      if (known == closest.end()) {
        closest.push_back(pair);
      } else if (pair.distance < known->distance) {
        *known = pair;
      }
    }
  }
  std::sort(closest.begin(), closest.end(), [](const auto& a, const auto& b) { return a.link < b.link; });
  return closest;
}

Scene scene_of(const std::string& file, bool self, Run& run) {
  Scene scene = load_scene(file, run.messages(), run.options().strict);
  if (!scene.obstacles.empty()) return scene;
  if (!self) {
    throw UsageError(
        "usage.missing",
        fmt::format("there is nothing to keep clear of: {} has no obstacles, and --self is not given", file));
  }
  run.messages().warning("scene.empty", "the scene has no obstacles: only the arm itself counts",
                         {file, 0, 0, "/obstacles"});
  return scene;
}

/// In a column that holds both, a name must say which it is.
void require_other_names(const Scene& scene, const std::string& file, const ArmClearance& arm) {
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const std::string name = scene.obstacles[i].called(i);
    const auto called = [&](const Capsule& link) { return link.name == name; };
    if (std::none_of(arm.bodies().begin(), arm.bodies().end(), called)) continue;
    throw ConfigError("scene.name_of_link", fmt::format("an obstacle is called '{}', as a link of the arm is", name),
                      {file, 0, 0, fmt::format("/obstacles/{}", i)});
  }
}

}  // namespace

void report_clearance(const ClearanceRequest& request, Run& run) {
  Robot robot = load_robot_with_links(find_data_file(request.robot, "robots"), run.messages(), run.options().strict);
  const std::string file = request.scene.empty() ? "" : find_data_file(request.scene, "scenes");
  const Scene scene = file.empty() ? Scene{} : scene_of(file, request.self, run);
  const Pose tool = tool_pose(request.pose);
  std::optional<Capsule> held;
  if (request.pose.tool) held = tool_capsule(tool, request.tool_radius);
  const std::vector<Solid> solids = scene.in_base(robot);
  const ArmClearance arm(std::move(robot), solids, held);
  if (request.self) require_other_names(scene, file, arm);
  const HandSpreadSource spreads(request, arm.robot(), run);

  DemonstrationSource source(CsvTable(run.open(), run.messages()), run.messages(),
                             {.columns = joint_columns(), .extras = {}, .min_samples = 1, .gaps = false});
  std::vector<std::string> columns = {"t", "link", "obstacle", "distance"};
  if (request.asks_probability()) columns.emplace_back("probability");
  LabelledTable table(run.output(), columns);
  double least = std::numeric_limits<double>::infinity(), least_of_itself = least;
  for (std::size_t i = 0; i < source.recordings(); ++i) {
    const Recording recording = source.recording(i);
    const Trajectory& path = recording.demonstration.trajectory;
    judge_joints(recording, arm.robot(), run);
    const ClosestApproach closest = closest_approach(arm, path.positions, tolerance);
    judge("clearance", request.margin, arm, closest, recording, run);
    if (request.asks_probability()) warn_of_way(arm, &ArmClearance::least, closest, recording, run);
    least = std::min(least, closest.distance);
    if (request.self) {
      const ClosestApproach own = closest_approach_of_arm_itself(arm, path.positions, tolerance);
      judge("self_clearance", 0.0, arm, own, recording, run);
      if (request.asks_probability()) warn_of_way(arm, &ArmClearance::least_of_arm_itself, own, recording, run);
      least_of_itself = std::min(least_of_itself, own.distance);
    }
    Touching chances;
    if (request.asks_probability()) {
      chances = touching(arm, path.positions, spreads.of(recording), tool, {.self = request.self, .seed = run.seed()});
      const std::string text =
          fmt::format("{}the path touches with probability {:.3g}{}", prefix_of(recording.demonstration.labels),
                      chances.path.probability,
                      chances.path.error > 0 ? fmt::format(" (standard error {:.1g})", chances.path.error) : "");
      // Of a path that the arm cannot follow nobody knows what it would touch.
      const double either = chances.path_or_out_of_reach.probability;
      if (request.max_probability && either > *request.max_probability) {
        const std::string lost = chances.out_of_reach.probability > 0.0
                                     ? fmt::format(", or leaves the arm's reach, together {:.3g}", either)
                                     : "";
        run.refuse("probability", fmt::format("{}{}, over {:g}", text, lost, *request.max_probability),
                   recording.place(0));
      }
      run.detail("clearance.probability", text);
      run.figure("path_probability", chances.path.probability);
      if (chances.out_of_reach.probability > often_lost) {
        run.messages().warning(
            "clearance.out_of_reach",
            fmt::format("{}where the hand may be off, {:.2g} of the paths leave the arm's reach: there "
                        "they count as touching nothing",
                        prefix_of(recording.demonstration.labels), chances.out_of_reach.probability),
            recording.place(0));
      }
    }
    CsvWriter& writer = table.begin(recording.demonstration.labels);
    for (Eigen::Index k = 0; k < path.samples(); ++k) {
      for (const LinkClearance& row : rows_of(arm, path.positions.row(k).transpose(), request.self)) {
        writer.labels(recording.demonstration.labels);
        writer.number(path.times[k]);
        writer.text(arm.bodies()[static_cast<std::size_t>(row.link)].name);
        writer.text(arm.obstacle_name(row.obstacle));
        writer.number(row.distance);
        if (request.asks_probability()) writer.number(chances.samples[static_cast<std::size_t>(k)].probability);
        writer.end_row();
      }
    }
  }
  if (std::isfinite(least)) run.figure("least_distance", least);
  if (std::isfinite(least_of_itself)) run.figure("least_distance_self", least_of_itself);
}

}  // namespace lfd::cli
