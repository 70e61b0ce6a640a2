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
constexpr double near_wrist = 0.03;
constexpr int steps_of_q6 = 32;  ///< over the whole turn

/// The solutions of a calibrated arm, by Newton steps from those of the nearest exact arm and, where the wrist of that
/// is nearly singular, from wherever q6 solves the calibrated one.
class CalibratedSolutions {
 public:
  CalibratedSolutions(const InverseKinematics& arm, const Pose& flange, double tolerance)
      : arm_(arm), g_(arm.geometry()), flange_(flange), tolerance_(tolerance) {}

  /// @param q6  wanted where it is free [rad], angle of the exact arm
  IkSolutions solve(double q6) {
    const Edges limits = edges(q6, tolerance_ / 10.0);
    const ClosedForm closed(g_, flange_, limits);
    for (std::size_t i = 0; i < closed.count; ++i) add(joints_of(g_, closed.candidates[i]));
    // Asked with q6 free, for the exact arm's own q6 need not let the elbow close.
    const Edges wide = edges(q6, near_wrist);
    const ClosedForm around(g_, flange_, wide);
    for (const int shoulder : {0, 4}) {
      const auto near = [&](const Candidate& candidate) {
        return (candidate.branch & 4) == shoulder && candidate.wrist_free;
      };
      if (std::none_of(around.candidates.begin(), around.candidates.begin() + around.count, near)) continue;
      for (const int elbow : {0, 1}) search_q6(shoulder + elbow);
    }
    std::stable_sort(found_.solutions.begin(), found_.solutions.begin() + found_.count,
                     [](const IkSolution& a, const IkSolution& b) { return a.branch < b.branch; });
    return found_;
  }

 private:
  /// Joints with a given q6 that reach the pose but for a tilt that joint 5 would take if q6 were another.
  struct Tilted {
    Joints joints = Joints::Zero();
    double q6 = 0.0;    ///< [rad], angle of the exact arm
    double tilt = 0.0;  ///< [rad], signed: zero is a solution
  };

  [[nodiscard]] static Edges edges(double q6, double wrist_free) { return {q6, wrist_free, 0.05, 0.05}; }

  /// The pose is corrected by what the exact arm differs from the calibrated one at the joints found, and solved again.
  [[nodiscard]] std::optional<Tilted> at_q6(int arm_branch, double q6) const {
    Tilted tilted;
    tilted.q6 = q6;
    Pose corrected = flange_;
    for (int pass = 0; pass < 3; ++pass) {
      const Edges limits = edges(q6, 2.0 * near_wrist);
      const ClosedForm closed(g_, corrected, limits);
      const auto* end = closed.candidates.data() + closed.count;
      const auto* own = std::find_if(closed.candidates.data(), end, [&](const Candidate& candidate) {
        return candidate.wrist_free && (candidate.branch & 5) == arm_branch;
      });
      // Where the elbow does not close with this q6, the closed form takes another.
      if (own == end || std::abs(wrap_angle(angle_of(own->q[5]) - q6)) > 1e-6) return std::nullopt;
      tilted.joints = joints_of(g_, *own);
      const Pose reached = forward_kinematics(arm_.robot(), tilted.joints);
      corrected = flange_ * inverse(reached) * exact_pose(g_, own->q);
      const Vector3 off = vector_from_rotation(reached.rotation.transpose() * flange_.rotation);
      tilted.tilt = own->q[5].c * off.x() - own->q[5].s * off.y();
    }
    return tilted;
  }

  void search_q6(int arm_branch) {
    constexpr double step = 2.0 * std::numbers::pi / steps_of_q6;
    std::vector<std::optional<Tilted>> around;  // nothing where the elbow does not close
    for (int k = 0; k < steps_of_q6; ++k) {
      auto here = at_q6(arm_branch, k * step);
      if (k > 0 && here.has_value() != around.back().has_value()) {
        const Tilted edge =
            here ? edge_of_reach(arm_branch, *here, -step) : edge_of_reach(arm_branch, *around.back(), step);
        around.emplace_back(edge);
      }
      around.push_back(std::move(here));
    }
    for (std::size_t k = 0; k < around.size(); ++k) {
      const auto& here = around[k];
      const auto &next = around[(k + 1) % around.size()], &last = around[(k + around.size() - 1) % around.size()];
      if (!here || !next) continue;
      if (differ(*here, *next)) {
        add(between(arm_branch, *here, *next));
      } else if (last && !differ(*last, *here)) {
        search_dip(arm_branch, *last, *here, *next);
      }
    }
  }

  /// The last q6 for which the elbow closes, on the way from one for which it does to one for which it does not.
  [[nodiscard]] Tilted edge_of_reach(int arm_branch, const Tilted& from, double step) const {
    Tilted edge = from;
    for (int halving = 0; halving < 10; ++halving) {
      step *= 0.5;
      if (const auto further = at_q6(arm_branch, edge.q6 + step)) edge = *further;
    }
    return edge;
  }

  /// Two solutions may hide where the tilt comes near zero and goes back.
  void search_dip(int arm_branch, Tilted low, Tilted middle, Tilted high) {
    for (int i = 0; i < 4; ++i) {
      const double left = std::abs(low.tilt) - std::abs(middle.tilt);
      const double right = std::abs(high.tilt) - std::abs(middle.tilt);
      if (left < 0.0 || right < 0.0 || left + right == 0.0) return;
      // The parabola's lowest point, or the middle of the wider half if that is where we are.
      const double before = wrap_angle(middle.q6 - low.q6), after = wrap_angle(high.q6 - middle.q6);
      const double slopes = left / before + right / after;
      double move = 0.5 * (left / before * after - right / after * before) / slopes;
      if (std::abs(move) < 0.05 * std::min(before, after)) move = after > before ? 0.5 * after : -0.5 * before;
      const auto lowest = at_q6(arm_branch, middle.q6 + move);
      if (!lowest) return;
      if (differ(*lowest, middle)) {
        add(between(arm_branch, move < 0.0 ? low : middle, *lowest));
        add(between(arm_branch, *lowest, move < 0.0 ? middle : high));
        return;
      }
      const bool lower = std::abs(lowest->tilt) < std::abs(middle.tilt);
      (lower == (move < 0.0) ? high : low) = lower ? middle : *lowest;
      if (lower) middle = *lowest;
    }
  }

  static bool differ(const Tilted& a, const Tilted& b) { return (a.tilt < 0.0) != (b.tilt < 0.0); }

  /// False position between two tilts of different sign, as near as Newton steps need it.
  [[nodiscard]] Joints between(int arm_branch, Tilted low, Tilted high) const {
    for (int i = 0; i < 6; ++i) {
      const double share = std::clamp(low.tilt / (low.tilt - high.tilt), 0.1, 0.9);
      const auto middle = at_q6(arm_branch, low.q6 + share * wrap_angle(high.q6 - low.q6));
      if (!middle) break;
      (differ(*middle, low) ? high : low) = *middle;
    }
    return std::abs(low.tilt) < std::abs(high.tilt) ? low.joints : high.joints;
  }

  void add(const Joints& start) {
    auto refined = refine(arm_.robot(), flange_, start, tolerance_);
    if (!refined || found_.count == found_.solutions.size()) return;
    refined->branch = arm_.branch(refined->joints);
    // The exact arm's sin q5 is the sine between axes 4 and 6; those of the calibrated one are parallel elsewhere.
    const auto frames = joint_frames(arm_.robot(), refined->joints);
    refined->wrist_free = frames[3].rotation.col(2).cross(frames[5].rotation.col(2)).norm() <= tolerance_ / 10.0;
    const auto is_known = [&](const IkSolution& other) {
      const Joints apart = (other.joints - refined->joints).unaryExpr(&wrap_once);
      const bool same_arm = ((other.branch ^ refined->branch) & 5) == 0;
      return apart.cwiseAbs().maxCoeff() < 1e-5 || (same_arm && other.wrist_free && refined->wrist_free);
    };
    if (std::none_of(found_.begin(), found_.end(), is_known)) found_.solutions[found_.count++] = *refined;
  }

  const InverseKinematics& arm_;
  const UrGeometry& g_;
  const Pose& flange_;
  double tolerance_;
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
