// Checks of the training data, and the model fields that follow from data and hyperparameters.
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/hyperparameters.hpp"
#include "lfdtools/mvgp.hpp"

namespace lfd {

namespace {

/// Length scales of linear terms: one for all directions, so that the variance is the prior share of a slope that knows
/// no preferred direction.
void scale_linear_terms(Kernel& kernel, const Matrix& X) {
  for (auto& term : kernel.terms) {
    if (term.type != KernelType::linear) continue;
    double sum = 0;
    for (const int j : term.inputs) sum += X.col(j).squaredNorm();
    const double l = std::sqrt(sum / static_cast<double>(X.rows()));
    term.length_scales.setConstant(static_cast<Eigen::Index>(term.inputs.size()), l > 0 ? l : 1.0);
  }
}

void check_arguments(const Matrix& X, const Matrix& W, const Matrix& A, const MvgpOptions& options) {
  if (X.rows() == 0) throw DataError("mvgp.no_rows", "there are no rows to train on");
  if (X.cols() == 0 || W.cols() == 0 || W.rows() != X.rows()) {
    throw DataError("mvgp.shape", "inputs and weights must have columns, and the same number of rows");
  }
  if (!X.allFinite() || !W.allFinite() || !A.allFinite()) {
    throw DataError("mvgp.not_finite", "inputs, weights or transform have an entry that is not a finite number");
  }
  const Eigen::Index d = W.cols();
  if (A.size() > 0 && (A.rows() != d || A.cols() != d || !(Eigen::PartialPivLU<Matrix>(A).rcond() > 1e-14))) {
    throw DataError("mvgp.bad_transform", "the output transform is not an invertible d x d matrix");
  }
  const auto& psi = options.psi;
  Matrix unused;
  const bool scalar = psi.size() == 1 && std::isfinite(psi(0, 0)) && psi(0, 0) > 0;
  const bool full = psi.rows() == d && psi.cols() == d && try_cholesky(psi, unused);
  if (psi.size() > 0 && !scalar && !full) {
    throw DataError("mvgp.bad_prior", "psi is neither a positive number nor a positive definite d x d matrix");
  }
  if (!(options.nu == 0 || options.nu > static_cast<double>(d) - 1) || !std::isfinite(options.nu)) {
    throw DataError("mvgp.bad_prior", "nu must be greater than d - 1");
  }
  if (!(options.evidence_power > 0 && options.evidence_power <= 1)) {
    throw DataError("mvgp.bad_prior", "the power of the evidence must be in (0, 1]");
  }
  if (options.process == ProcessType::student_t && options.nu != 0 && !(options.nu > static_cast<double>(d) + 1)) {
    throw DataError("mvgp.bad_prior", "nu of a Student-t process must be greater than d + 1");
  }
  const auto& noise = options.row_noise;
  if (noise.size() > 0 && (noise.size() != X.rows() || !noise.allFinite() || (noise.array() <= 0).any())) {
    throw DataError("mvgp.shape", "row noise needs one positive factor a row");
  }
  if (!std::isfinite(options.noise_variance) || options.noise_variance <= 0) {
    throw DataError("mvgp.bad_prior", "the noise variance is not a positive number");
  }
}

/// Psi = psi I with psi the mean square of Y, about its column means if an explicit mean takes those.
Matrix psi_from_data(const Matrix& Y, MeanType mean) {
  constexpr double smallest = 1e-18;  // (1 nm)^2: outputs that are all zero still get a proper prior
  double psi = Y.array().square().mean();
  if (mean != MeanType::zero) psi = (Y.rowwise() - Y.colwise().mean()).array().square().mean();
  return Matrix::Constant(1, 1, std::max(psi, smallest));
}

/// Coefficients given for weights, as the model's: for Y = W A.
Matrix known_coefficients(const Matrix& of_weights, const MvgpModel& model) {
  const Eigen::Index q = mean_basis(model.mean, model.X).cols();
  if (of_weights.rows() != q || of_weights.cols() != model.Y.cols() || !of_weights.allFinite()) {
    throw DataError("mvgp.shape", "the coefficients of a known mean do not fit its type and the weights");
  }
  return model.output_transform.size() > 0 ? Matrix(of_weights * model.output_transform) : of_weights;
}

/// Fields that follow from data and hyperparameters: coefficients unless known, Omega, evidence.
void complete(MvgpModel& model, bool known) {
  const Matrix L = cholesky(noisy_covariance(model));
  const double n = static_cast<double>(model.Y.rows());
  const Eigen::Index d = model.Y.cols();
  Matrix residual = model.Y;
  const Matrix H = mean_basis(model.mean, model.X);
  if (!known) model.coefficients = Matrix(0, d);
  if (!known && H.cols() > 0) {  // generalised least squares
    const Matrix KiH = cholesky_solve(L, H);
    model.coefficients = cholesky_solve(cholesky(H.transpose() * KiH), KiH.transpose() * model.Y);
  }
  if (H.cols() > 0) residual -= H * model.coefficients;
  const Matrix Z = L.triangularView<Eigen::Lower>().solve(residual);
  Matrix S = Z.transpose() * Z;
  if (model.omega_rule == OmegaRule::ml) {
    model.omega = S / n;
  } else {
    S += model.psi.size() == 1 ? Matrix(Matrix::Identity(d, d) * model.psi(0, 0)) : model.psi;
    model.omega = S / (n + model.nu - static_cast<double>(d) - 1);
  }
  model.log_marginal_likelihood = log_evidence(model);
}

/// Blocks cut to the principal directions of MvgpOptions::smallest_share; blocks without one are left out, unless all
/// are.
std::vector<OutputBlock> principal(const std::vector<OutputBlock>& blocks, double smallest_share) {
  if (smallest_share == 0) return blocks;
  double largest = 0;
  for (const auto& block : blocks) largest = std::max(largest, block.Y.squaredNorm());
  std::vector<OutputBlock> cut;
  for (const auto& block : blocks) {
    const Eigen::JacobiSVD<Matrix> svd(block.Y.transpose() * block.Y, Eigen::ComputeFullU);
    const Eigen::Index d = block.Y.cols();
    const Eigen::Index r = (svd.singularValues().array() > smallest_share * largest).count();
    if (r == 0) continue;
    const Matrix V = svd.matrixU().leftCols(r);
    cut.push_back({block.Y * V, block.psi.size() == 1 ? block.psi : Matrix(V.transpose() * block.psi * V),
                   block.nu - static_cast<double>(d - r)});
  }
  return cut.empty() ? blocks : cut;
}

}  // namespace

MvgpOptions paper_mvgp_options(int p) {
  MvgpOptions options;
  options.kernel = se_ard_kernel(p);
  return options;
}

MvgpOptions default_mvgp_options(int p) {
  MvgpOptions options;
  options.kernel = sum_kernel(p);
  options.length_scale = {2.0, 1.0};
  options.variance = {0.1, 2.0};
  options.noise = {0.1, 2.0};
  options.smallest_share = 1e-7;
  options.delta = {1.0, 2.0};
  return options;
}

std::vector<MvgpModel> train_mvgp(const Eigen::Ref<const Matrix>& X, const std::vector<Matrix>& W, const Matrix& A,
                                  const MvgpOptions& options, const std::vector<Matrix>& coefficients) {
  std::vector<MvgpModel> models;
  std::vector<OutputBlock> blocks;
  // A mean known beforehand leaves a residual with zero mean.
  const bool known = !coefficients.empty() || options.coefficients.size() > 0;
  const MeanType estimated = known ? MeanType::zero : options.mean;
  const bool student_t = options.process == ProcessType::student_t;
  for (std::size_t g = 0; g < W.size(); ++g) {
    check_arguments(X, W[g], A, options);
    MvgpModel model;
    model.X = X;
    model.Y = A.size() > 0 ? Matrix(W[g] * A) : W[g];
    model.output_transform = A;
    model.kernel = options.kernel.terms.empty() ? sum_kernel(static_cast<int>(X.cols())) : options.kernel;
    check_kernel(model.kernel, static_cast<int>(X.cols()));
    model.mean = options.mean;
    if (known)
      model.coefficients = known_coefficients(coefficients.empty() ? options.coefficients : coefficients[g], model);
    model.omega_rule = options.omega;
    model.noise_variance = options.noise_variance;
    const Matrix residual = known ? Matrix(model.Y - mean_basis(model.mean, model.X) * model.coefficients) : model.Y;
    const Matrix psi = options.psi.size() > 0 ? options.psi : psi_from_data(residual, estimated);
    if (options.omega == OmegaRule::integrated) {
      model.psi = psi;
      model.nu = options.nu > 0 ? options.nu : static_cast<double>(model.Y.cols()) + 2;
    }
    blocks.push_back({residual, psi, model.nu});
    models.push_back(std::move(model));
  }
  if (models.empty()) throw DataError("mvgp.no_rows", "there are no outputs to train on");
  if (options.optimise) {
    Kernel kernel = models.front().kernel;
    scale_linear_terms(kernel, models.front().X);
    const EvidenceSettings settings{options.omega, estimated, {}, 0, options.row_noise, options.process};
    const Vector theta = hyperparameters_of_maximum_evidence(
        models.front().X, principal(blocks, options.smallest_share), kernel, settings, options);
    const Eigen::Index of_kernel = log_hyperparameters(kernel).size();
    kernel = with_log_hyperparameters(kernel, theta.head(of_kernel));
    for (auto& model : models) {
      model.kernel = kernel;
      model.noise_variance = std::exp(theta(of_kernel));
      if (student_t) model.nu = static_cast<double>(model.Y.cols()) + 1 + std::exp(theta(of_kernel + 1));
    }
  }
  for (auto& model : models) {
    if (student_t) model.psi *= model.nu - static_cast<double>(model.Y.cols()) - 1;
    if (options.row_noise.size() > 0) model.noise = model.noise_variance * options.row_noise;
    complete(model, known);
  }
  return models;
}

MvgpModel train_mvgp(const Eigen::Ref<const Matrix>& X, const Eigen::Ref<const Matrix>& W, const Matrix& A,
                     const MvgpOptions& options) {
  return train_mvgp(X, std::vector<Matrix>{W}, A, options).front();
}

}  // namespace lfd
