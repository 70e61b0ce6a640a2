#include "lfdtools/ur10.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "lfdtools/error.hpp"
#include "ur10_closed_form.hpp"
#include "wrist_loop.hpp"

namespace lfd {
namespace {

/// Forward kinematics of the exact arm from sines and cosines: the angles handed out are their arc tangents, one
/// rounding away.
Pose exact_pose(const UrGeometry& g, const std::array<Turn, 6>& q) {
  const Turn q23 = q[1] + q[2], q234 = q23 + q[3];
  const double s1 = q[0].s, c1 = q[0].c, s5 = q[4].s, c5 = q[4].c, s6 = q[5].s, c6 = q[5].c;
  const double X = g.a2 * q[1].c + g.a3 * q23.c + g.d5 * q234.s;
  const double Y = g.a2 * q[1].s + g.a3 * q23.s - g.d5 * q234.c;
  // Rz(q234) Ry(-q5) Rz(q6)
  Matrix3 M;
  M << q234.c * c5 * c6 - q234.s * s6, -q234.c * c5 * s6 - q234.s * c6, -q234.c * s5,  //
      q234.s * c5 * c6 + q234.c * s6, -q234.s * c5 * s6 + q234.c * c6, -q234.s * s5,   //
      s5 * c6, -s5 * s6, c5;
  Pose pose;
  pose.rotation.row(0) = c1 * M.row(0) + s1 * M.row(2);
  pose.rotation.row(1) = s1 * M.row(0) - c1 * M.row(2);
  pose.rotation.row(2) = M.row(1);
  pose.position << c1 * X + s1 * g.d4, s1 * X - c1 * g.d4, g.d1 + Y;
  pose.position += g.d6 * pose.rotation.col(2);
  return pose;
}

Joints joints_of(const UrGeometry& g, const Candidate& candidate) {
  Joints q;
  for (int j = 0; j < 6; ++j) q[j] = wrap_once(angle_of(candidate.q[static_cast<std::size_t>(j)]) - g.offset[j]);
  return q;
}

/// |sin q5| of the nearest exact arm up to which a calibrated one may have its solutions at any q6: its axes 4 and 6
/// differ from those of the exact arm by some milliradians, and where they are parallel that alone decides on q6.
constexpr double near_wrist = 0.06;
/// The same where the shoulder is nearly singular too, so that q1 of the exact arm, and with it its wrist, is well off:
/// where the wrist centre is within this of the cylinder about the base's axis that it cannot enter [m].
constexpr double near_wrist_and_shoulder = 0.3, near_shoulder = 0.1;
/// How far from a double root of the exact arm Newton steps start, as a sine: in the root itself the Jacobian is
/// singular, and the calibrated arm has two solutions on either side of it, or none.
constexpr std::array<double, 3> starts_apart = {0.2, 0.05, 0.0};
constexpr double near_by = 0.02;    ///< solutions nearer than this may be one [rad]
constexpr int starts_of_loops = 8;  ///< values of q6, over the whole turn

/// The solutions of a calibrated arm, by Newton steps from those of the nearest exact arm and, where the wrist of that
/// is nearly singular, from wherever q6 solves the calibrated one.
class CalibratedSolutions {
 public:
  CalibratedSolutions(const InverseKinematics& arm, const Pose& flange, double tolerance)
      : arm_(arm), g_(arm.geometry()), flange_(flange), tolerance_(tolerance) {}

  /// @param q6  wanted where it is free [rad], angle of the exact arm
  IkSolutions solve(double q6) {
    for (const double apart : starts_apart) {
      for_each_candidate(q6, tolerance_ / 10.0, apart,
                         [&](const Candidate& candidate) { add(joints_of(g_, candidate)); });
    }
    WristLoops loops(arm_.robot(), flange_);
    const bool shoulder = wrist_from_axis() < std::abs(g_.d4) + near_shoulder;
    for (int k = 0; k < starts_of_loops; ++k) {  // not each need let the elbow close
      const double other = q6 + 2.0 * std::numbers::pi * k / starts_of_loops;
      const auto trace = [&](const Candidate& candidate) {
        if (candidate.wrist_free) loops.trace(joints_of(g_, candidate));
      };
      for_each_candidate(other, shoulder ? near_wrist_and_shoulder : near_wrist, 0.0, trace);
      if (shoulder) for_each_candidate(other, near_wrist_and_shoulder, starts_apart.front(), trace);
    }
    for (const Joints& zero : loops.zeros()) add(zero);
    std::stable_sort(found_.solutions.begin(), found_.solutions.begin() + found_.count,
                     [](const IkSolution& a, const IkSolution& b) { return a.branch < b.branch; });
    return found_;
  }

 private:
  /// visit(candidate) for each of the exact arm's solutions, of poses up to 5 cm out of its reach as well.
  template <class Visit>
  void for_each_candidate(double q6, double wrist_free, double apart, Visit visit) const {
    const Edges limits{q6, wrist_free, 0.05, apart};
    const ClosedForm closed(g_, flange_, limits);
    for (std::size_t i = 0; i < closed.count; ++i) visit(closed.candidates[i]);
  }

  [[nodiscard]] double wrist_from_axis() const {
    const Vector3 wrist = flange_.position - g_.d6 * flange_.rotation.col(2);
    return std::hypot(wrist.x(), wrist.y());
  }

  void add(const Joints& start) {
    // Far from double roots all of starts_apart give the same.
    if (std::find(starts_.begin(), starts_.end(), start) != starts_.end()) return;
    starts_.push_back(start);
    auto refined = refine(arm_.robot(), flange_, start, tolerance_);
    if (!refined) return;
    refined->branch = arm_.branch(refined->joints);
    // The exact arm's sin q5 is the sine between axes 4 and 6; those of the calibrated one are parallel elsewhere.
    const auto frames = joint_frames(arm_.robot(), refined->joints);
    refined->wrist_free = frames[3].rotation.col(2).cross(frames[5].rotation.col(2)).norm() <= tolerance_ / 10.0;
    for (IkSolution* other = found_.solutions.data(); other != found_.end(); ++other) {
      if (!same(*other, *refined)) continue;
      if (refined->residual < other->residual) *other = *refined;
      return;
    }
    if (found_.count < found_.solutions.size()) found_.solutions[found_.count++] = *refined;
  }

  /// Newton steps that end short of one solution, or along a free wrist: what is between reaches the pose as well.
  [[nodiscard]] bool same(const IkSolution& a, const IkSolution& b) const {
    if (((a.branch ^ b.branch) & 5) == 0 && a.wrist_free && b.wrist_free) return true;
    const Joints apart = (b.joints - a.joints).unaryExpr(&wrap_once);
    const double largest = apart.cwiseAbs().maxCoeff();
    if (largest < 1e-5 || largest > near_by) return largest < 1e-5;
    return distance(forward_kinematics(arm_.robot(), a.joints + 0.5 * apart), flange_).largest() <= tolerance_;
  }

  const InverseKinematics& arm_;
  const UrGeometry& g_;
  const Pose& flange_;
  double tolerance_;
  std::vector<Joints> starts_;
  IkSolutions found_;
};

}  // namespace

std::string branch_name(int branch) {
  std::string name = (branch & 4) != 0 ? "right" : "left";
  name += (branch & 2) != 0 ? "-wrist-" : "-wrist+";
  name += (branch & 1) != 0 ? "-elbow-" : "-elbow+";
  return name;
}

std::optional<IkSolution> refine(const Robot& robot, const Pose& flange, const Joints& start, double tolerance) {
  IkSolution solution;
  solution.joints = start;
  Pose reached = forward_kinematics(robot, start);
  solution.residual = distance(reached, flange).largest();
  for (int iteration = 0; iteration < 60 && solution.residual > 1e-14; ++iteration) {
    Joints error;
    error << flange.position - reached.position, vector_from_rotation(flange.rotation * reached.rotation.transpose());
    // Least-norm step: at a singularity the free directions stay where they are.
    Joints step = Eigen::CompleteOrthogonalDecomposition<Jacobian>(jacobian(robot, solution.joints)).solve(error);
    const double length = step.cwiseAbs().maxCoeff();
    if (length > 0.3) step *= 0.3 / length;
    bool helped = false;
    for (int halving = 0; halving < 12 && !helped; ++halving, step *= 0.5) {
      const Pose pose = forward_kinematics(robot, solution.joints + step);
      const double residual = distance(pose, flange).largest();
      if (!(residual < solution.residual)) continue;
      helped = true;
      reached = pose;
      solution.residual = residual;
      solution.joints += step;
    }
    if (!helped) break;
  }
  if (!(solution.residual <= tolerance)) return std::nullopt;
  for (double& q : solution.joints) q = wrap_angle(q);
  return solution;
}

InverseKinematics::InverseKinematics(Robot robot) : robot_(std::move(robot)) {
  check(robot_);
  geometry_ = ur_geometry(robot_);
  for (double& offset : geometry_.offset) offset = wrap_angle(offset);
}

IkSolutions InverseKinematics::operator()(const Pose& flange, const IkOptions& options) const {
  if (!is_rigid(flange)) {
    throw DataError("ur10.pose_not_rigid", "the pose is not finite or its rotation is not orthonormal");
  }
  const UrGeometry& g = geometry_;
  const Edges edges{g.offset[5] + (options.seed ? (*options.seed)[5] : 0.0), options.tolerance / 10.0,
                    options.tolerance, 0.0};
  if (!g.exact) return CalibratedSolutions(*this, flange, options.tolerance).solve(edges.q6_wanted);
  IkSolutions found;
  const ClosedForm closed(g, flange, edges);
  for (std::size_t i = 0; i < closed.count; ++i) {
    const Candidate& candidate = closed.candidates[i];
    IkSolution& solution = found.solutions[found.count];
    solution.joints = joints_of(g, candidate);
    solution.residual = distance(exact_pose(g, candidate.q), flange).largest();
    if (!(solution.residual <= options.tolerance)) continue;
    solution.branch = candidate.branch;
    solution.wrist_free = candidate.wrist_free;
    ++found.count;
  }
  return found;
}

int InverseKinematics::branch(const Joints& q) const {
  const Joints a = q + geometry_.offset;
  const double X = geometry_.a2 * std::cos(a[1]) + geometry_.a3 * std::cos(a[1] + a[2]) +
                   geometry_.d5 * std::sin(a[1] + a[2] + a[3]);
  return (X < 0.0 ? 4 : 0) + (std::sin(a[4]) < 0.0 ? 2 : 0) + (std::sin(a[2]) < 0.0 ? 1 : 0);
}

IkSolutions inverse_kinematics(const Robot& robot, const Pose& flange, const IkOptions& options) {
  return InverseKinematics(robot)(flange, options);
}

}  // namespace lfd
