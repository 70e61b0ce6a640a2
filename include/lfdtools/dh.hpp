// Six-joint arms in standard Denavit-Hartenberg form: description, forward kinematics, Jacobian.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/rotation.hpp"

namespace lfd {

/// One value a joint: angles [rad], or what a sentence says.
using Joints = Eigen::Matrix<double, 6, 1>;
/// Rows: linear velocity [m/rad], then angular [rad/rad], in the base frame; columns: joints.
using Jacobian = Eigen::Matrix<double, 6, 6>;

/// One row of the standard convention: T = Rz(q + theta) Tz(d) Tx(a) Rx(alpha).
struct DhRow {
  double a = 0.0;      ///< [m]
  double alpha = 0.0;  ///< [rad]
  double d = 0.0;      ///< [m]
  double theta = 0.0;  ///< zero offset of the joint [rad]
};

/// What the joints may do.
struct JointLimits {
  static constexpr double least_rate = 1e-6, most_rate = 1e6;  ///< of a velocity or acceleration that a file may have

  Eigen::Matrix<double, 6, 2> position = Eigen::Matrix<double, 6, 2>::Zero();  ///< lower, upper [rad]
  Joints velocity = Joints::Zero();                                            ///< [rad/s]
  std::optional<Joints> acceleration;                                          ///< [rad/s^2], where the file has it
};

/// A piece of the arm's body: all points within `radius` of a line segment that moves with a DH frame.
struct Capsule {
  std::string name;
  int frame = 0;                   ///< 0 (base) .. 6 (flange)
  Vector3 from = Vector3::Zero();  ///< in that frame [m]
  Vector3 to = Vector3::Zero();    ///< in that frame [m]
  double radius = 0.0;             ///< [m]
};

/// A six-joint arm, as `lfdtools.robot` files describe it.
struct Robot {
  std::string name;
  std::array<DhRow, 6> dh;
  JointLimits limits;
  std::vector<Capsule> links;
  std::map<std::string, Pose> frames;  ///< named fixed frames, each as its pose in DH frame 0 ("base")
};

/// @throws ConfigError [robot.not_finite], [robot.limits] (lower not below upper, velocity or acceleration not
/// positive),
///         [robot.link] (frame outside 0..6, radius not positive), [robot.frame] (a pose that is no rigid motion)
void check(const Robot& robot);

/// Pose of a named frame in DH frame 0: "base" is that frame itself, "base_link" (ROS) is turned by pi about z unless
/// the robot says otherwise.
/// @throws UsageError [robot.unknown_frame]
[[nodiscard]] Pose frame_in_base(const Robot& robot, const std::string& name);

/// Pose of frame i in frame i-1 at joint angle q.
[[nodiscard]] Pose dh_transform(const DhRow& row, double q);

/// Pose of the flange (frame 6) in the base (frame 0). @param q  [rad]
[[nodiscard]] Pose forward_kinematics(const Robot& robot, const Joints& q);

/// Poses of the frames 0..6 in the base.
[[nodiscard]] std::array<Pose, 7> joint_frames(const Robot& robot, const Joints& q);

/// Geometric Jacobian of a point fixed in the flange frame.
/// @param point  in the flange frame [m]
[[nodiscard]] Jacobian jacobian(const Robot& robot, const Joints& q, const Vector3& point = Vector3::Zero());

/// Largest over smallest singular value, with the linear rows divided by 1 m and the angular rows in rad; at most 1e16,
/// which stands for singular.
[[nodiscard]] double condition_number(const Jacobian& J);

/// The angle in (-pi, pi] that differs from `angle` by whole turns.
[[nodiscard]] double wrap_angle(double angle);

}  // namespace lfd
