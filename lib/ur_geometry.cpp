#include "lfdtools/ur_geometry.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr double right_angle = std::numbers::pi / 2.0;
constexpr std::array<double, 6> ur_alpha = {right_angle, 0.0, 0.0, right_angle, -right_angle, 0.0};

struct Line {
  Vector3 point;
  Vector3 direction;  // unit
};

/// The axis of joint i + 1: z of frame i.
Line axis(const std::array<Pose, 7>& frames, std::size_t i) {
  return {frames[i].position, frames[i].rotation.col(2)};
}

/// The point of `line` nearest to `other`, two lines that are not parallel.
Vector3 foot(const Line& line, const Line& other) {
  const Vector3 normal = line.direction.cross(other.direction);
  const double t = (other.point - line.point).cross(other.direction).dot(normal) / normal.squaredNorm();
  return line.point + t * line.direction;
}

/// The point of `line` in the plane through `point` across `normal`.
Vector3 in_plane(const Line& line, const Vector3& point, const Vector3& normal) {
  const double t = (point - line.point).dot(normal) / line.direction.dot(normal);
  return line.point + t * line.direction;
}

void check_lengths(const UrGeometry& g) {
  if (std::abs(g.a2) > 1e-3 && std::abs(g.a3) > 1e-3) return;
  throw ConfigError("ur10.not_a_ur", "the upper arm or the forearm has no length");
}

/// Lengths and zero offsets between the joint axes of a calibrated arm, at q = 0.
UrGeometry measured(const Robot& robot) {
  const auto frames = joint_frames(robot, Joints::Zero());
  const Line L1 = axis(frames, 0), L2 = axis(frames, 1), L3 = axis(frames, 2), L4 = axis(frames, 3),
             L5 = axis(frames, 4), L6 = axis(frames, 5);
  const auto across = [](const Line& a, const Line& b) { return std::abs(a.direction.dot(b.direction)) < 0.1; };
  const auto parallel = [](const Line& a, const Line& b) { return a.direction.dot(b.direction) > 0.995; };
  if (!across(L1, L2) || !parallel(L2, L3) || !parallel(L3, L4) || !across(L4, L5) || !across(L5, L6)) {
    throw ConfigError("ur10.not_a_ur", "the joint axes are not arranged as those of a ur arm");
  }

  UrGeometry g;
  g.exact = false;
  // Frame 1 of the exact arm: x level, y up, z along joint 2.
  g.offset[0] = std::atan2(L2.direction.x(), -L2.direction.y());
  const double s1 = std::sin(g.offset[0]), c1 = std::cos(g.offset[0]);
  const Vector3 x1(c1, s1, 0.0), y1(0.0, 0.0, 1.0), z1(s1, -c1, 0.0);
  const Vector3 P2 = foot(L2, L1);
  const Vector3 P3 = in_plane(L3, P2, z1);
  const Vector3 P4 = in_plane(L4, P2, z1);
  g.d1 = P2.z();
  // The signs that make the offsets small; the rows' own a may have either, common normals point anywhere.
  g.a2 = std::copysign((P3 - P2).norm(), (P3 - P2).dot(x1));
  g.a3 = std::copysign((P4 - P3).norm(), (P4 - P3).dot(x1));
  check_lengths(g);
  const double q2 = std::atan2((P3 - P2).dot(y1) / g.a2, (P3 - P2).dot(x1) / g.a2);
  const double q23 = std::atan2((P4 - P3).dot(y1) / g.a3, (P4 - P3).dot(x1) / g.a3);
  const Vector3& z4 = L5.direction;
  const double q234 = std::atan2(z4.dot(x1), -z4.dot(y1));
  g.offset[1] = q2;
  g.offset[2] = wrap_angle(q23 - q2);
  g.offset[3] = wrap_angle(q234 - q23);
  g.d4 = (foot(L4, L5) - P2).dot(z1);
  g.d5 = (foot(L5, L6) - foot(L5, L4)).dot(z4);
  g.d6 = (frames[6].position - foot(L6, L5)).dot(L6.direction);

  // M = R01^T R = Rz(q234) Ry(-q5) Rz(q6).
  Matrix3 M;
  M << x1.transpose() * frames[6].rotation, y1.transpose() * frames[6].rotation, z1.transpose() * frames[6].rotation;
  const double s234 = std::sin(q234), c234 = std::cos(q234);
  g.offset[4] = std::atan2(-(L6.direction.dot(x1) * c234 + L6.direction.dot(y1) * s234), L6.direction.dot(z1));
  g.offset[5] = std::atan2(c234 * M(1, 0) - s234 * M(0, 0), c234 * M(1, 1) - s234 * M(0, 1));
  return g;
}

Robot arm_of_lengths(const char* name, double d1, double a2, double a3, double d4, double d5, double d6) {
  constexpr double degree = std::numbers::pi / 180.0;
  Robot robot;
  robot.name = name;
  for (std::size_t i = 0; i < 6; ++i) robot.dh[i].alpha = ur_alpha[i];
  robot.dh[0].d = d1;
  robot.dh[1].a = a2;
  robot.dh[2].a = a3;
  robot.dh[3].d = d4;
  robot.dh[4].d = d5;
  robot.dh[5].d = d6;
  robot.limits.position.col(0).setConstant(-2.0 * std::numbers::pi);
  robot.limits.position.col(1).setConstant(2.0 * std::numbers::pi);
  robot.limits.velocity << 120.0 * degree, 120.0 * degree, 180.0 * degree, 180.0 * degree, 180.0 * degree,
      180.0 * degree;
  robot.frames["base_link"].rotation.diagonal() << -1.0, -1.0, 1.0;
  return robot;
}

}  // namespace

UrGeometry ur_geometry(const Robot& robot) {
  const auto& dh = robot.dh;
  bool exact = dh[0].a == 0.0 && dh[3].a == 0.0 && dh[4].a == 0.0 && dh[5].a == 0.0 && dh[1].d == 0.0 && dh[2].d == 0.0;
  for (std::size_t i = 0; i < 6; ++i) exact = exact && std::abs(dh[i].alpha - ur_alpha[i]) < 1e-15;
  if (!exact) return measured(robot);
  UrGeometry g{dh[0].d, dh[1].a, dh[2].a, dh[3].d, dh[4].d, dh[5].d};
  check_lengths(g);
  for (std::size_t i = 0; i < 6; ++i) g.offset[static_cast<Eigen::Index>(i)] = dh[i].theta;
  return g;
}

std::string out_of_reach_words(const UrGeometry& g, const Pose& flange) {
  const Vector3 wrist = flange.position - g.d6 * flange.rotation.col(2);
  const double from_shoulder = (wrist - Vector3(0.0, 0.0, g.d1)).norm();
  const double longest = std::hypot(std::abs(g.a2) + std::abs(g.a3) + std::abs(g.d5), g.d4);
  if (from_shoulder > longest) {
    return fmt::format("the wrist is {:.3f} m from the shoulder, {:.3g} mm more than the arm is long", from_shoulder,
                       1e3 * (from_shoulder - longest));
  }
  const double from_axis = std::hypot(wrist.x(), wrist.y());
  if (from_axis < std::abs(g.d4)) {
    return fmt::format("the wrist is {:.3f} m from the axis of the base, {:.3g} mm less than it can be", from_axis,
                       1e3 * (std::abs(g.d4) - from_axis));
  }
  return "the elbow cannot close there";
}

Robot nominal_ur10() {
  return arm_of_lengths("ur10", 0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922);
}

Robot nominal_ur10e() {
  return arm_of_lengths("ur10e", 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655);
}

}  // namespace lfd
