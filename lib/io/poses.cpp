#include "lfdtools/io/poses.hpp"

namespace lfd {
namespace {

Matrix3 rotation_of(const char* option, const double* w) {
  try {
    return rotation_from_quaternion(Eigen::Map<const Quaternion>(w));
  } catch (const DataError& error) {
    throw DataError(error.id(), std::string(option) + ": " + error.what());
  }
}

}  // namespace

Pose tool_pose(const PoseOptions& options) {
  Pose tool;
  if (!options.tool) return tool;
  tool.position = Eigen::Map<const Vector3>(options.tool->data());
  if (options.tool->size() == 7) tool.rotation = rotation_of("--tool", options.tool->data() + 3);
  return tool;
}

std::optional<Matrix3> fixed_orientation(const PoseOptions& options) {
  if (options.orientation) return rotation_of("--orientation", options.orientation->data());
  if (options.rpy) return rotation_from_rpy(Eigen::Map<const Vector3>(options.rpy->data()));
  return {};
}

std::vector<Pose> flange_poses(const Recording& recording, bool with_quaternions, const Robot& robot,
                               const PoseOptions& options) {
  const Pose frame = frame_in_base(robot, options.frame);
  const Pose flange_in_tool = inverse(tool_pose(options));
  const auto fixed = fixed_orientation(options);
  const Trajectory& trajectory = recording.demonstration.trajectory;
  std::vector<Pose> poses(static_cast<std::size_t>(trajectory.samples()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Pose tip;
    tip.position = trajectory.positions.row(row).transpose();
    if (fixed) tip.rotation = *fixed;
    if (!fixed && with_quaternions) {
      const Quaternion q = recording.extras.row(row).head(4).transpose();
      try {
        tip.rotation = rotation_from_quaternion(q);
      } catch (const DataError& error) {
        throw DataError(error.id(), error.what(), recording.place(row));
      }
    }
    poses[i] = frame * tip * flange_in_tool;
  }
  return poses;
}

}  // namespace lfd
