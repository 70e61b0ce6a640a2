// Demonstrations that an experiment file describes in full: what the teacher means to do, and the noise around it.
//
// Intention for a goal g at phase s, with mj(s) = 10 s^3 - 15 s^4 + 6 s^5 (minimum jerk):
//   y(s) = y0 + mj(s) (g - y0) + sum over axes of e_d A_d(g) sin^2(pi s^a_d)
//             + c sin^2(pi s^a_c) + w B_w(g) sin^2(pi s^a_w)
// with a bump a signal (A_d), the approach (c), and the berth of an obstacle (B_w) along the way w round it.
// At s -> 1 minimum jerk is cubic and a bump quadratic in 1 - s, so the hand arrives against
//   sum of e_d A_d a_d^2 + c a_c^2 + w B_w a_w^2:
// a late approach (a_c = 3) along the hole's axis outweighs the others and is the direction of arrival.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/linalg.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// A place to reach.
struct Hole {
  std::string target;  ///< label: integer or word
  Vector position;     ///< D [m]
};

/// amplitude sin(rates . (g - origin) + phase)
struct SineTerm {
  double amplitude = 0;  ///< [m]
  Vector rates;          ///< D [rad/m]
  double phase = 0;      ///< [rad]
};

/// amplitude exp(-|g - center|^2 / (2 width^2))
struct GaussianTerm {
  double amplitude = 0;  ///< [m]
  Vector center;         ///< D [m]
  double width = 0.1;    ///< [m]
};

/// The bump of one signal: its size as a function of the goal g, with u = g - origin,
///   A(g) = constant + linear . u + u^T quadratic u + sum of sine and Gaussian terms
/// Empty vectors and matrices are zero.
struct Bump {
  double exponent = 1;  ///< a in sin^2(pi s^a): 1 symmetric, over 1 late; greater than 0.5
  double constant = 0;  ///< [m]
  Vector linear;        ///< D [m/m]
  Matrix quadratic;     ///< D x D [1/m]
  std::vector<SineTerm> sines;
  std::vector<GaussianTerm> gaussians;
};

/// How the hand comes to the hole.
struct Approach {
  Vector offset;        ///< D [m], out of the hole along its axis; empty: none
  double exponent = 3;  ///< over 1: late
};

/// What only the demonstrator knows: a sphere, or a cylinder without end, and the ways round it. The berth is what
/// keeps the hand R = radius + clearance from the middle wherever b(s) = sin^2(pi s^a) >= 0.2. With r(s) from the
/// middle to the hand without berth (across the axis), rho its part across the way w, and h = softness:
///   B(g) = (sum over s of x(s)^32)^(1/32),  65 phases,  x = q softplus(R exp(-rho^2 / 2 R^2) - r . w) / b
///   softplus(z) = (z + sqrt(z^2 + h^2)) / 2,  q = 1 where rho <= R, else exp(-2 (rho / R - 1)^2)
/// Smooth in g. An obstacle right beside an end, where b is small, asks for a huge berth, and may get less than it
/// needs: 65 phases are then too coarse. How much clearance the whole arm needs is for the experiment to say.
struct Obstacle {
  Vector center;             ///< D [m]
  Vector axis;               ///< D, direction of the cylinder; empty: a sphere
  double radius = 0.05;      ///< [m]
  double clearance = 0.05;   ///< [m]
  double softness = 0.01;    ///< h [m]
  double exponent = 1;       ///< a of this bump
  std::vector<Vector> ways;  ///< directions of passing, D each; of several, each demonstration draws one
};

/// The teacher's noise, each kind drawn from a stream of its own.
struct TeacherNoise {
  double duration_sd = 0.4;  ///< [s]; durations stay within a third and thrice the mean
  double tempo_sd = 0.05;    ///< s -> s + c sin(pi s), c ~ N(0, sd^2) cut at +-0.3: the hand is early or late by c
  Vector wander_sd =
      default_wander();       ///< [m] of the half-waves sin(k pi s), k = 1, 2, ..., each axis; zero at both ends
  double tremor_sd = 0.0005;  ///< [m] white, each sample but the first and the last: the peg is held there

  [[nodiscard]] static Vector default_wander();  ///< 6 mm and 4 mm
};

/// One demonstration of a motion: what is meant, at phases that are early or late, with wander and tremor, for a
/// duration about the mean.
/// @param meant  positions at phases, n -> n x D [m]   @param mean  duration [s]   @param rate  [Hz]
[[nodiscard]] Trajectory perform(const std::function<Samples(const Vector& phases)>& meant, double mean, double rate,
                                 const TeacherNoise& noise, const Random& stream);

/// Everything about an experiment.
struct Experiment {
  std::string name;
  std::vector<std::string> columns = {"x", "y", "z"};  ///< D signals
  Vector start;                                        ///< y0, D [m]
  std::vector<Hole> holes;                             ///< demonstrated
  std::vector<Hole> new_holes;                         ///< to generate for
  Eigen::Index repetitions = 10;                       ///< demonstrations a hole
  std::uint64_t seed = 1;
  double duration_mean = 3;  ///< [s]
  double rate = 100;         ///< [Hz]
  TeacherNoise noise;
  Vector origin;            ///< of u in Bump, D [m]; empty: zero
  std::vector<Bump> bumps;  ///< one a signal, or none at all
  Approach approach;
  std::optional<Obstacle> obstacle;
};

/// @throws DataError [synthesis.shape] where a length differs from D, [synthesis.not_finite], [synthesis.value] out of
/// range,
///         [synthesis.repeated_target] [synthesis.no_holes], [synthesis.way] along the axis,
///         [synthesis.end_in_obstacle]
void check(const Experiment& experiment);

/// Sizes A_d(g) of the bumps, D [m].
[[nodiscard]] Vector bump_sizes(const Experiment& experiment, const Vector& goal);

/// Size B_w(g) of the berth along way number `way` [m]; 0 without an obstacle.
[[nodiscard]] double berth(const Experiment& experiment, const Vector& goal, std::size_t way = 0);

/// What the teacher means: positions without noise, n x D [m]; exactly the start at phase 0 and the goal at phase 1.
/// @param phases  n in [0, 1]   @param way  which of the obstacle's ways, from 0
/// @throws as check(Experiment), DataError [synthesis.value] for phases outside [0, 1] or an unknown way
[[nodiscard]] Samples intention(const Experiment& experiment, const Vector& goal, const Vector& phases,
                                std::size_t way = 0);

/// The way that a repetition (from 1) at a target takes.
[[nodiscard]] std::size_t way_taken(const Experiment& experiment, const std::string& target, Eigen::Index repetition);

/// All demonstrations, by hole, then by repetition (label `demo`, from 1). The noise of a demonstration depends on the
/// seed, its target's name and its repetition alone, so that other holes or more repetitions do not change it.
/// @throws as check(Experiment)
[[nodiscard]] DemonstrationSet synthesize(const Experiment& experiment);

}  // namespace lfd
