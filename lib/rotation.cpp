#include "lfdtools/rotation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd {

PoseDistance distance(const Pose& a, const Pose& b) {
  // |Ra - Rb|_F = 2 sqrt(2) sin(angle / 2): keeps its digits at small angles, where acos of the trace has none.
  const double half_sine = (a.rotation - b.rotation).norm() / (2.0 * std::sqrt(2.0));
  return {(a.position - b.position).norm(), 2.0 * std::asin(std::min(1.0, half_sine))};
}

Pose interpolate(const Pose& from, const Pose& to, double s) {
  const Vector3 turn = vector_from_rotation(from.rotation.transpose() * to.rotation);
  return {from.rotation * rotation_from_vector(s * turn), from.position + s * (to.position - from.position)};
}

bool is_rigid(const Pose& pose, double tolerance) {
  const Matrix3& R = pose.rotation;
  if (!R.allFinite() || !pose.position.allFinite()) return false;
  const Matrix3 excess = R.transpose() * R - Matrix3::Identity();
  return excess.cwiseAbs().maxCoeff() <= tolerance && R.col(0).cross(R.col(1)).dot(R.col(2)) > 0.0;
}

Quaternion normalized(const Quaternion& q) {
  const double norm = q.norm();
  if (!q.allFinite() || !(std::abs(norm - 1.0) <= 0.01)) {
    throw DataError("rotation.not_unit", "an orientation is not a unit quaternion");
  }
  return q / norm;
}

Matrix3 rotation_from_quaternion(const Quaternion& q) {
  const Quaternion u = normalized(q);
  const double w = u[0], x = u[1], y = u[2], z = u[3];
  Matrix3 R;
  R << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
      2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),   //
      2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y);
  return R;
}

Quaternion quaternion_from_rotation(const Matrix3& R) {
  // 4 q q^T has these diagonal entries; dividing its row by the largest keeps every digit (Shepperd 1978).
  const double diagonal[4] = {1.0 + R(0, 0) + R(1, 1) + R(2, 2), 1.0 + R(0, 0) - R(1, 1) - R(2, 2),
                              1.0 - R(0, 0) + R(1, 1) - R(2, 2), 1.0 - R(0, 0) - R(1, 1) + R(2, 2)};
  const double wx = R(2, 1) - R(1, 2), wy = R(0, 2) - R(2, 0), wz = R(1, 0) - R(0, 1);
  const double xy = R(1, 0) + R(0, 1), xz = R(0, 2) + R(2, 0), yz = R(2, 1) + R(1, 2);
  Quaternion q;
  switch (std::max_element(diagonal, diagonal + 4) - diagonal) {
    case 0:
      q << diagonal[0], wx, wy, wz;
      break;
    case 1:
      q << wx, diagonal[1], xy, xz;
      break;
    case 2:
      q << wy, xy, diagonal[2], yz;
      break;
    default:
      q << wz, xz, yz, diagonal[3];
      break;
  }
  q.normalize();
  for (int i = 0; i < 4; ++i) {
    if (q[i] == 0.0) continue;
    return q[i] > 0.0 ? q : Quaternion(-q);
  }
  return q;
}

Quaternion same_sign(const Quaternion& previous, const Quaternion& q) {
  return previous.dot(q) < 0.0 ? Quaternion(-q) : q;
}

Matrix3 rotation_from_rpy(const Vector3& rpy) {
  if (!rpy.allFinite()) throw DataError("rotation.not_finite", "an angle is not a finite number");
  const double sr = std::sin(rpy[0]), cr = std::cos(rpy[0]), sp = std::sin(rpy[1]), cp = std::cos(rpy[1]),
               sy = std::sin(rpy[2]), cy = std::cos(rpy[2]);
  Matrix3 R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return R;
}

Vector3 rpy_from_rotation(const Matrix3& R) {
  const double cosine = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cosine);
  // Under this only rounding would tell roll from yaw.
  if (cosine < 1e-12) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Matrix3 rotation_about_z(double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  Matrix3 R;
  R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return R;
}

Matrix3 rotation_from_vector(const Vector3& v) {
  const double half = 0.5 * v.norm();
  // sin(half) / (2 half) -> 1/2 by continuity; its series is exact to rounding under 1e-4.
  const double factor = half < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : 0.5 * std::sin(half) / half;
  Quaternion q;
  q << std::cos(half), factor * v;
  return rotation_from_quaternion(q);
}

Vector3 vector_from_rotation(const Matrix3& R) {
  const Quaternion q = quaternion_from_rotation(R);
  const Vector3 axis = q.tail<3>();
  const double sine = axis.norm();
  if (sine < 1e-9) return 2.0 * axis;
  return axis * (2.0 * std::atan2(sine, q[0]) / sine);
}

}  // namespace lfd
