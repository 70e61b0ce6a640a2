#include "lfdtools/dh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr double right_angle = std::numbers::pi / 2;
// std::cos of it, which is not quite it.
constexpr double cosine_of_right_angle = 6.123233995736766e-17;

}  // namespace

void check(const Robot& robot) {
  bool finite = robot.limits.position.allFinite() && robot.limits.velocity.allFinite() &&
                (!robot.limits.acceleration || robot.limits.acceleration->allFinite());
  for (const DhRow& row : robot.dh) {
    finite =
        finite && std::isfinite(row.a) && std::isfinite(row.alpha) && std::isfinite(row.d) && std::isfinite(row.theta);
  }
  for (const Capsule& link : robot.links) {
    finite = finite && link.from.allFinite() && link.to.allFinite() && std::isfinite(link.radius);
  }
  if (!finite) throw ConfigError("robot.not_finite", "the robot has a value that is not a finite number");
  for (int j = 0; j < 6; ++j) {
    if (!(robot.limits.position(j, 0) < robot.limits.position(j, 1))) {
      throw ConfigError("robot.limits", fmt::format("the range of joint {} is empty", j + 1));
    }
    if (!(robot.limits.velocity[j] > 0.0) || (robot.limits.acceleration && !((*robot.limits.acceleration)[j] > 0.0))) {
      throw ConfigError("robot.limits",
                        fmt::format("a speed or acceleration limit of joint {} is not positive", j + 1));
    }
  }
  for (const Capsule& link : robot.links) {
    if (link.frame < 0 || link.frame > 6 || !(link.radius > 0.0)) {
      throw ConfigError("robot.link",
                        fmt::format("link \"{}\" needs a frame from 0 to 6 and a positive radius", link.name));
    }
  }
  for (const auto& [name, pose] : robot.frames) {
    if (!is_rigid(pose))
      throw ConfigError("robot.frame", fmt::format("the pose of frame \"{}\" is no rigid motion", name));
  }
}

Pose frame_in_base(const Robot& robot, const std::string& name) {
  if (const auto found = robot.frames.find(name); found != robot.frames.end()) return found->second;
  if (name == "base") return {};
  if (name == "base_link") {
    Pose turned;
    turned.rotation.diagonal() << -1.0, -1.0, 1.0;  // by pi about z, without the rounding of sin(pi)
    return turned;
  }
  std::string known = "base, base_link";
  for (const auto& [frame, pose] : robot.frames) {
    if (frame != "base" && frame != "base_link") known += ", " + frame;
  }
  throw UsageError("robot.unknown_frame",
                   fmt::format("robot {} has no frame \"{}\"; there are: {}", robot.name, name, known));
}

Pose dh_transform(const DhRow& row, double q) {
  const double angle = q + row.theta;
  const double s = std::sin(angle), c = std::cos(angle);
  // Most twists are right angles or none, and their sines take as long as those of the joint.
  double sa = 0.0, ca = 1.0;
  if (std::abs(row.alpha) == right_angle) {
    sa = std::copysign(1.0, row.alpha);
    ca = cosine_of_right_angle;
  } else if (row.alpha != 0) {
    sa = std::sin(row.alpha);
    ca = std::cos(row.alpha);
  }
  Pose T;
  T.rotation << c, -s * ca, s * sa, s, c * ca, -c * sa, 0.0, sa, ca;
  T.position << row.a * c, row.a * s, row.d;
  return T;
}

Pose forward_kinematics(const Robot& robot, const Joints& q) {
  Pose T = dh_transform(robot.dh[0], q[0]);
  for (int i = 1; i < 6; ++i) T = T * dh_transform(robot.dh[static_cast<std::size_t>(i)], q[i]);
  return T;
}

std::array<Pose, 7> joint_frames(const Robot& robot, const Joints& q) {
  std::array<Pose, 7> frames;
  for (std::size_t i = 0; i < 6; ++i) {
    frames[i + 1] = frames[i] * dh_transform(robot.dh[i], q[static_cast<Eigen::Index>(i)]);
  }
  return frames;
}

Jacobian jacobian(const Robot& robot, const Joints& q, const Vector3& point) {
  const auto frames = joint_frames(robot, q);
  const Vector3 tip = frames[6].rotation * point + frames[6].position;
  Jacobian J;
  for (int i = 0; i < 6; ++i) {
    const Pose& frame = frames[static_cast<std::size_t>(i)];
    const Vector3 axis = frame.rotation.col(2);
    J.col(i) << axis.cross(tip - frame.position), axis;
  }
  return J;
}

double condition_number(const Jacobian& J) {
  const Eigen::JacobiSVD<Jacobian> svd(J);
  const auto& sigma = svd.singularValues();
  return sigma[0] < 1e16 * sigma[5] ? sigma[0] / sigma[5] : 1e16;
}

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace lfd
