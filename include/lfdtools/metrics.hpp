// Figures of a motion: how far from another, how it arrives, how smooth it is. Used by validation and by
// motion-compare.
#pragma once

#include "lfdtools/trajectory.hpp"

namespace lfd {

/// Motions are compared, and methods judged, at this many equally spaced phases s in [0, 1].
inline constexpr Eigen::Index phase_count = 200;

/// The path at n equally spaced phases s in [0, 1] of the given duration, n x D (cubic spline; after the last sample
/// the motion rests). Phases are linear in time, so nothing is aligned.
/// @param duration  seconds that s = 1 stands for; 0: the whole trajectory
[[nodiscard]] Samples at_phases(const Trajectory& trajectory, Eigen::Index n, double duration = 0.0);

/// Mean path of several trajectories at n equally spaced phases, n x D.
/// @throws DataError [metrics.no_trajectory] for an empty list
[[nodiscard]] Samples mean_path(const std::vector<Trajectory>& trajectories, Eigen::Index n);

/// Root mean square over samples of the Euclidean distance between two paths of equal shape.
[[nodiscard]] double rms_distance(const Samples& a, const Samples& b);

/// The last stretch of a path, from where it last enters the ball of `radius` about its end.
struct Arrival {
  Vector end;        ///< D
  Vector direction;  ///< unit vector from the entry point to the end, D; zero if the path never leaves the ball
};

/// @param radius  [m]; 0.02 for insertion
[[nodiscard]] Arrival arrival(const Samples& path, double radius = 0.02);

/// Angle between two directions of arrival [rad], from 0 to pi.
[[nodiscard]] double angle_between(const Vector& a, const Vector& b);

/// Largest distance [m] of the path's last stretch (inside the ball of `radius` about `line.end`) from the straight
/// line through line.end along line.direction.
[[nodiscard]] double lateral_deviation(const Samples& path, const Arrival& line, double radius = 0.02);

/// How far the path goes beyond line.end along line.direction, at the most [m]; 0 if it never does.
[[nodiscard]] double overshoot(const Samples& path, const Arrival& line);

/// Root mean square of the third time derivative [m/s^3]: third differences on n equally spaced times.
/// @param duration  seconds that the path takes
[[nodiscard]] double rms_jerk(const Samples& path, double duration);

/// Length of the polygon through the samples [m].
[[nodiscard]] double path_length(const Samples& path);

}  // namespace lfd
