// Forward kinematics: the path of the tool tip, with its orientation, from a joint path.
#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/poses.hpp"
#include "lfdtools/io/robot_file.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  PoseOptions pose;
  std::string robot_name = "ur10";
  cli::Program program("ur10-fk", "Find the path of the tool tip from a joint path.");
  program.reads("joints CSV");
  program.text("--robot", robot_name, "robot file, by name or path");
  program.numbers("--tool", pose.tool, {3, 7}, "pose of the tool tip in the flange frame, x,y,z[,w,x,y,z]");
  program.text("--frame", pose.frame, "frame of the result: base (DH frame 0), base_link, or one of the robot file's");
  program.check([&] { (void)tool_pose(pose); });
  program.example("ur10-ik --rpy 3.1416,0,0 motions.csv | ur10-fk", "back to where it came from");
  return program.run(argc, argv, [&](cli::Run& run) {
    const Robot robot = load_robot(find_data_file(robot_name, "robots"), run.messages(), run.options().strict);
    const Pose base_in_frame = inverse(frame_in_base(robot, pose.frame));
    const Pose tool = tool_pose(pose);
    CsvTable input(run.open(), run.messages());
    const bool solutions = input.has("solution");  // of ur10-ik --all: several at one time, each for itself
    const std::vector<std::string> number =
        solutions ? std::vector<std::string>{"solution"} : std::vector<std::string>{};
    const DemonstrationSource source(
        std::move(input), run.messages(),
        {.columns = joint_columns(), .extras = number, .min_samples = 1, .rising = !solutions});
    LabelledTable table(run.output(), joined(joined({"t"}, number), {"x", "y", "z", "qw", "qx", "qy", "qz"}));
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
      const Trajectory& path = recording.demonstration.trajectory;
      Samples rows(path.samples(), 7);
      Quaternion previous = Quaternion::Unit(0);
      for (Eigen::Index k = 0; k < path.samples(); ++k) {
        const Joints q = path.positions.row(k).transpose();
        const Pose tip = base_in_frame * forward_kinematics(robot, q) * tool;
        const Quaternion orientation = quaternion_from_rotation(tip.rotation);
        previous = k == 0 || solutions ? orientation : same_sign(previous, orientation);
        rows.row(k) << tip.position.transpose(), previous.transpose();
      }
      table.write(recording.demonstration.labels, beside(beside(path.times, recording.extras), rows));
    }
  });
}
