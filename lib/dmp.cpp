#include "lfdtools/dmp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "march.hpp"

namespace lfd {
namespace {

void check_duration(double tau) {
  if (!(tau > 0) || !std::isfinite(tau)) {
    throw DataError("dmp.duration", fmt::format("the duration is {} s, not a positive number", tau));
  }
}

}  // namespace

bool operator==(const DmpSettings& a, const DmpSettings& b) {
  return a.scaling == b.scaling && a.alpha_z == b.alpha_z && a.beta_z == b.beta_z && a.alpha_x == b.alpha_x &&
         a.centers.size() == b.centers.size() && a.widths.size() == b.widths.size() && a.centers == b.centers &&
         a.widths == b.widths;
}

Vector Dmp::scale() const {
  return settings.scaling == DmpScaling::goal ? Vector(goal - start) : Vector(Vector::Ones(start.size()));
}

DmpSettings make_dmp_settings(Eigen::Index bases, DmpScaling scaling, double alpha_z, std::optional<double> beta_z,
                              double alpha_x) {
  Basis basis = make_basis(bases, {alpha_x});
  DmpSettings settings{
      scaling, alpha_z, beta_z.value_or(alpha_z / 4), alpha_x, std::move(basis.centers), std::move(basis.widths)};
  check(settings);
  return settings;
}

void check(const DmpSettings& settings) {
  check(settings.canonical());
  check(settings.spring());
  check(settings.basis());
}

void check(const Dmp& dmp) {
  check(dmp.settings);
  check_duration(dmp.tau);
  const Eigen::Index D = dmp.start.size();
  const Eigen::Index N = dmp.settings.bases();
  if (D == 0 || dmp.goal.size() != D || dmp.weights.rows() != D || dmp.weights.cols() != N) {
    throw DataError("dmp.shape", fmt::format("start of {} axes, goal of {}, weights {} x {}, {} basis functions", D,
                                             dmp.goal.size(), dmp.weights.rows(), dmp.weights.cols(), N));
  }
  if (!dmp.start.allFinite() || !dmp.goal.allFinite() || !dmp.weights.allFinite()) {
    throw DataError("dmp.not_finite", "start, goal or weights have a value that is not a finite number");
  }
}

Motion rollout(const Dmp& dmp, const Vector& times) {
  check(dmp);
  check_times(times);
  const double tau = dmp.tau;
  const Matrix W = dmp.scale().asDiagonal() * dmp.weights;
  const Basis basis = dmp.settings.basis();
  // Paper eq. (12) and (24), all axes at once.
  const auto forcing = [&](double, double x) -> Vector { return W * (x * normalized_activations(basis, x)); };
  March march(dmp.settings, forcing, dmp.start - dmp.goal);
  const Eigen::Index T = times.size();
  const Eigen::Index D = dmp.dimensions();
  Motion motion{times, Samples(T, D), Samples(T, D), Samples(T, D)};
  for (Eigen::Index k = 0; k < T; ++k) {
    march.to(times[k] / tau);
    motion.positions.row(k) = (dmp.goal + march.e).transpose();
    motion.velocities.row(k) = march.v.transpose() / tau;
    motion.accelerations.row(k) = march.acceleration().transpose() / (tau * tau);
  }
  return motion;
}

Motion free_response(const DmpSettings& settings, double tau, const Vector& times, const Vector& start,
                     const Vector& goal) {
  check(settings);
  check_duration(tau);
  check_times(times);
  if (start.size() != goal.size()) {
    throw DataError("dmp.shape", fmt::format("start of {} axes, goal of {}", start.size(), goal.size()));
  }
  const Spring spring = settings.spring();
  const Eigen::Index T = times.size();
  const Eigen::RowVectorXd e0 = (start - goal).transpose();
  Motion motion{times, Samples(T, e0.size()), Samples(T, e0.size()), Samples(T, e0.size())};
  for (Eigen::Index k = 0; k < T; ++k) {
    const SpringStep A = spring.step(times[k] / tau);
    motion.positions.row(k) = goal.transpose() + A.ee * e0;
    motion.velocities.row(k) = (A.ve / tau) * e0;
    motion.accelerations.row(k) = -settings.alpha_z * (settings.beta_z * A.ee + A.ve) / (tau * tau) * e0;
  }
  return motion;
}

DmpResponse response(const DmpSettings& settings, double tau, const Vector& times) {
  check(settings);
  check_duration(tau);
  check_times(times);
  const Basis basis = settings.basis();
  const Eigen::Index T = times.size();
  const Eigen::Index N = basis.size();
  const auto forcing = [&](double, double x) -> Vector { return x * normalized_activations(basis, x); };
  March march(settings, forcing, Vector::Zero(N));
  DmpResponse R{Matrix(T, N), Matrix(T, N), Matrix(T, N)};
  for (Eigen::Index k = 0; k < T; ++k) {
    march.to(times[k] / tau);
    R.position.row(k) = march.e.transpose();
    R.velocity.row(k) = march.v.transpose() / tau;
    R.acceleration.row(k) = march.acceleration().transpose() / (tau * tau);
  }
  return R;
}

Matrix response_matrix(const DmpSettings& settings, double tau, const Vector& times) {
  return response(settings, tau, times).position;
}

double settle_time(const Dmp& dmp, const SettleOptions& options) {
  check(dmp);
  const double tau = dmp.tau;
  const Spring spring = dmp.settings.spring();
  const double k_spring = spring.alpha_z * spring.beta_z;
  // A force of at most F moves the spring by at most F / k_spring, times fast / slow rate where it overshoots. The grid
  // reaches to where that is 1 % of the tolerance, and ten time constants further.
  const double force = (dmp.scale().asDiagonal() * dmp.weights).cwiseAbs().maxCoeff();
  const double still = 0.01 * options.tolerance * k_spring * spring.slow_rate() / spring.fast_rate();
  const double faded = force > still ? dmp.settings.canonical().relative_time(still / force) : 0.0;
  const double horizon = std::max(1.0, faded) + 10 / spring.slow_rate();
  if (horizon > 100) throw DataError("dmp.does_not_settle", "the motion needs more than 100 durations to come to rest");
  const auto K = static_cast<Eigen::Index>(std::ceil((horizon - 1) * options.samples)) + 1;
  Vector times(K);
  for (Eigen::Index k = 0; k < K; ++k) times[k] = tau + tau * static_cast<double>(k) / options.samples;
  const Motion motion = rollout(dmp, times);
  Eigen::Index settled = K;
  while (settled > 0) {
    const Eigen::Index k = settled - 1;
    const double distance = (motion.positions.row(k).transpose() - dmp.goal).cwiseAbs().maxCoeff();
    const double speed = motion.velocities.row(k).cwiseAbs().maxCoeff();
    if (distance > options.tolerance || speed > options.speed_tolerance) break;
    settled = k;
  }
  if (settled == K) throw DataError("dmp.does_not_settle", "the motion does not come to rest on its goal");
  return times[settled];
}

}  // namespace lfd
