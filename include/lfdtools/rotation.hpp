// Rotations and poses: quaternions, fixed-axis angles, composition, distance and interpolation.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
/// Orientation in the order (w, x, y, z). q and -q are the same orientation.
using Quaternion = Eigen::Matrix<double, 4, 1>;

/// Position and orientation of one frame in another: x_outer = rotation * x_inner + position.
struct Pose {
  Matrix3 rotation = Matrix3::Identity();
  Vector3 position = Vector3::Zero();  ///< [m]
};

/// A distance between poses.
struct PoseDistance {
  double position = 0.0;  ///< [m]
  double rotation = 0.0;  ///< angle of the rotation between them, 0..pi [rad]

  /// The larger of metres and radians: the residual of the joints CSV.
  [[nodiscard]] double largest() const { return position > rotation ? position : rotation; }
};

/// The frame `inner`, given in `outer`'s own frame, seen from outside.
[[nodiscard]] inline Pose operator*(const Pose& outer, const Pose& inner) {
  return {outer.rotation * inner.rotation, outer.rotation * inner.position + outer.position};
}

[[nodiscard]] inline Pose inverse(const Pose& pose) {
  return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.position)};
}

[[nodiscard]] PoseDistance distance(const Pose& a, const Pose& b);

/// The pose at the share s in [0, 1] of the way: straight in position, about one fixed axis in orientation (the shorter
/// way round).
[[nodiscard]] Pose interpolate(const Pose& from, const Pose& to, double s);

/// True if the pose is finite and its rotation orthonormal and right-handed within `tolerance` a matrix entry.
[[nodiscard]] bool is_rigid(const Pose& pose, double tolerance = 1e-9);

/// The unit quaternion along q.
/// @throws DataError [rotation.not_unit] if q is not finite or its length is off 1 by more than 1 %: that is no
/// rounding
[[nodiscard]] Quaternion normalized(const Quaternion& q);

/// @param q  (w, x, y, z), normalised here
/// @throws DataError as normalized
[[nodiscard]] Matrix3 rotation_from_quaternion(const Quaternion& q);

/// @return (w, x, y, z), unit length, the first component that is not zero being positive
[[nodiscard]] Quaternion quaternion_from_rotation(const Matrix3& R);

/// q or -q, whichever is nearer to `previous`: a series written with it has no sign flips.
[[nodiscard]] Quaternion same_sign(const Quaternion& previous, const Quaternion& q);

/// Roll, pitch and yaw about fixed axes [rad]: R = Rz(yaw) Ry(pitch) Rx(roll).
/// @throws DataError [rotation.not_finite]
[[nodiscard]] Matrix3 rotation_from_rpy(const Vector3& rpy);

/// The inverse of rotation_from_rpy: pitch in [-pi/2, pi/2], the others in (-pi, pi]. Where the pitch is +-pi/2 only
/// one combination of roll and yaw is determined: roll is 0.
[[nodiscard]] Vector3 rpy_from_rotation(const Matrix3& R);

/// Turn by `angle` [rad] about z.
[[nodiscard]] Matrix3 rotation_about_z(double angle);

/// Rotation vector (axis times angle, 0..pi) [rad], as UR controllers write orientations.
[[nodiscard]] Matrix3 rotation_from_vector(const Vector3& v);
[[nodiscard]] Vector3 vector_from_rotation(const Matrix3& R);

}  // namespace lfd
