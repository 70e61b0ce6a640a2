#include <algorithm>

#include "lfdtools/path.hpp"

namespace lfd {

std::vector<Eigen::Index> moving_rows(const Samples& joints, double radius) {
  const Eigen::Index T = joints.rows();
  const auto near = [&](Eigen::Index t, Eigen::Index end) {
    return (joints.row(t) - joints.row(end)).cwiseAbs().maxCoeff() <= radius;
  };
  Eigen::Index first = 0, last = T - 1;
  while (first + 1 < T && near(first + 1, 0)) ++first;
  while (last > 0 && near(last - 1, T - 1)) --last;
  std::vector<Eigen::Index> kept{0};
  for (Eigen::Index t = first + 1; t < last; ++t) {
    if ((joints.row(t) - joints.row(kept.back())).cwiseAbs().maxCoeff() > radius / 10) kept.push_back(t);
  }
  if (T > 1) kept.push_back(T - 1);
  return kept;
}

JointPath without_rest(const JointPath& path, double radius) {
  const std::vector<Eigen::Index> kept = moving_rows(path.joints, radius);
  JointPath moving = path;
  moving.times = path.times(kept);
  moving.joints = path.joints(kept, Eigen::all);
  moving.residual = path.residual(kept);
  moving.condition = path.condition(kept);
  moving.midpoint_deviation = path.midpoint_deviation(kept);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    moving.branch[k] = path.branch[static_cast<std::size_t>(kept[k])];
    moving.given[k] = path.given[static_cast<std::size_t>(kept[k])];
  }
  moving.branch.resize(kept.size());
  moving.given.resize(kept.size());
  return moving;
}

}  // namespace lfd
