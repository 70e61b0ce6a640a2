// The options of ur10-ik.
#include <fmt/format.h>

#include "lfdtools/cli/joint_path_request.hpp"

namespace lfd::cli {

void declare_joint_path_request(Program& program, JointPathRequest& request) {
  PoseOptions& pose = request.pose;
  program.text("--robot", request.robot, "robot file, by name or path");
  program.numbers("--orientation", pose.orientation, {4}, "fixed orientation of the tool, w,x,y,z");
  program.numbers("--rpy", pose.rpy, {3}, "the same as roll, pitch, yaw about fixed axes [rad]");
  program.numbers("--tool", pose.tool, {3, 7}, "pose of the tool tip in the flange frame, x,y,z[,w,x,y,z]");
  program.text("--frame", pose.frame, "frame of the path: base (DH frame 0), base_link, or one of the robot file's");
  program.numbers("--seed-joints", request.seed, {6}, "joints that the arm stands at [rad]: start from there");
  program.number("--start-tolerance", request.start_tolerance, positive,
                 "largest difference of a joint from --seed-joints at the start [rad]");
  program.path("--posture", request.posture, "demonstrations with q1..q6: keep their shoulder, elbow and wrist");
  program.flag("--given-rows", request.given_rows, "no rows between those of the input, however far apart they are");
  program.flag("--retime", request.retime, "new times: the fastest motion along the path within the limits");
  program.number("--acceleration", request.acceleration, Range<double>{JointLimits::least_rate, JointLimits::most_rate},
                 "limit of every joint's acceleration, in place of the robot file's [rad/s^2]");
  program.flag("--all", request.all, "write every distinct solution of every pose instead of a path");
  program.flag("--speeds", request.speeds, "add columns qd1..qd6 [rad/s]");
  program.flag("--accelerations", request.accelerations, "add columns qdd1..qdd6 [rad/s^2]");
  program.flag("--diagnostics", request.diagnostics, "add columns branch, residual, condition");
  program.flag("--singularities", request.singularities, "add columns manipulability, shoulder, elbow, wrist");
  declare_arm_gates(program, request.limits);
  program.gate("start", "the path starts further than --start-tolerance from --seed-joints");
  program.check([&program, &request, &pose] {
    if (program.given("--start-tolerance") && !request.seed) {
      throw UsageError("usage.missing", "--start-tolerance needs --seed-joints");
    }
    if (pose.orientation && pose.rpy) throw UsageError("usage.exclusive", "--orientation and --rpy exclude each other");
    if (request.posture == "-") throw UsageError("usage.posture", "--posture takes a file, not standard input");
    if (request.retime && request.limits.tcp_acceleration) {
      throw UsageError("usage.exclusive",
                       "--retime keeps no limit of the tool tip's acceleration, so it excludes --max-tcp-acceleration");
    }
    if (request.all && (request.retime || !request.posture.empty())) {
      throw UsageError("usage.exclusive", "--all writes solutions, not a path that --retime or --posture could shape");
    }
    if (request.all) {
      for (const char* other : {"--speeds", "--accelerations", "--given-rows"}) {
        if (program.given(other)) {
          throw UsageError("usage.exclusive",
                           fmt::format("--all writes solutions, not a path, so it excludes {}", other));
        }
      }
    }
    (void)fixed_orientation(pose);
    (void)tool_pose(pose);
  });
  program.example("skill-generate skill.json --goals goals.csv | ur10-ik --rpy 3.1416,0,0", "a tool that points down");
  program.example("ur10-ik --rpy -1.5708,0,0 --robot ur10e --tool 0,0,0.15 --diagnostics motions.csv",
                  "with a peg of 15 cm");
  program.example("ur10-ik --rpy -1.5708,0,0 --posture joints.csv motions.csv",
                  "in the posture that these joints keep");
}

}  // namespace lfd::cli
