// An arm as fixed transforms between its joints, as calibrations and URDF have it, and the Denavit-Hartenberg rows that
// say the same.
#pragma once

#include <array>

#include "lfdtools/dh.hpp"

namespace lfd {

/// Six joints that turn about the z axes of their frames.
struct JointChain {
  std::array<Pose, 6> origins;  ///< of each joint, at angle 0, in the frame that turns with the joint before
  Pose flange;                  ///< in the frame that turns with the last joint
};

/// Pose of the flange: origin_1 Rz(q1) ... origin_6 Rz(q6) flange. @param q  [rad]
[[nodiscard]] Pose forward_kinematics(const JointChain& chain, const Joints& q);

/// Rows and the place of their frame 0.
struct DhForm {
  std::array<DhRow, 6> rows;
  Pose base;  ///< DH frame 0 in the frame that the chain begins in: the same where joint 1 turns about that frame's z
};

/// The rows of a chain: common normals of its joint axes, of two parallel ones that through the frame before. x axes
/// are chosen so that no theta is over a right angle; angles within 3e-10 rad of a multiple of it, and lengths within
/// 1e-10 m of 0, are that, so that a nominal arm written with ten digits has the exact pattern. The poses agree to
/// 1e-9 unless two axes are parallel but for 1e-9 to 1e-7 rad: there rows cannot hold more than some 1e-8.
/// @throws ConfigError [robot.not_dh] if the flange is not reached by a row: its x axis must meet the last joint's axis
///         at a right angle
[[nodiscard]] DhForm dh_form(const JointChain& chain);

}  // namespace lfd
