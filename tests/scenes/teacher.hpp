// A teacher who knows the scene: the shortest smooth hand path whose whole arm keeps clear, on one way round.
#pragma once

#include <optional>

#include "lfdtools/clearance.hpp"
#include "lfdtools/ur10.hpp"
#include "task.hpp"

namespace lfd::scenes {

/// A hand path that is meant: minimum jerk from start to goal, and on top of it
///   sum over k of coefficients.col(k) sin(pi s) sin(k pi s),   k = 1 .. K
/// so that both ends stay where they are and are left without a sudden turn.
struct Meant {
  Vector3 start, goal;
  Matrix coefficients;  ///< 3 x K [m]

  /// @param phases  n in [0, 1]   @return n x 3 [m]
  [[nodiscard]] Samples positions(const Vector& phases) const;
};

/// Joint path along a hand path of fixed orientation in one branch of inverse kinematics, n x 6 [rad]; empty where a
/// position is out of the branch's reach.
[[nodiscard]] std::optional<Samples> joints_along(const InverseKinematics& arm, const Matrix3& orientation, int branch,
                                                  const Samples& positions);

class Teacher {
 public:
  /// @param margin  that the whole arm keeps from obstacles while nothing is noisy [m]; a fifth of it from the table,
  /// for the shoulder always turns 2 cm above it, and none from itself, whose links rest side by side
  Teacher(const Robot& robot, const Task& task, double margin);

  /// Branches in which the arm stands clear at the start and at every hole, clearest first.
  [[nodiscard]] std::vector<int> branches() const;

  /// The way to a goal round the obstacle: the least mean square of the hand's speed with the whole arm `margin` clear
  /// (L-BFGS-B on a hinge), from what is meant at another goal, so that the hand goes on as it went there; without one,
  /// or where that fails, from a bump towards the way or, where that fails, from a path of RRT-Connect. Empty if
  /// nothing comes to a path that keeps 3/4 of the margin, a condition number under 25 and its side of the obstacle.
  [[nodiscard]] std::optional<Meant> plan(const Vector3& goal, std::size_t way, int branch, const Meant* like) const;

  /// Least distance of the arm from obstacles, table and itself along a hand path [m]; nothing where it is out of
  /// reach.
  [[nodiscard]] std::optional<double> clearance(const Samples& positions, int branch) const;

  [[nodiscard]] const InverseKinematics& arm() const { return arm_; }

 private:
  [[nodiscard]] Meant shortened(Meant meant, int branch) const;
  [[nodiscard]] bool holds(const Meant& meant, std::size_t way, int branch) const;
  [[nodiscard]] std::optional<Meant> planned(const Vector3& goal, int branch) const;

  /// What is missing from the margins, 0 where all are kept [m].
  [[nodiscard]] double missing(const Joints& q) const;
  [[nodiscard]] double least(const Joints& q) const;
  [[nodiscard]] double to_ground(const Joints& q) const;

  const Task& task_;
  InverseKinematics arm_;
  ArmClearance bodies_, ground_;
  double margin_;
};

}  // namespace lfd::scenes
