// What a skill knows about a motion: its mean, how far it may be off, and the motion nearest to it that meets a demand.
#pragma once

#include "lfdtools/calibration.hpp"
#include "lfdtools/course.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill.hpp"

namespace lfd {

/// Of what a spread speaks.
enum class Spread {
  latent,     ///< the intention: what the mean of many demonstrations would be
  predictive  ///< one demonstration: latent, and the noise_variance of one beside it
};

/// The weights of one process, paper eq. (25)-(27) with Omega integrated out: given Omega they are normal with
/// covariances k^ Omega (latent) and sigma_n^2 Omega (the noise of one demonstration), and Omega has its posterior; so
/// a row is multivariate Student-t with nu + n - d + 1 degrees of freedom. Covariances are kept as factors, which
/// conditioning multiplies by projections: no variance turns negative. Hyperparameters are taken as known.
struct PosteriorBlock {
  std::vector<int> outputs;  ///< signals, from 0; weights by signal, then by basis: d
  Matrix latent;             ///< F, d x r: covariance F F^T
  Matrix noise;              ///< E, d x r: covariance E E^T
  double degrees_of_freedom = 0;
};

/// A position that the motion shall have.
struct Waypoint {
  double time = 0;  ///< [s]
  Vector position;  ///< D [m]
  double sd = 0;    ///< how exactly, on each axis [m]; 0: exactly
};

/// Demands on a motion. The end, y(tau) = g, is one by itself where the rows of the skill meet it (the mean misses by
/// under 1e-6 m), and always beside other demands.
struct MotionConstraints {
  std::vector<Waypoint> via;             ///< in (0, tau)
  std::optional<Vector> start_velocity;  ///< y'(0), D [m/s]: decays with the spring, and the demands make up for it
  std::optional<Vector> end_velocity;    ///< y'(tau), D [m/s]

  [[nodiscard]] bool empty() const { return via.empty() && !start_velocity && !end_velocity; }
};

/// A motion and its posterior. y = y_free + s R w is linear in w, so mean and covariance are exact.
struct MotionPosterior {
  Course course;                       ///< with the mean of the weights
  std::vector<PosteriorBlock> blocks;  ///< independent of each other
  bool constrained = false;            ///< there were demands beside the end
  int teacher = -1;                    ///< Reach::teacher
  bool ends_on_goal = false;           ///< y(tau) = g was demanded: no spread there
  double distance = 0;                 ///< Mahalanobis distance of the demands from the prediction, latent [1]
};

/// Predicts the motion for a goal and conditions it on the demands. With H the rows of s R (or s R') that they speak
/// of, e what they ask beyond the mean, S their variances and C = F F^T,
///     w <- w + C H^T (H C H^T + S)^-1 e,   C <- c (C - C H^T (H C H^T + S)^-1 H C)
/// the smallest change in the metric of C; met to 1e-9 m where S = 0. c = (nu' - 2 + delta) / (nu' + k - 2) and nu' + k
/// degrees of freedom make it the conditional Student-t, with delta the squared Mahalanobis distance of k demands. For
/// the end (delta = 0) that is the posterior of the same prior on the weights that end on the goal. The noise of a
/// demonstration meets exact demands too, and knows nothing of the others.
/// @throws DataError [posterior.no_variance] with 2 degrees of freedom or fewer; [posterior.via_time];
///         [posterior.unreachable] where demands contradict each other or ask for a direction without variance, with
///         what is left [m]; those of SkillPredictor
[[nodiscard]] MotionPosterior predict_motion(const SkillPredictor& predictor, const Goal& goal,
                                             const MotionConstraints& constraints = {});

/// sqrt(s r_t C r_t^T s), T x D [m]; for a Student-t the standard deviation, not the scale.
[[nodiscard]] Samples standard_deviation(const MotionPosterior& posterior, const Vector& times, Spread spread);

/// Covariance of a whole motion [m^2]: one matrix T x T a signal where every process speaks for one signal; else one
/// matrix D T x D T, by signal, then by time.
[[nodiscard]] std::vector<Matrix> motion_covariance(const MotionPosterior& posterior, const Vector& times,
                                                    Spread spread);

/// One draw: the weights' normal deviation over sqrt(chi^2 / nu), one chi^2 a process. It meets the exact demands.
[[nodiscard]] Course draw(const MotionPosterior& posterior, Spread spread, Random& random);

/// Half-widths of a band about the mean that holds the intention as far as the process is right, T x D [m]: latent
/// scales times the quantile of Student's t at each time on each axis, or, for the whole path up to tau on all axes,
/// the quantile of the largest ratio of deviation to scale along the motion, from 4000 seeded draws.
[[nodiscard]] Samples band(const MotionPosterior& posterior, const Vector& times, BandKind kind, double level = 0.95);

/// The band of a motion, T x D [m]: that of the skill's calibration (calibration.hpp), which has been held against
/// targets left out; narrowed where demands were made, by the ratio of the latent sd with them to that without. Of a
/// skill that is not calibrated, the process's own above.
[[nodiscard]] Samples motion_band(const SkillPredictor& predictor, const MotionPosterior& posterior,
                                  const Vector& times, BandKind kind, double level = 0.95);

/// What a goal that is not exactly known adds to the covariance of a motion, weights, end and demands included, at
/// fixed tau. With G_i the columns of a root of Goal::covariance, column i is (y(g + G_i) - y(g - G_i)) / 2: dy/dg G_i
/// where the prediction is straight over one standard deviation of the goal, its chord where it is not.
struct GoalSpread {
  std::vector<Matrix> factors;  ///< by signal, T x D [m]; empty: the goal is exactly known

  /// T x D [m^2]; `like`: of that shape.
  [[nodiscard]] Samples variance(const Samples& like) const;
};
[[nodiscard]] GoalSpread goal_spread(const SkillPredictor& predictor, const Goal& goal,
                                     const MotionConstraints& constraints, const Vector& times);

}  // namespace lfd
