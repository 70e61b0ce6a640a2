#include "lfdtools/promp.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace lfd {

Matrix phase_basis(const Vector& phases, Eigen::Index bases) {
  const Vector centers = linspace(0, 1, bases);
  const double width = 0.8 * (centers[1] - centers[0]);
  Matrix Phi(phases.size(), bases);
  for (Eigen::Index k = 0; k < phases.size(); ++k) {
    Phi.row(k) = (-(phases[k] - centers.array()).square() / (2 * width * width)).exp();
    Phi.row(k) /= Phi.row(k).sum();
  }
  return Phi;
}

Matrix shrunk_covariance(const Matrix& rows) {
  const auto n = static_cast<double>(rows.rows());
  const auto d = static_cast<double>(rows.cols());
  const Matrix centred = rows.rowwise() - rows.colwise().mean();
  const Matrix S = centred.transpose() * centred / n;
  const double m = S.trace() / d;
  // Squared distance of S from the target m I, and the part of it that is sampling error of S; both a dimension.
  const double distance = S.squaredNorm() / d - m * m;
  const double error = (centred.rowwise().squaredNorm().array().square().sum() / n - S.squaredNorm()) / (n * d);
  const double share = distance > 0 ? std::clamp(error / distance, 0.0, 1.0) : 1.0;
  return (1 - share) * S + share * m * Matrix::Identity(S.rows(), S.cols());
}

WeightDistribution conditioned(const WeightDistribution& prior, const Matrix& H, const Vector& values,
                               double variance) {
  const Matrix cross = H * prior.covariance;  // m x d
  Matrix M = cross * H.transpose();
  M.diagonal().array() += variance;
  const Matrix L = cholesky(M);
  return {prior.mean + cross.transpose() * cholesky_solve(L, values - H * prior.mean),
          prior.covariance - cross.transpose() * cholesky_solve(L, cross)};
}

Predictor train_promp(const Fold& fold, const PreparationOptions& options) {
  const Eigen::Index N = options.bases;
  const Eigen::Index D = fold.front()->start.size();
  const Matrix Phi = phase_basis(linspace(0, 1, phase_count), N);
  const Eigen::ColPivHouseholderQR<Matrix> qr(Phi);
  std::vector<Vector> rows;
  for (const auto* target : fold) {
    for (const auto& example : target->examples) rows.push_back(Matrix(qr.solve(example.path)).reshaped());
  }
  Matrix W(rows.size(), D * N);  // by signal, then by basis
  for (std::size_t i = 0; i < rows.size(); ++i) W.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  const WeightDistribution prior{W.colwise().mean().transpose(), shrunk_covariance(W)};
  return [prior, Phi, N, D](const Query& query) {
    Matrix H = Matrix::Zero(2 * D, D * N);
    for (Eigen::Index j = 0; j < D; ++j) {
      H.row(j).segment(j * N, N) = Phi.row(0);
      H.row(D + j).segment(j * N, N) = Phi.row(phase_count - 1);
    }
    Vector ends(2 * D);
    ends << query.start, query.goal;
    const WeightDistribution w = conditioned(prior, H, ends, 1e-6);
    Samples variance(phase_count, D);
    for (Eigen::Index j = 0; j < D; ++j) {
      const Matrix block = w.covariance.block(j * N, j * N, N, N);
      variance.col(j) = ((Phi * block).array() * Phi.array()).rowwise().sum();
    }
    return Predicted{Phi * w.mean.reshaped(N, D), normal_band(variance)};
  };
}

}  // namespace lfd
