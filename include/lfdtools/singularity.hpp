// How near a UR arm is to the configurations in which its hand cannot move every way.
#pragma once

#include <string>

#include "lfdtools/ur_geometry.hpp"

namespace lfd {

/// Manipulability sqrt(det(J J^T)) of Yoshikawa (1985), for six joints |det J| [m^3]. Of a UR arm it is
/// |a2 a3 sin q3 sin q5 X|, X being how far the wrist centre lies in front of the shoulder: no factor is zero but in
/// one of the three singularities.
[[nodiscard]] double manipulability(const Jacobian& J);

/// How far the joints are from each singularity, 0 in it.
struct SingularityDistances {
  double shoulder = 0.0;  ///< distance of the wrist centre from the base axis less the smallest there is, |d4| [m]
  double elbow = 0.0;     ///< distance of joint 4 from the nearer end of its range, arm stretched or folded [m]
  double wrist = 0.0;     ///< |sin q5|
};

/// @param geometry  for a calibrated robot the nearest exact arm, and the distances are those of that arm
[[nodiscard]] SingularityDistances singularity_distances(const UrGeometry& geometry, const Joints& q);

/// The nearest singularity in words, such as "the wrist singularity (|sin q5| = 0.0013)"; empty where none is within
/// 0.1 (m, or of |sin q5|).
[[nodiscard]] std::string nearest_singularity(const SingularityDistances& distances);

}  // namespace lfd
