// The posture that demonstrations keep: shoulder, elbow and wrist, as a branch of the inverse kinematics.
#pragma once

#include <cstddef>
#include <vector>

#include "lfdtools/ur10.hpp"

namespace lfd {

/// What recorded joints say about the posture.
struct DemonstratedPosture {
  int branch = 0;             ///< see branch_name: that of most demonstrations, of equally many the lower number
  std::vector<int> branches;  ///< of each demonstration: that of most of its samples
  std::vector<Eigen::Index> samples_elsewhere;  ///< of each demonstration: samples in another branch than its own
  std::vector<Eigen::Index> samples_singular;   ///< of each demonstration: samples near a singularity
  std::size_t elsewhere = 0;                    ///< demonstrations in another branch than `branch`
};

/// A sample counts as near a singularity, where noise may turn the branch, within 5 mm of the shoulder's or the elbow's
/// and |sin q5| < 0.05 of the wrist's. It has no vote unless all samples of its demonstration are such.
/// @param demonstrations  at least one, each T x 6 joints, T >= 1 [rad]
/// @throws DataError [posture.shape]
[[nodiscard]] DemonstratedPosture demonstrated_posture(const InverseKinematics& arm,
                                                       const std::vector<Samples>& demonstrations);

/// The bits of the branch, see branch_name, that joints are on the border of: there rounding decides on them.
[[nodiscard]] int border_bits(const InverseKinematics& arm, const Joints& q);

/// Whether joints are in a branch or on its border: there both sides are it (a stretched elbow is bent neither way).
[[nodiscard]] bool keeps_branch(const InverseKinematics& arm, const Joints& q, int branch);

/// The branch of each row of a path; on a border that of the row before, at the start that of the first row beyond it.
/// @param joints  T x 6 [rad]
[[nodiscard]] std::vector<int> branches_along(const InverseKinematics& arm, const Samples& joints);

}  // namespace lfd
