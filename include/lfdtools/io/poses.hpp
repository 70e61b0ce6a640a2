// Poses of the flange from rows of a trajectory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/dh.hpp"
#include "lfdtools/io/demonstrations.hpp"

namespace lfd {

/// What turns positions of the tool tip into poses of the flange.
struct PoseOptions {
  std::optional<std::vector<double>> orientation;  ///< of the tool, w,x,y,z; for rows without columns qw..qz
  std::optional<std::vector<double>> rpy;          ///< the same, roll, pitch, yaw about fixed axes [rad]
  std::optional<std::vector<double>> tool;         ///< pose of the tool tip in the flange frame: x,y,z[,w,x,y,z]
  std::string frame = "base";  ///< frame of the rows: base (DH frame 0), base_link, or the robot's own
};

/// Pose of the tool tip in the flange frame. @throws DataError [rotation.not_unit]
[[nodiscard]] Pose tool_pose(const PoseOptions& options);

/// The fixed orientation of the options. @throws DataError [rotation.not_unit]
[[nodiscard]] std::optional<Matrix3> fixed_orientation(const PoseOptions& options);

/// Poses of the flange in DH frame 0. The signals are x, y, z; columns qw..qz, where the recording has them as its
/// first four extras, are the orientation of each row.
[[nodiscard]] std::vector<Pose> flange_poses(const Recording& recording, bool with_quaternions, const Robot& robot,
                                             const PoseOptions& options);

}  // namespace lfd
