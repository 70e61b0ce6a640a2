#include "lfdtools/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "march.hpp"

namespace lfd {
namespace {

/// The quintic of the docstring; 0 before and 1 after.
double blended(double r) {
  r = std::clamp(r, 0.0, 1.0);
  return r * r * r * (10 - 15 * r + 6 * r * r);
}

/// s w: the scaled weights of a goal.
Matrix scaled_weights(const Dmp& primitive, const Vector& goal, const Matrix& weights) {
  if (primitive.settings.scaling == DmpScaling::none) return weights;
  return (goal - primitive.start).asDiagonal() * weights;
}

double last_event(const Course& course) {
  return course.changes.empty() ? 0.0 : course.changes.back().time / course.primitive.tau + course.blend;
}

}  // namespace

void check(const Course& course) {
  check(course.primitive);
  const Eigen::Index D = course.primitive.dimensions();
  const auto same = [&](const GoalChange& change) {
    return change.goal.size() == D && change.weights.rows() == D &&
           change.weights.cols() == course.primitive.settings.bases();
  };
  if ((course.start_velocity.size() != 0 && course.start_velocity.size() != D) ||
      !std::all_of(course.changes.begin(), course.changes.end(), same)) {
    throw DataError("course.shape", "speed, goals or weights of a course do not fit its primitive");
  }
  if (!course.start_velocity.allFinite()) throw DataError("course.not_finite", "the speed is not a finite number");
  if (!(course.blend > 0)) throw DataError("course.times", "a change of goal must take some time");
  double last = 0;
  for (const GoalChange& change : course.changes) {
    if (!change.goal.allFinite() || !change.weights.allFinite()) {
      throw DataError("course.not_finite", "a goal or its weights have a value that is not a finite number");
    }
    if (!(change.time > last) || !(change.time < 100 * course.primitive.tau)) {
      throw DataError("course.times", fmt::format("a change of goal at {} s: the times must be positive, rise, and lie "
                                                  "under 100 durations of {} s",
                                                  change.time, course.primitive.tau));
    }
    last = change.time;
  }
}

Motion rollout(const Course& course, const Vector& times) {
  if (course.plain()) return rollout(course.primitive, times);
  check(course);
  const Dmp& dmp = course.primitive;
  const double tau = dmp.tau;
  check_times(times);
  const Basis basis = dmp.settings.basis();
  const Matrix W0 = scaled_weights(dmp, dmp.goal, dmp.weights);
  std::vector<double> begins;
  std::vector<double> knots;
  std::vector<Matrix> W_steps;  // W_k - W_(k-1)
  std::vector<Vector> G_steps;  // G_k - G_(k-1)
  Vector G = dmp.goal;
  Matrix W = W0;
  for (const GoalChange& change : course.changes) {
    const Matrix W_k = scaled_weights(dmp, change.goal, change.weights);
    W_steps.push_back(W_k - W);
    G_steps.push_back(change.goal - G);
    W = W_k;
    G = change.goal;
    begins.push_back(change.time / tau);
    knots.push_back(change.time / tau);
    knots.push_back(change.time / tau + course.blend);
  }
  const double k_spring = dmp.settings.alpha_z * dmp.settings.beta_z;
  // The deviation is that from the last goal, so the distance of g(t) from it pulls like a force.
  const auto forcing = [&](double s, double x) -> Vector {
    const Vector a = x * normalized_activations(basis, x);
    Vector force = W0 * a;
    for (std::size_t k = 0; k < begins.size(); ++k) {
      const double b = blended((s - begins[k]) / course.blend);
      if (b > 0) force += b * (W_steps[k] * a);
      if (b < 1) force -= ((1 - b) * k_spring) * G_steps[k];
    }
    return force;
  };
  const Vector rate = course.start_velocity.size() > 0 ? Vector(tau * course.start_velocity) : Vector();
  March march(dmp.settings, forcing, dmp.start - G, rate, knots);
  const Eigen::Index T = times.size();
  const Eigen::Index D = dmp.dimensions();
  Motion motion{times, Samples(T, D), Samples(T, D), Samples(T, D)};
  for (Eigen::Index k = 0; k < T; ++k) {
    march.to(times[k] / tau);
    motion.positions.row(k) = (G + march.e).transpose();
    motion.velocities.row(k) = march.v.transpose() / tau;
    motion.accelerations.row(k) = march.acceleration().transpose() / (tau * tau);
  }
  return motion;
}

double settle_time(const Course& course, const SettleOptions& options) {
  if (course.plain()) return settle_time(course.primitive, options);
  check(course);
  const Dmp& dmp = course.primitive;
  const double tau = dmp.tau;
  const Spring spring = dmp.settings.spring();
  // From `begin` on the equation is that of a primitive for the last goal; its horizon, and time for what the change
  // and the speed have left (as large as metres), which vanishes by exp(-25).
  Dmp last = dmp;
  last.goal = course.goal();
  if (!course.changes.empty()) last.weights = course.changes.back().weights;
  const double begin = std::max(1.0, last_event(course));
  const double force = (last.scale().asDiagonal() * last.weights).cwiseAbs().maxCoeff();
  const double still =
      0.01 * options.tolerance * spring.alpha_z * spring.beta_z * spring.slow_rate() / spring.fast_rate();
  const double faded = force > still ? dmp.settings.canonical().relative_time(still / force) : 0.0;
  const double horizon = std::max(begin, faded) + 25 / spring.slow_rate();
  if (horizon > 200) throw DataError("dmp.does_not_settle", "the motion needs more than 200 durations to come to rest");
  const auto K = static_cast<Eigen::Index>(std::ceil((horizon - begin) * options.samples)) + 1;
  Vector times(K);
  for (Eigen::Index k = 0; k < K; ++k) times[k] = tau * begin + tau * static_cast<double>(k) / options.samples;
  const Motion motion = rollout(course, times);
  Eigen::Index settled = K;
  while (settled > 0) {
    const Eigen::Index k = settled - 1;
    const double distance = (motion.positions.row(k).transpose() - last.goal).cwiseAbs().maxCoeff();
    const double speed = motion.velocities.row(k).cwiseAbs().maxCoeff();
    if (distance > options.tolerance || speed > options.speed_tolerance) break;
    settled = k;
  }
  if (settled == K) throw DataError("dmp.does_not_settle", "the motion does not come to rest on its goal");
  return times[settled];
}

Motion generate(const Course& course, std::optional<double> dt) {
  const double step = dt.value_or(course.primitive.tau / 200);
  SettleOptions settled;
  // Of each axis, so that the distance is within the tolerance.
  settled.tolerance /= std::sqrt(static_cast<double>(course.primitive.dimensions()));
  const double count = std::ceil(settle_time(course, settled) / step - 1e-9);
  if (!(count < 1e7)) throw DataError("skill.dt", "the time step makes over 10^7 samples");
  Vector times(static_cast<Eigen::Index>(count) + 1);
  for (Eigen::Index i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) * step;
  return rollout(course, times);
}

}  // namespace lfd
