// What the arm is never asked to do unless the user insists. No safety function.
#pragma once

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/motion.hpp"
#include "lfdtools/path.hpp"

namespace lfd::cli {

/// Limits beyond those of the robot file.
struct ArmLimits {
  double tcp_speed = 1.0;                  ///< [m/s]
  std::optional<double> tcp_acceleration;  ///< [m/s^2]
  double condition = 30;                   ///< refuse
  double condition_warning = 17;
};

/// Rates of the joints at the rows of a path, each T x 6.
struct JointRates {
  Samples speeds;         ///< [rad/s]
  Samples accelerations;  ///< [rad/s^2]
  bool of_law = false;    ///< of the law of motion that retime has found; else of the cubic spline through the rows
};

/// Declares the gates and the options that set their limits.
void declare_arm_gates(Program& program, ArmLimits& limits);

/// Judges how far a path starts from the arm's current joints, whole turns counted. @param tolerance  [rad]
/// @throws Error(Fault::gate) gate.start
void judge_start(const JointPath& path, const Recording& recording, const Joints& current, double tolerance, Run& run);

/// Judges a joint path gate by gate. Joint speeds and accelerations are the law's where there is one. Else speeds are
/// the larger of those between two rows and the spline's at inner rows, and accelerations second differences, for at
/// both ends the spline only continues what it has inside, and overshoots there and about them.
/// @param elsewhere  words of better_posture, which end the messages of condition and branch_change
/// @return false if there is no path to write (its gate was lifted)
/// @throws Error(Fault::gate) gate.unreachable, joint_range, joint_step, joint_speed, joint_acceleration, tcp_speed,
///         tcp_acceleration, condition, branch_change, midpoint, posture; the place is the line of the worst sample
bool judge(const JointPath& path, const JointRates& rates, const Recording& recording, const Robot& robot,
           const Pose& tool, const ArmLimits& limits, Run& run, const std::string& elsewhere = "");

/// Where a path changes posture or comes near a singularity, words about a posture in which it would not, if there is
/// one: the least steps, which decide between postures, know nothing of either. Empty where joints or posture are
/// demanded.
/// @param flange, times, options  of solve_path
[[nodiscard]] std::string better_posture(const InverseKinematics& arm, const JointPath& path,
                                         const std::vector<Pose>& flange, const Vector& times,
                                         const PathOptions& options, const ArmLimits& limits);

}  // namespace lfd::cli
