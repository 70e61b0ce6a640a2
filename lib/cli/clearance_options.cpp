// The options of arm-clearance.
#include <algorithm>

#include "lfdtools/cli/clearance_report.hpp"

namespace lfd::cli {

void declare_clearance(Program& program, ClearanceRequest& request) {
  program.reads("joints CSV with q1..q6").uses_seed();
  program.text("--scene", request.scene, "scene file, by name or path");
  program.text("--robot", request.robot, "robot file with links, by name or path");
  program.flag("--self", request.self, "the arm's own links count as obstacles too");
  program.number("--margin", request.margin, not_negative, "least distance from an obstacle that passes [m]");
  program.numbers("--tool", request.pose.tool, {3, 7},
                  "pose of the tool tip in the flange frame, x,y,z[,w,x,y,z]: one more link");
  program.number("--tool-radius", request.tool_radius, positive, "radius of that link [m]");
  program.path("--covariance", request.covariance,
               "how far the hand may be off, as skill-generate --covariance writes it: add a column probability");
  program.numbers("--goal-sd", request.goal_sd, {1, 3}, "standard deviation of the goal, one or x,y,z [m]: the same");
  program.text("--frame", request.pose.frame,
               "frame of covariance and goal: base, base_link, or one of the robot file's");
  program.number("--max-probability", request.max_probability, Range<double>{0.0, 1.0},
                 "largest probability that the path touches anything");
  program.gate("clearance", "a link closer than --margin to an obstacle, at a sample or between two")
      .gate("self_clearance", "with --self: a link inside another of the arm's")
      .gate("probability",
            "the path touches, or leaves the reach, with more than --max-probability, where that is given")
      .gate("mean_differs", "with --max-probability: the covariance is that of another hand path")
      .gate("joint_range", "a joint outside the robot's range")
      .gate("joint_step", "a joint moves by over 0.5 rad between two rows");
  program.check([&program, &request] {
    if (request.scene.empty() && !request.self) {
      throw UsageError("usage.missing", "there is nothing to keep clear of: give --scene, --self, or both");
    }
    if (program.given("--tool-radius") && !request.pose.tool) {
      throw UsageError("usage.missing", "--tool-radius needs --tool");
    }
    if (request.max_probability && !request.asks_probability()) {
      throw UsageError("usage.missing", "--max-probability needs --covariance or --goal-sd");
    }
    if (program.given("--frame") && !request.asks_probability()) {
      throw UsageError("usage.missing", "--frame, that of covariance and goal, needs --covariance or --goal-sd");
    }
    if (request.goal_sd &&
        std::any_of(request.goal_sd->begin(), request.goal_sd->end(), [](double sd) { return sd < 0 || sd > 10; })) {
      throw UsageError("usage.value", "--goal-sd: a standard deviation is from 0 to 10 m");
    }
    (void)tool_pose(request.pose);
  });
  const std::string elbow_up = "ur10-ik --rpy -1.5708,0,0 --seed-joints=-1.19,-1.77,1.82,-0.06,1.95,-3.14 motions.csv";
  program.example(elbow_up + " | arm-clearance --scene table", "every link's distance from the table");
  program.example(elbow_up + " | arm-clearance --scene table --self --margin 0.01",
                  "refused if anything comes closer than 1 cm to the table, or the arm into itself");
  program.example(elbow_up + " | arm-clearance --scene table --goal-sd 0.005 --max-probability 0.001",
                  "refused if it may touch, where goals are known to 5 mm");
}

}  // namespace lfd::cli
