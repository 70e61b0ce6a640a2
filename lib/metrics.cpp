#include "lfdtools/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/interpolation.hpp"

namespace lfd {

Samples at_phases(const Trajectory& trajectory, Eigen::Index n, double duration) {
  const double first = trajectory.times[0];
  const double span = duration > 0 ? duration : trajectory.duration();
  return CubicSpline(trajectory.times, trajectory.positions)(linspace(first, first + span, n));
}

Samples mean_path(const std::vector<Trajectory>& trajectories, Eigen::Index n) {
  if (trajectories.empty()) throw DataError("metrics.no_trajectory", "a mean path needs at least one trajectory");
  Samples sum = at_phases(trajectories.front(), n);
  for (std::size_t i = 1; i < trajectories.size(); ++i) sum += at_phases(trajectories[i], n);
  return sum / static_cast<double>(trajectories.size());
}

double rms_distance(const Samples& a, const Samples& b) {
  return std::sqrt((a - b).rowwise().squaredNorm().mean());
}

Arrival arrival(const Samples& path, double radius) {
  const Eigen::Index last = path.rows() - 1;
  Arrival result{path.row(last).transpose(), Vector::Zero(path.cols())};
  Eigen::Index i = last;
  while (i >= 0 && (path.row(i).transpose() - result.end).norm() <= radius) --i;
  if (i < 0) return result;
  // The entry point lies between sample i (outside) and i + 1 (inside): where the segment meets the sphere.
  const Vector outside = path.row(i).transpose() - result.end;
  const Vector along = path.row(i + 1).transpose() - path.row(i).transpose();
  const double a = along.squaredNorm();
  const double b = outside.dot(along);
  const double c = outside.squaredNorm() - radius * radius;
  const double u = (-b - std::sqrt(std::max(0.0, b * b - a * c))) / a;
  const Vector entry = outside + std::clamp(u, 0.0, 1.0) * along;
  result.direction = -entry.normalized();
  return result;
}

double angle_between(const Vector& a, const Vector& b) {
  // Kahan's form: no loss of digits near 0 and pi, where acos has none left.
  const Vector u = a.normalized();
  const Vector v = b.normalized();
  return 2 * std::atan2((u - v).norm(), (u + v).norm());
}

double lateral_deviation(const Samples& path, const Arrival& line, double radius) {
  double largest = 0;
  for (Eigen::Index i = path.rows() - 1; i >= 0; --i) {
    const Vector d = path.row(i).transpose() - line.end;
    if (d.norm() > radius) break;
    largest = std::max(largest, (d - d.dot(line.direction) * line.direction).norm());
  }
  return largest;
}

double overshoot(const Samples& path, const Arrival& line) {
  const Vector beyond = (path.rowwise() - line.end.transpose()) * line.direction;
  return std::max(0.0, beyond.maxCoeff());
}

double rms_jerk(const Samples& path, double duration) {
  const Eigen::Index n = path.rows();
  if (n < 4) return 0;
  const double h = duration / static_cast<double>(n - 1);
  const Samples third =
      path.bottomRows(n - 3) - 3 * path.middleRows(2, n - 3) + 3 * path.middleRows(1, n - 3) - path.topRows(n - 3);
  return std::sqrt(third.rowwise().squaredNorm().mean()) / (h * h * h);
}

double path_length(const Samples& path) {
  return (path.bottomRows(path.rows() - 1) - path.topRows(path.rows() - 1)).rowwise().norm().sum();
}

}  // namespace lfd
