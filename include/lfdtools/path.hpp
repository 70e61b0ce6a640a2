// Joint path along a sequence of poses: branches and whole turns chosen for the path as a whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/ur10.hpp"

namespace lfd {

struct PathOptions {
  /// The arm's current joints, or any posture to start near to: of the starts from which a path without jumps exists,
  /// the one nearest to it is taken (joint differences over speed limits, whole turns counted). Without a seed the
  /// path's largest step, branch changes and length decide, then the smallest angles.
  std::optional<Joints> seed;
  bool respect_limits = true;         ///< keep every joint within its range; else only principal values at the start
  double tolerance = 1e-9;            ///< of inverse kinematics, larger of metres and radians
  double max_step = 0.5;              ///< a joint that moves further between two samples counts as a jump [rad]
  double midpoint_tolerance = 0.005;  ///< allowed deviation of the hand midway between samples, larger of m and rad
  /// Paths whose largest step is within this factor of the smallest possible count as equally good; branch changes,
  /// then length decide between them. Without it a thousandth of a step would flip an elbow.
  double step_slack = 1.1;
  /// The branch to keep, 0..7, see branch_name; a border between branches belongs to both.
  std::optional<int> branch;
  /// Where a step is a jump or the hand leaves its path midway, the interval is halved, up to so many times, and the
  /// way chosen anew: a jump keeps its size, sparse samples do not. 0: the samples stay those given.
  int refinements = 0;
  /// The arm is to go along the JointCurve through the rows that without_rest leaves for this radius [rad], as motions
  /// of retime do: the hand is compared with its path there too, a quarter, half and three quarters of the way between
  /// two rows.
  std::optional<double> curve_rest;
};

/// How a path came out.
enum class PathStatus {
  continuous,      ///< every pose reached, no jump
  unreachable,     ///< a pose has no inverse kinematics; no joints
  outside_limits,  ///< poses are reached, but no chain of solutions stays within the joint ranges; no joints
  jump,            ///< the best path has a step over max_step; it is returned
  deviates,        ///< the hand leaves the path between two samples by more than midpoint_tolerance; it is returned
  other_branch     ///< there is a path, but none without a jump in the branch to keep; the one there is is returned
};

/// One thing wrong with a path.
struct PathFault {
  PathStatus status = PathStatus::continuous;
  Eigen::Index sample = 0;  ///< first given sample where it applies (jump, deviates: the end of the interval)
  std::string reason;       ///< sentence for people: where and why
};

/// A joint path, or where and why there is none.
struct JointPath {
  PathStatus status = PathStatus::continuous;
  Eigen::Index sample = 0;        ///< that of the first fault
  std::string reason;             ///< that of the first fault; empty when continuous
  std::vector<PathFault> faults;  ///< all there are, at most one a status: other_branch, then jump, then deviates
  std::vector<Eigen::Index> unreachable;  ///< every given sample out of reach

  Vector times;                     ///< T >= the samples given: times of the rows, inserted ones among them [s]
  std::vector<Eigen::Index> given;  ///< T: the given sample that a row is or, inserted before it, leads to
  Samples joints;                   ///< T x 6 [rad], whole turns included; 0 x 6 where there is no path
  std::vector<int> branch;          ///< T, see branch_name
  Vector residual;                  ///< T, larger of metres and radians
  Vector condition;                 ///< T, condition number of the Jacobian
  Vector midpoint_deviation;  ///< T, of the interval ending at the sample (0 for the first), on the curve of curve_rest
                              ///< too if there is one, larger of m and rad
  double largest_step_ratio = 0.0;  ///< largest joint speed over its limit
  int branch_changes = 0;           ///< samples whose branch differs from the one before

  /// Whether a row was put in before the sample that it leads to.
  [[nodiscard]] bool inserted(std::size_t row) const { return row + 1 < given.size() && given[row + 1] == given[row]; }
};

/// Joint angles along poses: the best way through the layered graph of all inverse kinematics solutions and all whole
/// turns within the joint ranges; best_way in posture_graph.hpp says what best means, the largest |dq_j| / (v_j dt) of
/// the path coming first. Where the wrist is singular, q6 follows the neighbours on both sides.
/// @param flange  T >= 1 poses of the flange in the base
/// @param times   T, strictly rising [s]
/// @throws DataError [path.shape], [path.not_finite], [path.time_not_rising], [ur10.pose_not_rigid]
/// @throws UsageError [path.options] if an option is out of its range
[[nodiscard]] JointPath solve_path(const InverseKinematics& arm, const std::vector<Pose>& flange, const Vector& times,
                                   const PathOptions& options = {});

/// The rows of a path in which the arm does not rest: all but those after the first that stay within `radius` of it,
/// those before the last that stay within it of the last, and between them those within a tenth of it of the row
/// before. A hand that settles on its goal goes to and fro by less than it can be held to, and a law of motion that
/// followed it there exactly would have to stop at each turn.
/// @param joints  T x 6, T >= 1 [rad]   @param radius  largest joint distance [rad]
[[nodiscard]] std::vector<Eigen::Index> moving_rows(const Samples& joints, double radius);

/// The path without the other rows.
[[nodiscard]] JointPath without_rest(const JointPath& path, double radius);

/// As above for one robot.
[[nodiscard]] JointPath solve_path(const Robot& robot, const std::vector<Pose>& flange, const Vector& times,
                                   const PathOptions& options = {});

}  // namespace lfd
