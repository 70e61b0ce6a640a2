// Samples of a hand path, and poses put between them where they are too far apart.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/ur10.hpp"

namespace lfd {

/// A hand path of given samples and inserted ones. Between given samples it is straight in position and about one fixed
/// axis in orientation, both evenly in time.
class PathSampling {
 public:
  /// @param flange  T >= 1 poses   @param times  T, strictly rising [s]
  PathSampling(const std::vector<Pose>& flange, const Vector& times);

  /// Halves the intervals that end at the given rows, unless one has been halved `depth` times or its middle is out of
  /// reach. @return whether any was halved
  bool halve(const InverseKinematics& arm, const std::vector<Eigen::Index>& intervals, int depth, double tolerance);

  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }
  [[nodiscard]] Vector times() const;
  /// Of each row the given sample it is or, inserted, the one that it leads to.
  [[nodiscard]] std::vector<Eigen::Index> given() const;
  /// The given sample that a row is or leads to.
  [[nodiscard]] Eigen::Index given(Eigen::Index row) const;
  /// Where a row is, for people: "sample 5", or "1.25 s after the first, between samples 4 and 5".
  [[nodiscard]] std::string name(Eigen::Index row) const;
  /// Why the interval that ends at a row is not halved any more; empty if it could be.
  [[nodiscard]] std::string limit(Eigen::Index row, int depth) const;

 private:
  struct Row {
    double time = 0.0;
    Eigen::Index given = 0;  // the sample that it is or leads to
    bool inserted = false;
    int halvings = 0;                  // of the interval that ends here
    bool middle_out_of_reach = false;  // of that interval
    bool no_time_between = false;      // at that interval's ends
  };
  std::vector<Pose> poses_;
  std::vector<Row> rows_;
};

}  // namespace lfd
