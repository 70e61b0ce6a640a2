#include "lfdtools/dmp_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

// Tikhonov term of the least squares, relative to the squared Frobenius norm of the rows of the samples: enough to keep
// weights that move nothing from growing, too little to be seen in the motion.
constexpr double ridge = 1e-12;
// The end row outweighs the samples so far that y(tau) = g holds to rounding, yet a basis that cannot reach the goal
// (a phase that is zero at tau) does not force weights without bound, as an equality would.
constexpr double end_weight = 1e5;
constexpr double hold_durations = 2;  // how long after tau the motion is held
constexpr Eigen::Index hold_rows = 40;
constexpr double sd_floor = 0.01;  // of the largest of the axis

// Everything the fits share: samples with times from 0, and the ends.
struct Problem {
  Trajectory demo;
  DmpSettings settings;
  double tau;
  Vector y0;
  Vector g;
};

struct Weights {
  Matrix w;                        // N x D, of unit scale
  std::vector<Matrix> covariance;  // D of N x N, of unit scale
};

void check_end(const std::optional<Vector>& end, Eigen::Index D, const char* name) {
  if (!end) return;
  if (end->size() != D) {
    throw DataError("dmp.shape", fmt::format("{} of {} axes for a trajectory of {}", name, end->size(), D));
  }
  if (!end->allFinite()) throw DataError("dmp.not_finite", fmt::format("the {} is not finite", name));
}

void check_sd(const Samples& sd, const Trajectory& demo) {
  if (sd.size() == 0) return;
  if (sd.rows() != demo.samples() || sd.cols() != demo.dimensions()) {
    throw DataError("dmp.shape", fmt::format("standard deviations {} x {} for samples {} x {}", sd.rows(), sd.cols(),
                                             demo.samples(), demo.dimensions()));
  }
  if (!sd.allFinite() || sd.minCoeff() < 0) {
    throw DataError("dmp.not_finite", "a standard deviation is negative or not a finite number");
  }
}

// psi_i alone against the forcing term, one weight at a time, as the paper names it:
// w_i = sum_k psi_i(x_k) xi_k f_k / sum_k psi_i(x_k) xi_k^2 with xi = x s.
Matrix fit_lwr(const Problem& p) {
  const Vector x = p.settings.canonical().phase(p.demo.times, p.tau);
  const Samples f = forcing_target(p.demo, p.settings.spring(), p.g);
  const Basis basis = p.settings.basis();
  Matrix numerator = Matrix::Zero(basis.size(), f.cols());
  Vector denominator = Vector::Zero(basis.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Vector psi = activations(basis, x[k]);
    numerator += x[k] * psi * f.row(k);
    denominator += x[k] * x[k] * psi;
  }
  Matrix w = Matrix::Zero(basis.size(), f.cols());
  for (Eigen::Index i = 0; i < w.rows(); ++i) {
    // A function that no sample excites keeps the weight 0.
    if (denominator[i] > 1e-300) w.row(i) = numerator.row(i) / denominator[i];
  }
  return w;
}

// min |A w - B|^2 + ridge size^2 |w|^2 by a QR decomposition of the rows of both.
class RidgeLeastSquares {
 public:
  RidgeLeastSquares(const Matrix& A, double size) : rows_(A.rows()) {
    Matrix stacked(A.rows() + A.cols(), A.cols());
    stacked << A, std::sqrt(ridge) * size * Matrix::Identity(A.cols(), A.cols());
    qr_.compute(stacked);
  }
  [[nodiscard]] Matrix solve(const Matrix& B) const {
    Matrix stacked = Matrix::Zero(rows_ + qr_.cols(), B.cols());
    stacked.topRows(rows_) = B;
    return qr_.solve(stacked);
  }
  // (A^T A + ridge term)^-1 = U^-1 U^-T of the triangle U of the decomposition.
  [[nodiscard]] Matrix inverse_normal() const {
    const Eigen::Index N = qr_.cols();
    const Matrix U = qr_.matrixQR().topRows(N).triangularView<Eigen::Upper>();
    const Matrix inverse = U.triangularView<Eigen::Upper>().solve(Matrix::Identity(N, N));
    return inverse * inverse.transpose();
  }

 private:
  Eigen::Index rows_;
  Eigen::HouseholderQR<Matrix> qr_;
};

// All weights together against the forcing term of eq. (14).
Matrix fit_ls(const Problem& p) {
  const Vector x = p.settings.canonical().phase(p.demo.times, p.tau);
  const Samples f = forcing_target(p.demo, p.settings.spring(), p.g);
  const Matrix Phi = forcing_features(p.settings.basis(), x);
  return RidgeLeastSquares(Phi, Phi.norm()).solve(f);
}

// Rows of the trajectory fit: the end first (heavy rows first keep the decomposition accurate), then the samples, then
// the hold after tau. The hold has as many samples a second as the trajectory, and their weight is a factor.
struct Rows {
  Matrix A;
  Matrix B;
};

Rows trajectory_rows(const Problem& p, double hold_weight) {
  const Eigen::Index T = p.demo.samples();
  const Eigen::Index H = hold_weight > 0 ? hold_rows : 0;
  Vector times(T + H);
  times.head(T) = p.demo.times;
  for (Eigen::Index k = 0; k < H; ++k) {
    times[T + k] = p.tau * (1 + hold_durations * static_cast<double>(k + 1) / static_cast<double>(H));
  }
  const Matrix R = response_matrix(p.settings, p.tau, times);
  const Matrix free = free_response(p.settings, p.tau, times, p.y0, p.g).positions;
  Rows rows{Matrix(1 + T + H, R.cols()), Matrix(1 + T + H, free.cols())};
  rows.A << end_weight * R.row(T - 1), R;
  rows.B << end_weight * (p.g.transpose() - free.row(T - 1)), p.demo.positions - free.topRows(T),
      p.g.transpose().replicate(H, 1) - free.bottomRows(H);
  if (H > 0) {
    const double hold = hold_weight * std::sqrt(hold_durations * static_cast<double>(T) / static_cast<double>(H));
    rows.A.bottomRows(H) *= hold;
    rows.B.bottomRows(H) *= hold;
  }
  return rows;
}

Weights fit_trajectory(const Problem& p, const DmpFitOptions& options) {
  const Rows rows = trajectory_rows(p, options.hold_weight);
  const Eigen::Index T = p.demo.samples();
  const Eigen::Index D = p.demo.dimensions();
  if (options.sd.size() == 0) return {RidgeLeastSquares(rows.A, rows.A.middleRows(1, T).norm()).solve(rows.B), {}};
  Weights result{Matrix(p.settings.bases(), D), {}};
  for (Eigen::Index d = 0; d < D; ++d) {
    Vector precision = Vector::Ones(T);  // 1 / sd, in units of its root mean square
    double typical = 0;                  // the standard deviation of a sample of unit weight
    if (const double largest = options.sd.col(d).maxCoeff(); largest > 0) {
      precision = (options.sd.col(d).array() / largest).max(sd_floor).inverse();
      const double unit = precision.norm() / std::sqrt(static_cast<double>(T));
      precision /= unit;
      typical = largest / unit;
    }
    Rows weighted = rows;
    weighted.A.middleRows(1, T) = precision.asDiagonal() * rows.A.middleRows(1, T);
    weighted.B.middleRows(1, T) = precision.asDiagonal() * rows.B.middleRows(1, T);
    const RidgeLeastSquares system(weighted.A, weighted.A.middleRows(1, T).norm());
    result.w.col(d) = system.solve(weighted.B.col(d));
    result.covariance.push_back(typical * typical * system.inverse_normal());
  }
  return result;
}

}  // namespace

Derivatives difference(const Trajectory& trajectory) {
  check(trajectory);
  const auto& [t, y] = trajectory;
  const Eigen::Index T = t.size();
  if (T < 3) throw DataError("dmp.too_few_samples", fmt::format("{} samples, but differences need 3", T));
  // Differences of neighbours would do for a clean trajectory, but at its ends they raise noise by far more than
  // inside, and the last weights multiply that by 1 / x. So: the cubic of least squares through the seven nearest
  // samples.
  constexpr int window = 7;
  constexpr int terms = 4;
  using Powers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, window, terms>;
  const Eigen::Index W = std::min<Eigen::Index>(window, T);
  const Eigen::Index P = std::min<Eigen::Index>(terms, W);
  Derivatives result{Samples(T, y.cols()), Samples(T, y.cols())};
  for (Eigen::Index k = 0; k < T; ++k) {
    const Eigen::Index i = std::clamp<Eigen::Index>(k - W / 2, 0, T - W);
    const double h = t[i + W - 1] - t[i];
    Powers V(W, P);
    V.col(0).setOnes();
    for (Eigen::Index j = 0; j < W; ++j) {
      for (Eigen::Index n = 1; n < P; ++n) V(j, n) = V(j, n - 1) * ((t[i + j] - t[k]) / h);
    }
    // Values relative to the sample itself: a constant has derivatives of exactly zero.
    const Matrix values = y.middleRows(i, W).rowwise() - y.row(k);
    const Matrix c = V.householderQr().solve(values);
    result.first.row(k) = c.row(1) / h;
    result.second.row(k) = 2 * c.row(2) / (h * h);
  }
  return result;
}

Samples forcing_target(const Trajectory& trajectory, const Spring& spring, const Vector& goal) {
  const Derivatives derivatives = difference(trajectory);
  const double tau = trajectory.duration();
  const auto& [alpha_z, beta_z] = spring;
  // f_target = tau^2 y'' - alpha_z (beta_z (g - y) - tau y'), paper eq. (14).
  Samples f = tau * tau * derivatives.second + alpha_z * tau * derivatives.first;
  f += alpha_z * beta_z * (trajectory.positions.rowwise() - goal.transpose());
  return f;
}

std::vector<bool> small_goal_change(const Trajectory& trajectory, const Vector& start, const Vector& goal) {
  std::vector<bool> small;
  for (Eigen::Index d = 0; d < trajectory.dimensions(); ++d) {
    const auto axis = trajectory.positions.col(d);
    small.push_back(std::abs(goal[d] - start[d]) < 0.01 * (axis.maxCoeff() - axis.minCoeff()));
  }
  return small;
}

Dmp fit_dmp(const Trajectory& trajectory, const DmpFitOptions& options) {
  check(trajectory);
  const Eigen::Index T = trajectory.samples();
  const Eigen::Index D = trajectory.dimensions();
  if (T < 3) throw DataError("dmp.too_few_samples", fmt::format("{} samples, but a fit needs 3", T));
  const Eigen::Index bases = options.settings ? options.settings->bases() : options.bases;
  if (bases > T) {
    throw DataError("dmp.more_bases_than_samples", fmt::format("{} basis functions, but {} samples", bases, T));
  }
  if (!(options.hold_weight >= 0) || !std::isfinite(options.hold_weight)) {
    throw UsageError("dmp.hold_weight",
                     fmt::format("the hold weight is {}, not a finite number from 0", options.hold_weight));
  }
  check_end(options.start, D, "start");
  check_end(options.goal, D, "goal");
  check_sd(options.sd, trajectory);

  Problem p{trajectory,
            options.settings
                ? *options.settings
                : make_dmp_settings(options.bases, options.scaling, options.alpha_z, options.beta_z, options.alpha_x),
            trajectory.duration(), options.start.value_or(trajectory.start()),
            options.goal.value_or(trajectory.goal())};
  p.demo.times.array() -= trajectory.times[0];

  Weights fitted;
  switch (options.fit) {
    case DmpFitMethod::trajectory:
      fitted = fit_trajectory(p, options);
      break;
    case DmpFitMethod::ls:
      fitted.w = fit_ls(p);
      break;
    case DmpFitMethod::lwr:
      fitted.w = fit_lwr(p);
      break;
  }

  Dmp dmp{p.settings,           p.tau,           p.y0,        p.g,
          fitted.w.transpose(), Vector::Zero(D), options.fit, std::move(fitted.covariance)};
  // All fits are linear in s w: solved for s = 1, then divided.
  const Vector s = dmp.scale();
  for (Eigen::Index d = 0; d < D; ++d) {
    const bool still = dmp.weights.row(d).isZero(0);
    const double unit = s[d] != 0 ? 1 / s[d] : 0;
    const bool lost = s[d] == 0 || !(dmp.weights.row(d) * unit).allFinite();
    if (lost && !still && !options.allow_small_scale) {
      throw DataError("dmp.zero_scale", fmt::format("axis {} moves, but its goal is its start: no weight times "
                                                    "goal - start can move it",
                                                    d + 1));
    }
    dmp.weights.row(d) *= lost ? 0 : unit;
    if (!dmp.weights_covariance.empty()) {
      auto& covariance = dmp.weights_covariance[static_cast<std::size_t>(d)];
      covariance *= lost ? 0 : unit * unit;
    }
  }
  const Samples error = rollout(dmp, p.demo.times).positions - trajectory.positions;
  dmp.rmse = (error.colwise().squaredNorm() / static_cast<double>(T)).cwiseSqrt().transpose();
  return dmp;
}

}  // namespace lfd
