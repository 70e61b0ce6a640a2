#include "lfdtools/mvgp.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"

namespace lfd {

namespace {

void require(bool fine, const char* what) {
  if (!fine) throw DataError("mvgp.bad_model", std::string("the model is not usable: ") + what);
}

bool is_square(const Matrix& M, Eigen::Index d) {
  return M.rows() == d && M.cols() == d;
}

void check_model(const MvgpModel& model) {
  const Eigen::Index n = model.X.rows();
  const Eigen::Index d = model.Y.cols();
  check_kernel(model.kernel, static_cast<int>(model.X.cols()));
  require(n > 0 && d > 0 && model.Y.rows() == n, "X and Y must have the same number of rows, at least one");
  require(model.X.allFinite() && model.Y.allFinite(), "X or Y has an entry that is not a finite number");
  require(std::isfinite(model.noise_variance) && model.noise_variance >= 0, "noise_variance must not be negative");
  require(model.noise.size() == 0 || model.noise.size() == n, "noise must have one entry a row");
  require(model.noise.allFinite() && (model.noise.array() >= 0).all(), "noise must not be negative");
  const Eigen::Index q = mean_basis(model.mean, model.X).cols();
  require(
      model.coefficients.rows() == q && (q == 0 || model.coefficients.cols() == d) && model.coefficients.allFinite(),
      "the mean's coefficients do not fit its type");
  require(is_square(model.omega, d) && model.omega.allFinite(), "omega must be d x d");
  require(model.output_transform.size() == 0 || is_square(model.output_transform, d), "output_transform must be d x d");
  require(std::isfinite(model.nu), "nu must be a number");
}

Matrix residual(const MvgpModel& model) {
  if (model.mean == MeanType::zero) return model.Y;
  return model.Y - mean_basis(model.mean, model.X) * model.coefficients;
}

}  // namespace

Matrix noisy_covariance(const MvgpModel& model) {
  Matrix K = covariance(model.kernel, model.X);
  if (model.noise.size() > 0) {
    K.diagonal() += model.noise;
  } else {
    K.diagonal().array() += model.noise_variance;
  }
  return K;
}

double log_evidence(const MvgpModel& model) {
  check_model(model);
  // The residual has zero mean whether the coefficients were known or estimated: those of generalised least squares
  // are where the evidence of an estimated mean has its value.
  EvidenceSettings settings{model.omega_rule, MeanType::zero, model.psi, model.nu, {}};
  double sigma2 = model.noise_variance;
  if (model.noise.size() > 0) {  // the evidence takes factors on one noise variance
    sigma2 = 1;
    settings.row_noise = model.noise;
  }
  if (model.omega_rule == OmegaRule::ml) settings.psi = Matrix::Ones(1, 1);
  Evidence evidence(model.X, residual(model), model.kernel, settings);
  Vector theta(evidence.size());
  theta << log_hyperparameters(model.kernel), std::log(sigma2);
  return -evidence(theta);
}

Matrix left_out_residuals(const MvgpModel& model, const std::vector<std::vector<std::size_t>>& groups) {
  check_model(model);
  Matrix L;
  require(try_cholesky(noisy_covariance(model), L), "K' is not positive definite");
  // With B the group's columns of L^-1 the two factors are B^T B and B^T z: least squares, which rows that nearly
  // repeat each other leave well posed.
  const auto lower = L.triangularView<Eigen::Lower>();
  const Matrix inverse = lower.solve(Matrix::Identity(L.rows(), L.cols()));
  const Matrix z = lower.solve(residual(model));
  Matrix left_out = Matrix::Zero(z.rows(), z.cols());
  for (const auto& group : groups) {
    const Matrix B = inverse(Eigen::all, group);
    left_out(group, Eigen::all) = B.householderQr().solve(z);
  }
  return left_out;
}

MvgpPredictor::MvgpPredictor(const MvgpModel& model) : model_(model) {
  check_model(model_);
  require(try_cholesky(noisy_covariance(model_), L_), "K' is not positive definite");
  alpha_ = cholesky_solve(L_, residual(model_));
  if (model_.output_transform.size() > 0) {
    const Eigen::PartialPivLU<Matrix> lu(model_.output_transform);
    A_inverse_ = lu.inverse();
    require(A_inverse_.allFinite(), "output_transform cannot be inverted");
  }
}

MvgpPrediction MvgpPredictor::predict(const Eigen::Ref<const Vector>& x) const {
  if (x.size() != model_.X.cols())
    throw DataError("mvgp.shape", "the query has another number of inputs than the model");
  if (!x.allFinite()) throw DataError("mvgp.not_finite", "the query has an entry that is not a finite number");
  MvgpPrediction prediction;
  const Vector k = covariance(model_.kernel, model_.X, x.transpose());  // K(X, x*), n
  prediction.mean_transformed = alpha_.transpose() * k;                 // (21), (25)
  if (model_.mean != MeanType::zero) {
    prediction.mean_transformed += (mean_basis(model_.mean, x.transpose()) * model_.coefficients).transpose();
  }
  prediction.mean = prediction.mean_transformed;
  if (A_inverse_.size() > 0) prediction.mean = A_inverse_.transpose() * prediction.mean_transformed;
  // (21), (26). Rounding may leave a variance of nothing a little below zero.
  const Vector v = L_.triangularView<Eigen::Lower>().solve(k);
  prediction.variance = std::max(0.0, prior_variance(model_.kernel, x) - v.squaredNorm());
  prediction.degrees_of_freedom = model_.omega_rule == OmegaRule::ml
                                      ? std::numeric_limits<double>::infinity()
                                      : model_.nu + static_cast<double>(model_.Y.rows() - model_.Y.cols() + 1);
  return prediction;
}

Matrix MvgpPredictor::latent_covariance(const Eigen::Ref<const Matrix>& Xs) const {
  if (Xs.cols() != model_.X.cols()) {
    throw DataError("mvgp.shape", "the queries have another number of inputs than the model");
  }
  if (!Xs.allFinite()) throw DataError("mvgp.not_finite", "a query has an entry that is not a finite number");
  const Matrix V = L_.triangularView<Eigen::Lower>().solve(covariance(model_.kernel, model_.X, Xs));
  return covariance(model_.kernel, Xs) - V.transpose() * V;
}

Matrix MvgpPredictor::weight_covariance(double variance) const {
  if (A_inverse_.size() == 0) return variance * model_.omega;
  return variance * (A_inverse_.transpose() * model_.omega * A_inverse_);
}

MvgpPrediction predict(const MvgpModel& model, const Eigen::Ref<const Vector>& x) {
  return MvgpPredictor(model).predict(x);
}

}  // namespace lfd
