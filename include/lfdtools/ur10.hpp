// Inverse kinematics of UR arms: every solution, in closed form, each checked by forward kinematics.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "lfdtools/ur_geometry.hpp"

namespace lfd {

struct IkOptions {
  /// Where the wrist is singular, q6 is free: the value nearest to the seed's is taken for which the elbow can close
  /// (without a seed: nearest to 0). Elsewhere the seed has no influence.
  std::optional<Joints> seed;
  /// A solution reaches the pose within this, larger of metres and radians. The wrist counts as singular where any q6
  /// keeps the pose within a tenth of it.
  double tolerance = 1e-9;
};

/// One arm configuration that reaches a pose.
struct IkSolution {
  Joints joints = Joints::Zero();  ///< each in (-pi, pi]
  int branch = 0;                  ///< 0..7, see branch_name
  double residual = 0.0;           ///< distance of its pose to the one asked for, larger of metres and radians
  bool wrist_free = false;         ///< q6 could be anything (near by): axes 4 and 6 are parallel, sin q5 = 0
};

/// All solutions of one pose in the order of their branches: a value, no allocation. At most 8 of the exact pattern,
/// one a branch; of a calibrated arm near its wrist singularity a branch can hold several.
struct IkSolutions {
  std::array<IkSolution, 16> solutions;
  std::size_t count = 0;

  [[nodiscard]] bool empty() const { return count == 0; }
  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] const IkSolution& operator[](std::size_t i) const { return solutions[i]; }
  [[nodiscard]] const IkSolution* begin() const { return solutions.data(); }
  [[nodiscard]] const IkSolution* end() const { return solutions.data() + count; }
};

/// Words for a branch 4 shoulder + 2 wrist + elbow, such as "left-wrist+-elbow+": shoulder "left" (0) has the wrist
/// centre in front of the shoulder (along the x axis of frame 1), "right" (1) behind it; wrist+ (0) is sin q5 >= 0;
/// elbow+ (0) is sin q3 >= 0.
[[nodiscard]] std::string branch_name(int branch);

/// Solver for one arm. Closed form for the exact pattern; for calibrated DH rows the closed form of the nearest exact
/// arm, refined by Newton steps. Where the wrist of that is nearly singular, calibration alone decides on q6, and the
/// solutions are looked for all along the arm's self-motion. Of arms whose axes are off by milliradians, one solution
/// in 10^4 or fewer is missed, some in 10^4 beside two singularities at once and in 10^3 exactly in both.
class InverseKinematics {
 public:
  /// @throws ConfigError as check(Robot) and ur_geometry
  explicit InverseKinematics(Robot robot);

  /// All configurations that reach the pose, distinct modulo 2 pi; none means out of reach (of a calibrated arm, but
  /// for what it misses). A double root (arm stretched or folded, wrist centre as near to the base axis as it can be)
  /// is one solution. Joint limits are not looked at.
  /// @param flange  pose of the flange in the base [m]
  /// @throws DataError [ur10.pose_not_rigid] if it is not finite or its rotation not orthonormal to 1e-9
  [[nodiscard]] IkSolutions operator()(const Pose& flange, const IkOptions& options = {}) const;

  /// The branch that the joints are in, by the signs that branch_name names.
  [[nodiscard]] int branch(const Joints& q) const;

  [[nodiscard]] const Robot& robot() const { return robot_; }
  /// Of a calibrated robot: of the nearest exact arm. Offsets in (-pi, pi].
  [[nodiscard]] const UrGeometry& geometry() const { return geometry_; }

 private:
  Robot robot_;
  UrGeometry geometry_;
};

/// As InverseKinematics, for a single pose.
[[nodiscard]] IkSolutions inverse_kinematics(const Robot& robot, const Pose& flange, const IkOptions& options = {});

/// Joints near `start` that reach the pose, by Newton steps shortened while they do not help; nothing if the residual
/// does not fall to `tolerance`.
[[nodiscard]] std::optional<IkSolution> refine(const Robot& robot, const Pose& flange, const Joints& start,
                                               double tolerance = 1e-9);

}  // namespace lfd
