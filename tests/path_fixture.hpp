// Hand paths to solve: those of given joints, and the hand that points down.
#pragma once

#include <numbers>
#include <vector>

#include "lfdtools/path.hpp"

namespace lfd {

/// The hand pointing straight down.
inline const Matrix3 down = rotation_from_rpy(Vector3(std::numbers::pi, 0.0, 0.0));

inline std::vector<Pose> poses_of(const Robot& robot, const Samples& joints) {
  std::vector<Pose> poses;
  for (Eigen::Index t = 0; t < joints.rows(); ++t)
    poses.push_back(forward_kinematics(robot, joints.row(t).transpose()));
  return poses;
}

}  // namespace lfd
