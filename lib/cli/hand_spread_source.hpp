// How far the hand may be off along a path, from what arm-clearance is told of it. For clearance_report.cpp alone.
#pragma once

#include <vector>

#include "lfdtools/cli/clearance_report.hpp"
#include "lfdtools/hand_spread.hpp"
#include "lfdtools/io/covariance_file.hpp"

namespace lfd::cli {

/// Spreads of joint paths: by the covariances of --covariance, the goal's by --goal-sd, or both at once. What is wrong
/// with a covariance is told with the path that it is asked for.
class HandSpreadSource {
 public:
  /// @param request, robot, run  must outlive the source
  /// @throws DataError [clearance.covariance_columns] unless the signals are x, y, z; those of read_covariance and
  ///         frame_in_base
  HandSpreadSource(const ClearanceRequest& request, const Robot& robot, Run& run);

  /// The spread of the tool tip in the base along one path, for a request that asks for a probability.
  /// @param recording  joints, T x 6 [rad]
  /// @throws DataError [clearance.covariance_target], [clearance.covariance_samples], those of hand_spread;
  ///         Error(Fault::gate) gate.mean_differs where the tool tip is not on the covariance's motion
  [[nodiscard]] HandSpread of(const Recording& recording) const;

 private:
  [[nodiscard]] Samples tips(const Samples& joints) const;
  [[nodiscard]] const CovarianceFile& file_of(const Recording& recording) const;
  void judge_mean(const CovarianceFile& file, const Samples& positions, const Recording& recording) const;
  [[nodiscard]] HandSpread of_file(const CovarianceFile& file) const;
  [[nodiscard]] HandSpread of_goal(const Samples& positions) const;

  const ClearanceRequest& request_;
  const Robot& robot_;
  Run& run_;
  Pose frame_;  // of covariance and goal, in the base
  Pose tool_;
  std::vector<CovarianceFile> files_;
};

}  // namespace lfd::cli
