#include "lfdtools/path_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lfd {

PathSampling::PathSampling(const std::vector<Pose>& flange, const Vector& times) : poses_(flange) {
  for (Eigen::Index t = 0; t < times.size(); ++t) rows_.push_back({times[t], t, false, 0, false});
}

bool PathSampling::halve(const InverseKinematics& arm, const std::vector<Eigen::Index>& intervals, int depth,
                         double tolerance) {
  std::vector<char> wanted(rows_.size(), 0);
  for (const Eigen::Index row : intervals) wanted[static_cast<std::size_t>(row)] = 1;
  IkOptions ik;
  ik.tolerance = tolerance;
  bool any = false;
  std::vector<Pose> poses;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (wanted[i] != 0 && row.halvings < depth && !row.middle_out_of_reach && !row.no_time_between) {
      Row middle = row;
      middle.time = 0.5 * (rows_[i - 1].time + row.time);
      middle.inserted = true;
      const Pose pose = interpolate(poses_[i - 1], poses_[i], 0.5);
      row.no_time_between = !(middle.time > rows_[i - 1].time && middle.time < row.time);
      row.middle_out_of_reach = !row.no_time_between && arm(pose, ik).empty();
      if (!row.no_time_between && !row.middle_out_of_reach) {
        middle.halvings = ++row.halvings;
        poses.push_back(pose);
        rows.push_back(middle);
        any = true;
      }
    }
    poses.push_back(poses_[i]);
    rows.push_back(row);
  }
  poses_ = std::move(poses);
  rows_ = std::move(rows);
  return any;
}

Vector PathSampling::times() const {
  Vector times(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t i = 0; i < rows_.size(); ++i) times[static_cast<Eigen::Index>(i)] = rows_[i].time;
  return times;
}

std::vector<Eigen::Index> PathSampling::given() const {
  std::vector<Eigen::Index> given;
  for (const Row& row : rows_) given.push_back(row.given);
  return given;
}

Eigen::Index PathSampling::given(Eigen::Index row) const {
  return rows_[static_cast<std::size_t>(row)].given;
}

std::string PathSampling::name(Eigen::Index row) const {
  const Row& at = rows_[static_cast<std::size_t>(row)];
  if (!at.inserted) return fmt::format("sample {}", at.given + 1);
  return fmt::format("{:.6g} s after the first, between samples {} and {}", at.time - rows_.front().time, at.given,
                     at.given + 1);
}

std::string PathSampling::limit(Eigen::Index row, int depth) const {
  const Row& at = rows_[static_cast<std::size_t>(row)];
  if (at.middle_out_of_reach) return "the way between is out of reach";
  if (at.no_time_between) return "there is no number between their times";
  if (depth > 0 && at.halvings >= depth) return fmt::format("halving the interval {} times does not help", depth);
  return {};
}

}  // namespace lfd
