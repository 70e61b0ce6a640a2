// Joint paths along hand paths, or every inverse kinematics solution of each pose.
#include <fmt/format.h>

#include "lfdtools/cli/arm_gates.hpp"
#include "lfdtools/cli/program.hpp"
#include "lfdtools/interpolation.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/poses.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/path.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> joint_names = {"q1", "q2", "q3", "q4", "q5", "q6"};
const std::vector<std::string> speed_names = {"qd1", "qd2", "qd3", "qd4", "qd5", "qd6"};

void write_all_solutions(const InverseKinematics& arm, const Recording& recording, const std::vector<Pose>& poses,
                         LabelledTable& table, cli::Run& run) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const IkSolutions solutions = arm(poses[i]);
    if (solutions.empty()) run.messages().warning("ik.unreachable", "the pose is out of reach", recording.place(row));
    for (std::size_t k = 0; k < solutions.size(); ++k) {
      Samples cells(1, 8);
      cells << recording.demonstration.trajectory.times[row], static_cast<double>(k + 1),
          solutions[k].joints.transpose();
      table.write(recording.demonstration.labels, cells);
    }
  }
}

/// qd by the spline through the joints, so that it does not lag half a sample.
Samples joint_speeds(const Vector& times, const Samples& joints) {
  return CubicSpline(times, joints).derivative(times);
}

}  // namespace

int main(int argc, char** argv) {
  PoseOptions pose;
  PathOptions options;
  cli::ArmLimits limits;
  std::string robot_name = "ur10";
  std::optional<std::vector<double>> seed;
  bool all = false;
  bool speeds = false;
  bool diagnostics = false;
  cli::Program program("ur10-ik", "Find the joint path along a path of the tool tip.");
  program.reads("trajectory CSV with x,y,z and, unless given here, qw,qx,qy,qz");
  program.text("--robot", robot_name, "robot file, by name or path");
  program.numbers("--orientation", pose.orientation, {4}, "fixed orientation of the tool, w,x,y,z");
  program.numbers("--rpy", pose.rpy, {3}, "the same as roll, pitch, yaw about fixed axes [rad]");
  program.numbers("--tool", pose.tool, {3, 7}, "pose of the tool tip in the flange frame, x,y,z[,w,x,y,z]");
  program.text("--frame", pose.frame, "frame of the path: base (DH frame 0), base_link, or one of the robot file's");
  program.numbers("--seed-joints", seed, {6}, "joints to start near to [rad]");
  program.flag("--all", all, "write every distinct solution of every pose instead of a path");
  program.flag("--speeds", speeds, "add columns qd1..qd6 [rad/s]");
  program.flag("--diagnostics", diagnostics, "add columns branch, residual, condition");
  cli::declare_arm_gates(program, limits);
  program.check([&] {
    if (pose.orientation && pose.rpy) throw UsageError("usage.exclusive", "--orientation and --rpy exclude each other");
    (void)fixed_orientation(pose);
    (void)tool_pose(pose);
  });
  program.example("skill-generate skill.json --goals holes.csv | ur10-ik --rpy 3.1416,0,0", "a tool that points down");
  program.example("ur10-ik --robot ur10e --tool 0,0,0.15 --diagnostics motions.csv", "with a peg of 15 cm");
  return program.run(argc, argv, [&](cli::Run& run) {
    const InverseKinematics arm(load_robot(find_data_file(robot_name, "robots"), run.messages(), run.options().strict));
    (void)frame_in_base(arm.robot(), pose.frame);
    if (seed) options.seed = Eigen::Map<const Joints>(seed->data());
    CsvTable table(run.open(), run.messages());
    std::vector<std::string> extras;
    const bool fixed = pose.orientation || pose.rpy;
    const bool quaternions = !fixed && table.has("qw") && table.has("qx") && table.has("qy") && table.has("qz");
    if (!fixed && !quaternions) {
      throw UsageError("ik.no_orientation", "the path has no columns qw,qx,qy,qz: give --orientation or --rpy");
    }
    if (quaternions) extras = {"qw", "qx", "qy", "qz"};
    std::vector<std::string> passed;
    for (const auto& name : table.columns()) {
      if (name.starts_with("sd_") || name.starts_with("cov_")) passed.push_back(name);
    }
    DemonstrationSource source(std::move(table), run.messages(),
                               {.columns = {"x", "y", "z"}, .extras = joined(extras, passed), .min_samples = 1});
    auto columns = joined({"t"}, joint_names);
    if (all) columns = joined({"t", "solution"}, joint_names);
    if (!all && speeds) columns = joined(columns, speed_names);
    if (!all && diagnostics) columns = joined(columns, {"branch", "residual", "condition"});
    if (!all) columns = joined(columns, passed);
    LabelledTable out(run.output(), columns);
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
      const Vector& times = recording.demonstration.trajectory.times;
      const auto poses = flange_poses(recording, quaternions, arm.robot(), pose);
      if (all) {
        write_all_solutions(arm, recording, poses, out, run);
        continue;
      }
      const JointPath path = solve_path(arm, poses, times, options);
      if (!cli::judge(path, recording, arm.robot(), tool_pose(pose), limits, run)) continue;
      Samples rows = beside(times, path.joints);
      if (speeds) rows = beside(rows, joint_speeds(times, path.joints));
      if (diagnostics) {
        Samples figures(times.size(), 3);
        for (Eigen::Index k = 0; k < times.size(); ++k) {
          figures.row(k) << path.branch[static_cast<std::size_t>(k)], path.residual[k], path.condition[k];
        }
        rows = beside(rows, figures);
      }
      if (!passed.empty()) rows = beside(rows, recording.extras.rightCols(static_cast<Eigen::Index>(passed.size())));
      out.write(recording.demonstration.labels, rows);
    }
  });
}
