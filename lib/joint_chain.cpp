#include "lfdtools/joint_chain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr double right_angle = std::numbers::pi / 2.0;
constexpr double parallel = 3e-8;        // sine between axes whose common normal would be too far away
constexpr double angle_digits = 3e-10;   // [rad]
constexpr double length_digits = 1e-10;  // [m]

double signed_angle(const Vector3& from, const Vector3& to, const Vector3& about) {
  return std::atan2(from.cross(to).dot(about), from.dot(to));
}

/// The shortest turn that takes the z axis to a direction.
Matrix3 tilt_to(const Vector3& z) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), z).toRotationMatrix();
}

double rounded_angle(double angle) {
  const double whole = right_angle * std::nearbyint(angle / right_angle);
  return std::abs(angle - whole) < angle_digits ? whole : angle;
}

double rounded_length(double length) {
  return std::abs(length) < length_digits ? 0.0 : length;
}

Pose pose_of(const DhForm& form, const Joints& q) {
  Robot robot;
  robot.dh = form.rows;
  return form.base * forward_kinematics(robot, q);
}

/// The rows rounded, if the poses stay within 1e-9 of the chain's.
DhForm rounded(const JointChain& chain, const DhForm& form) {
  DhForm round = form;
  for (DhRow& row : round.rows) {
    row = {rounded_length(row.a), rounded_angle(row.alpha), rounded_length(row.d), rounded_angle(row.theta)};
  }
  for (int k = 0; k < 64; ++k) {
    Joints q;  // spread over all angles
    for (int j = 0; j < 6; ++j) q[j] = std::remainder(0.7 + 1.9 * k * (j + 1) + j, 2.0 * std::numbers::pi);
    if (distance(pose_of(round, q), forward_kinematics(chain, q)).largest() > 9e-10) return form;
  }
  return round;
}

}  // namespace

Pose forward_kinematics(const JointChain& chain, const Joints& q) {
  Pose pose;
  for (std::size_t i = 0; i < 6; ++i) {
    pose = pose * chain.origins[i] * Pose{rotation_about_z(q[static_cast<Eigen::Index>(i)]), Vector3::Zero()};
  }
  return pose * chain.flange;
}

DhForm dh_form(const JointChain& chain) {
  std::array<Pose, 6> joints;  // at q = 0
  for (std::size_t i = 0; i < 6; ++i) joints[i] = (i == 0 ? Pose{} : joints[i - 1]) * chain.origins[i];
  DhForm form;
  const Vector3 first = joints[0].rotation.col(2);
  if (std::hypot(first.x(), first.y()) > angle_digits || first.z() < 0.0) form.base.rotation = tilt_to(first);
  form.base.position = joints[0].position - joints[0].position.dot(first) * first;
  form.base.position = form.base.position.unaryExpr(&rounded_length);

  Vector3 origin = form.base.position, x = form.base.rotation.col(0);
  for (std::size_t i = 0; i < 5; ++i) {
    const Vector3 z = joints[i].rotation.col(2), next_z = joints[i + 1].rotation.col(2);
    const Vector3 p = joints[i].position, next_p = joints[i + 1].position;
    const Vector3 normal = z.cross(next_z);
    const auto onto_next = [&](const Vector3& point) {
      return (next_p + (point - next_p).dot(next_z) * next_z).eval();
    };
    Vector3 here = origin, next_x = x;
    if (normal.norm() > parallel) {
      here = p + (next_p - p).cross(next_z).dot(normal) / normal.squaredNorm() * z;
      next_x = normal.normalized();
    } else if (const Vector3 across = onto_next(origin) - origin; across.norm() > length_digits) {
      next_x = (across - across.dot(z) * z).normalized();
    }
    if (next_x.dot(x) < 0.0) next_x = -next_x;
    // By projection, not as the other end of the normal: what rounding moves along axes that are nearly parallel then
    // hardly matters.
    const Vector3 next = onto_next(here);
    form.rows[i] = {(next - here).dot(next_x), signed_angle(z, next_z, next_x), (here - origin).dot(z),
                    signed_angle(x, next_x, z)};
    origin = next;
    x = next_x;
  }
  const Vector3 z = joints[5].rotation.col(2);
  Pose last;
  last.rotation << x, z.cross(x), z;
  last.position = origin;
  const Pose rest = inverse(last) * (joints[5] * chain.flange);
  const double theta = std::atan2(rest.rotation(1, 0), rest.rotation(0, 0));
  const double a = rest.position.x() * std::cos(theta) + rest.position.y() * std::sin(theta);
  form.rows[5] = {a, std::atan2(rest.rotation(2, 1), rest.rotation(2, 2)), rest.position.z(), theta};
  const double aside = rest.position.y() * std::cos(theta) - rest.position.x() * std::sin(theta);
  if (std::abs(rest.rotation(2, 0)) > 1e-9 || std::abs(aside) > 1e-9) {
    throw ConfigError("robot.not_dh", "the x axis of the flange does not meet the last joint's axis at a right angle");
  }
  return rounded(chain, form);
}

}  // namespace lfd
