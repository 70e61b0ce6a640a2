#include "lfdtools/kmp.hpp"

#include <Eigen/LU>
#include <cmath>

#include "lfdtools/gmm.hpp"

namespace lfd {
namespace {

constexpr Eigen::Index components = 8;
constexpr Eigen::Index reference_points = 41;
constexpr Eigen::Index phase_step = 4;  // every fourth phase of an example is a sample of the mixture
constexpr double kernel_rate = 8;
constexpr double regularisation = 1;
constexpr double desired_variance = 1e-6;  // [m^2]

Matrix kernel(const Vector& a, const Vector& b, double rate) {
  return (-rate * (a.replicate(1, b.size()) - b.transpose().replicate(a.size(), 1)).array().square()).exp();
}

/// GMR of all motions of the fold, each less its own start (or goal).
KmpReference reference_in_frame(const Fold& fold, bool at_goal, std::uint64_t seed) {
  const Vector phases = linspace(0, 1, phase_count);
  const Eigen::Index D = fold.front()->start.size();
  const Eigen::Index rows = (phase_count + phase_step - 1) / phase_step;
  std::size_t examples = 0;
  for (const auto* target : fold) examples += target->examples.size();
  Samples pooled(rows * static_cast<Eigen::Index>(examples), 1 + D);
  Eigen::Index at = 0;
  for (const auto* target : fold) {
    for (const auto& example : target->examples) {
      const Vector& origin = at_goal ? example.goal : example.start;
      for (Eigen::Index k = 0; k < phase_count; k += phase_step) {
        pooled.row(at++) << phases[k], example.path.row(k) - origin.transpose();
      }
    }
  }
  EmOptions em;
  em.components = components;
  em.seed = seed;
  em.restarts = 2;
  const Gmm gmm = fit_gmm(pooled, em).gmm;
  const Vector at_phases = linspace(0, 1, reference_points);
  const GmrPath path = gmr(gmm, at_phases);
  return {at_phases, path.mean, path.covariance};
}

}  // namespace

KmpPrediction predict_kmp(const KmpReference& reference, const Vector& phases, double rate, double lambda) {
  const Eigen::Index n = reference.phases.size();
  const Eigen::Index D = reference.means.cols();
  const Matrix k = kernel(reference.phases, reference.phases, rate);
  Matrix K = Matrix::Zero(n * D, n * D);
  Vector mu(n * D);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) K.block(i * D, j * D, D, D).diagonal().setConstant(k(i, j));
    K.block(i * D, i * D, D, D) += lambda * reference.covariances[i];
    mu.segment(i * D, D) = reference.means.row(i).transpose();
  }
  const Matrix cross = kernel(phases, reference.phases, rate);
  Matrix cross_blocks = Matrix::Zero(phases.size() * D, n * D);
  for (Eigen::Index t = 0; t < phases.size(); ++t) {
    for (Eigen::Index i = 0; i < n; ++i) cross_blocks.block(t * D, i * D, D, D).diagonal().setConstant(cross(t, i));
  }
  const Matrix L = cholesky(K);
  const Vector mean = cross_blocks * cholesky_solve(L, mu);
  const Matrix V = cholesky_solve(L, cross_blocks.transpose());
  KmpPrediction prediction{Eigen::Map<const Samples>(mean.data(), phases.size(), D), CovarianceList(phases.size(), D)};
  for (Eigen::Index t = 0; t < phases.size(); ++t) {
    const Matrix explained = cross_blocks.middleRows(t * D, D) * V.middleCols(t * D, D);
    prediction.covariances[t] = static_cast<double>(n) / lambda * (Matrix::Identity(D, D) - explained);
  }
  return prediction;
}

Predictor train_kmp(const Fold& fold, const PreparationOptions& options) {
  const KmpReference frames[2] = {reference_in_frame(fold, false, options.seed),
                                  reference_in_frame(fold, true, options.seed)};
  return [frames](const Query& query) {
    const Eigen::Index D = query.start.size();
    const Vector phases = linspace(0, 1, phase_count);
    KmpPrediction local[2];
    for (int f = 0; f < 2; ++f) {
      const Vector& origin = f == 0 ? query.start : query.goal;
      KmpReference reference = frames[f];
      reference.means.row(0) = (query.start - origin).transpose();
      reference.means.row(reference_points - 1) = (query.goal - origin).transpose();
      for (const Eigen::Index i : {Eigen::Index{0}, reference_points - 1}) {
        reference.covariances[i] = desired_variance * Matrix::Identity(D, D);
      }
      local[f] = predict_kmp(reference, phases, kernel_rate, regularisation);
      local[f].mean.rowwise() += origin.transpose();
    }
    Samples path(phase_count, D);
    Samples variance(phase_count, D);
    for (Eigen::Index t = 0; t < phase_count; ++t) {
      // Product of the two Gaussians; the floor keeps what rounding left of a covariance invertible.
      const Matrix floor = 1e-12 * Matrix::Identity(D, D);
      const Matrix a = (local[0].covariances[t] + floor).inverse();
      const Matrix b = (local[1].covariances[t] + floor).inverse();
      const Matrix fused = (a + b).inverse();
      path.row(t) = (fused * (a * local[0].mean.row(t).transpose() + b * local[1].mean.row(t).transpose())).transpose();
      variance.row(t) = fused.diagonal().transpose();
    }
    return Predicted{path, normal_band(variance)};
  };
}

}  // namespace lfd
