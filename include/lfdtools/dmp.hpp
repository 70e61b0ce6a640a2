// Dynamic movement primitives: the model, its motion in time, and how the motion depends on the weights.
#pragma once

#include <optional>
#include <vector>

#include "lfdtools/basis.hpp"
#include "lfdtools/canonical.hpp"
#include "lfdtools/linalg.hpp"
#include "lfdtools/spring.hpp"

namespace lfd {

/// The factor s of the forcing term.
enum class DmpScaling {
  none,  ///< s = 1: weights are forces
  goal   ///< s = g - y0 per axis, paper eq. (12)
};

/// How the weights were found (dmp_fit.hpp).
enum class DmpFitMethod {
  trajectory,  ///< least squares on positions
  ls,          ///< joint least squares on the forcing term, paper eq. (14)
  lwr          ///< locally weighted regression, one weight at a time: the paper's
};

/// What primitives must share so that their weights may be compared: everything but the motion itself.
struct DmpSettings {
  DmpScaling scaling = DmpScaling::none;
  double alpha_z = 25;                                ///< damping [1]
  double beta_z = alpha_z / 4;                        ///< stiffness over damping [1]
  double alpha_x = CanonicalSystem::default_alpha_x;  ///< decay of the phase [1]
  Vector centers;                                     ///< N, in phase [1]
  Vector widths;                                      ///< N, sigma_i of paper eq. (13) [1]

  [[nodiscard]] Eigen::Index bases() const { return centers.size(); }
  [[nodiscard]] Basis basis() const { return {centers, widths}; }
  [[nodiscard]] CanonicalSystem canonical() const { return {alpha_x}; }
  [[nodiscard]] Spring spring() const { return {alpha_z, beta_z}; }
  friend bool operator==(const DmpSettings& a, const DmpSettings& b);
};

/// tau^2 y'' = alpha_z (beta_z (g - y) - tau y') + f, paper eq. (10) and (11), with f of eq. (12) and (24), for each of
/// D axes; y(0) = start, y'(0) = 0.
struct Dmp {
  DmpSettings settings;
  double tau = 1;                               ///< duration [s]
  Vector start;                                 ///< y0, D [m]
  Vector goal;                                  ///< g, D [m]
  Matrix weights;                               ///< D x N
  Vector rmse;                                  ///< D, root mean square error of the reproduction [m]
  DmpFitMethod fit = DmpFitMethod::trajectory;  ///< where the weights come from
  std::vector<Matrix> weights_covariance;       ///< D of N x N, or empty

  [[nodiscard]] Eigen::Index dimensions() const { return start.size(); }
  /// s of the forcing term, D: ones, or goal - start.
  [[nodiscard]] Vector scale() const;
};

/// A motion with its derivatives.
struct Motion {
  Vector times;           ///< T [s]
  Samples positions;      ///< T x D [m]
  Samples velocities;     ///< T x D [m/s]
  Samples accelerations;  ///< T x D [m/s^2]
};

/// Default settings with N basis functions (basis.hpp: make_basis).
/// @param beta_z  alpha_z / 4 if not given
/// @throws DataError [dmp.basis], [dmp.spring], [dmp.alpha_x]
[[nodiscard]] DmpSettings make_dmp_settings(Eigen::Index bases = 15, DmpScaling scaling = DmpScaling::none,
                                            double alpha_z = 25, std::optional<double> beta_z = {},
                                            double alpha_x = CanonicalSystem::default_alpha_x);

/// @throws DataError [dmp.basis], [dmp.spring], [dmp.alpha_x]
void check(const DmpSettings& settings);
/// @throws DataError as check(DmpSettings); [dmp.shape] where sizes disagree, [dmp.not_finite], [dmp.duration] unless
///         tau is positive
void check(const Dmp& dmp);

/// The motion at the given times. The deviation from the goal is carried by the exact solution of the spring and a
/// Gauss-Legendre quadrature of the forcing term over a grid of its own, and from the grid by a partial step to each
/// time: the result at a time does not depend on the other times asked for.
/// @param times  T, from 0, not falling [s]; beyond tau the motion goes on
/// @throws DataError as check(Dmp); [dmp.times]
[[nodiscard]] Motion rollout(const Dmp& dmp, const Vector& times);

/// Motion without a forcing term, from rest at `start` towards `goal` (D each). @throws DataError [dmp.times], ...
[[nodiscard]] Motion free_response(const DmpSettings& settings, double tau, const Vector& times, const Vector& start,
                                   const Vector& goal);

/// What each weight of a primitive of unit scale adds to the motion. With s the scale of an axis and w its weights,
///     y = y_free + s position w,  y' = y_free' + s velocity w,  y'' = y_free'' + s acceleration w.
struct DmpResponse {
  Matrix position;      ///< R, T x N
  Matrix velocity;      ///< R', T x N [1/s]
  Matrix acceleration;  ///< R'', T x N [1/s^2]
};

/// @param times  T, from 0, not falling [s]. The position response depends on times / tau alone.
/// @throws DataError as check(DmpSettings); [dmp.times], [dmp.duration]
[[nodiscard]] DmpResponse response(const DmpSettings& settings, double tau, const Vector& times);
/// R alone, T x N: the position of `response`.
[[nodiscard]] Matrix response_matrix(const DmpSettings& settings, double tau, const Vector& times);

/// When a motion may end.
struct SettleOptions {
  double tolerance = 1e-4;        ///< greatest distance of each axis from its goal [m]
  double speed_tolerance = 1e-3;  ///< greatest speed of each axis [m/s]
  int samples = 200;              ///< the search looks at tau + k tau / samples, k = 0, 1, ...
};

/// The first time of the search grid, tau or later, from which on every sample of the grid lies within the tolerances.
/// The grid goes on until what is left of forcing term and spring cannot leave them any more.
/// @throws DataError as check(Dmp); [dmp.does_not_settle] if that takes more than 100 tau
[[nodiscard]] double settle_time(const Dmp& dmp, const SettleOptions& options = {});

}  // namespace lfd
