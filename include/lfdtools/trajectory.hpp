// Trajectories, and demonstrations: trajectories that carry labels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/linalg.hpp"

namespace lfd {

/// Signals over time.
struct Trajectory {
  Vector times;       ///< T, strictly rising [s]
  Samples positions;  ///< T x D, SI units

  [[nodiscard]] Eigen::Index samples() const { return times.size(); }
  [[nodiscard]] Eigen::Index dimensions() const { return positions.cols(); }
  [[nodiscard]] double duration() const { return times.size() < 2 ? 0.0 : times[times.size() - 1] - times[0]; }
  [[nodiscard]] Vector start() const { return positions.row(0).transpose(); }
  [[nodiscard]] Vector goal() const { return positions.row(positions.rows() - 1).transpose(); }
};

/// The group columns of a file; a label that the file does not have is empty.
struct Labels {
  std::optional<std::string> target;   ///< integer or word
  std::optional<std::string> teacher;  ///< who demonstrated
  std::optional<std::string> demo;     ///< repetition
  std::optional<std::string> sample;   ///< draw from a distribution

  friend bool operator==(const Labels&, const Labels&) = default;
};

/// Words such as `target 3, demo 2` for messages; empty when there are no labels.
[[nodiscard]] std::string describe(const Labels& labels);
/// The same in front of a message, `target 3, demo 2: `; empty when there are no labels.
[[nodiscard]] std::string prefix_of(const Labels& labels);

/// One demonstration.
struct Demonstration {
  Labels labels;
  Trajectory trajectory;
};

/// Demonstrations over the same signals.
struct DemonstrationSet {
  std::vector<std::string> columns;  ///< D signal names
  std::vector<Demonstration> demonstrations;
};

/// @throws DataError [trajectory.too_short] under two samples, [trajectory.not_finite], [trajectory.time_not_rising],
///         [trajectory.shape] if times and positions differ in length
void check(const Trajectory& trajectory);

/// n equally spaced values from first to last, both exact. @param n  at least 2
[[nodiscard]] Vector linspace(double first, double last, Eigen::Index n);

}  // namespace lfd
