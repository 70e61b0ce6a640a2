#include "lfdtools/io/pooled_samples.hpp"

namespace lfd {

PooledSamples::PooledSamples(const Pool& pool) {
  const Eigen::Index D = pool.recordings.front().demonstration.trajectory.positions.cols();
  Eigen::Index rows = 0;
  for (const auto& recording : pool.recordings) rows += recording.demonstration.trajectory.samples();
  joint.resize(rows, 1 + D);
  start = Vector::Zero(D);
  goal = Vector::Zero(D);
  Eigen::Index row = 0;
  for (const auto& recording : pool.recordings) {
    const Trajectory& trajectory = recording.demonstration.trajectory;
    joint.middleRows(row, trajectory.samples()) << trajectory.times, trajectory.positions;
    row += trajectory.samples();
    start += trajectory.start() / static_cast<double>(pool.recordings.size());
    goal += trajectory.goal() / static_cast<double>(pool.recordings.size());
  }
}

}  // namespace lfd
