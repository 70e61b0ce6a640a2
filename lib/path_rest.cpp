#include <algorithm>

#include "lfdtools/path.hpp"

namespace lfd {
namespace {

constexpr double repeated = 1e-7;  // how near a row is to one that it repeats [rad]

}  // namespace

std::vector<Eigen::Index> moving_rows(const Samples& joints, double radius) {
  const Eigen::Index T = joints.rows();
  const auto apart = [&](Eigen::Index t, Eigen::Index other) {
    return (joints.row(t) - joints.row(other)).cwiseAbs().maxCoeff();
  };
  Eigen::Index first = 0, last = T - 1;
  while (first + 1 < T && apart(first + 1, 0) <= radius) ++first;
  while (last > 0 && apart(last - 1, T - 1) <= radius) --last;
  std::vector<Eigen::Index> kept{0};
  for (Eigen::Index t = first + 1; t < last;) {
    const Eigen::Index begin = kept.back();
    double gone = apart(t, begin);
    Eigen::Index end = t;
    while (end < last && apart(end, begin) <= radius / 10) {
      ++end;
      gone += apart(end, end - 1);
    }
    // Rows as near as these are only sampled often where the arm goes on through them, not to and fro.
    const bool stays = gone > 2.0 * apart(end, begin);
    for (; t < end; ++t) {
      if (!stays && apart(t, kept.back()) > repeated) kept.push_back(t);
    }
    if (t < last) kept.push_back(t++);
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
