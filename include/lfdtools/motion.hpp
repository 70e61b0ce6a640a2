// What a joint path asks of the arm: ranges, speeds, accelerations, conditioning. Computed here, judged by the
// programs.
#pragma once

#include "lfdtools/dh.hpp"

namespace lfd {

/// Figures of a joint path of T samples. Interval figures belong to the interval that ends at the sample; sample 0 has
/// 0.
struct MotionFigures {
  Samples range_excess;       ///< T x 6: how far outside the joint range, 0 inside [rad]
  Samples step;               ///< T x 6: |change| of each joint since the sample before [rad]
  Samples speed;              ///< T x 6: step over the time it takes [rad/s]
  Samples acceleration;       ///< T x 6: |second difference| at inner samples, 0 at both ends [rad/s^2]
  Vector speed_ratio;         ///< T: largest speed over its joint's limit
  Vector acceleration_ratio;  ///< T: largest acceleration over its joint's limit; 0 where the robot states no limit
  Vector tcp_speed;           ///< T: chord of the tool tip over its time [m/s]
  Vector tcp_acceleration;    ///< T: |second difference| of the tool tip at inner samples [m/s^2]
  Vector condition;           ///< T: condition number of the flange Jacobian
};

/// @param times   T >= 1, strictly rising [s]
/// @param joints  T x 6 [rad]
/// @param tool    pose of the tool tip in the flange frame
/// @throws DataError [motion.shape], [motion.not_finite], [motion.time_not_rising]
[[nodiscard]] MotionFigures motion_figures(const Robot& robot, const Vector& times, const Samples& joints,
                                           const Pose& tool = {});

/// The largest value of a figure and the sample where it stands.
struct Worst {
  double value = 0.0;
  Eigen::Index sample = 0;
};
[[nodiscard]] Worst worst(const Vector& figure);
/// The largest over all joints.
[[nodiscard]] Worst worst(const Samples& figure);

}  // namespace lfd
