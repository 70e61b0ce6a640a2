// Forward kinematics: the path of the tool tip, with its orientation, from a joint path.
#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/poses.hpp"
#include "lfdtools/io/robot_file.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> pose_names = {"x", "y", "z", "qw", "qx", "qy", "qz"};

/// Every row for itself, as those of `ur10-ik --all`, where several solutions stand at one time: no path, so times need
/// not rise and signs of quaternions not go on.
template <class PoseOf>
void write_solutions(const CsvTable& table, PoseOf pose_of, Output& output) {
  const std::vector<std::string> before{"t", "solution"}, read = joined(before, joint_columns());
  LabelledTable out(output, joined(before, pose_names));
  for (std::size_t i = 0; i < table.groups().size(); ++i) {
    const Samples values = table.read_group(i, read).values;
    Samples rows(values.rows(), 9);
    for (Eigen::Index k = 0; k < values.rows(); ++k) {
      const Pose tip = pose_of(Joints(values.row(k).tail<6>().transpose()));
      rows.row(k) << values.row(k).head<2>(), tip.position.transpose(),
          quaternion_from_rotation(tip.rotation).transpose();
    }
    out.write(table.groups()[i].labels, rows);
  }
}

}  // namespace

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
    const auto pose_of = [&](const Joints& q) { return base_in_frame * forward_kinematics(robot, q) * tool; };
    CsvTable input(run.open(), run.messages());
    if (input.has("solution")) {
      write_solutions(input, pose_of, run.output());
      return;
    }
    const DemonstrationSource source(std::move(input), run.messages(),
                                     {.columns = joint_columns(), .extras = {}, .min_samples = 1});
    LabelledTable table(run.output(), joined({"t"}, pose_names));
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
      const Trajectory& path = recording.demonstration.trajectory;
      Samples rows(path.samples(), 8);
      Quaternion previous = Quaternion::Unit(0);
      for (Eigen::Index k = 0; k < path.samples(); ++k) {
        const Pose tip = pose_of(Joints(path.positions.row(k).transpose()));
        const Quaternion orientation = quaternion_from_rotation(tip.rotation);
        previous = k == 0 ? orientation : same_sign(previous, orientation);
        rows.row(k) << path.times[k], tip.position.transpose(), previous.transpose();
      }
      table.write(recording.demonstration.labels, rows);
    }
  });
}
