// The closed-form skeleton of a UR arm: six lengths and the zero offsets of its joints.
#pragma once

#include <string>

#include "lfdtools/dh.hpp"

namespace lfd {

/// An arm whose joints 2, 3, 4 are exactly parallel and 1, 2 and 4, 5, 6 exactly at right angles
/// (alpha = pi/2, 0, 0, pi/2, -pi/2, 0). Its angles are q + offset.
struct UrGeometry {
  double d1 = 0.0;                 ///< [m]
  double a2 = 0.0;                 ///< [m]
  double a3 = 0.0;                 ///< [m]
  double d4 = 0.0;                 ///< [m]
  double d5 = 0.0;                 ///< [m]
  double d6 = 0.0;                 ///< [m]
  Joints offset = Joints::Zero();  ///< [rad]
  bool exact = true;               ///< false: the robot is calibrated and this is only near it
};

/// The geometry of a UR arm. An uncalibrated robot (nothing but d1, a2, a3, d4, d5, d6 and theta differs from the
/// pattern) is taken as it is. For a calibrated one the lengths are measured between the joint axes at q = 0, because
/// its DH rows themselves say little: the common normal of two axes that are parallel but for a milliradian lies
/// hundreds of metres away, and d, a and theta with it.
/// @throws ConfigError [ur10.not_a_ur] if the axes are not near the pattern (0.1 rad), or a2 or a3 is under 1 mm
[[nodiscard]] UrGeometry ur_geometry(const Robot& robot);

/// Why a pose of the flange has no solution, for people: how far its wrist, where axes 5 and 6 meet, is beyond the
/// stretched arm or too near to the base's axis, or that the orientation is to blame. Of a calibrated arm to
/// millimetres.
[[nodiscard]] std::string out_of_reach_words(const UrGeometry& g, const Pose& flange);

/// UR10 (CB3), as in the paper: +-360 deg, 120 deg/s for joints 1 and 2, 180 deg/s for the others; no link bodies.
[[nodiscard]] Robot nominal_ur10();
/// UR10e, limits as above.
[[nodiscard]] Robot nominal_ur10e();

}  // namespace lfd
