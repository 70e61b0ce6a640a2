#include "lfdtools/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"

namespace lfd {

namespace {

/// ln Gamma_d(a), the multivariate gamma function.
double log_multivariate_gamma(Eigen::Index d, double a) {
  const double D = static_cast<double>(d);
  double sum = D * (D - 1) / 4 * std::log(std::numbers::pi);
  for (Eigen::Index j = 0; j < d; ++j) sum += std::lgamma(a - 0.5 * static_cast<double>(j));
  return sum;
}

/// d/da ln Gamma_d(a).
double multivariate_digamma(double d, double a) {
  double sum = 0;
  for (double j = 0; j < d; ++j) sum += digamma(a - 0.5 * j);
  return sum;
}

void refuse_undetermined_mean(MeanType mean, const Matrix& H) {
  if (H.cols() == 0 || Eigen::ColPivHouseholderQR<Matrix>(H).rank() == H.cols()) return;
  throw DataError("mvgp.mean_rank",
                  mean == MeanType::linear
                      ? "the rows do not span enough directions for an explicit linear mean; use a linear kernel term "
                        "instead, which has a proper prior"
                      : "an explicit mean needs at least one row");
}

/// Leaves of the columns of Z what is outside the span of the columns of H (Gram-Schmidt, each column twice).
void remove_span(Matrix H, Matrix& Z) {
  for (Eigen::Index j = 0; j < H.cols(); ++j) {
    for (int pass = 0; pass < 2; ++pass) H.col(j) -= H.leftCols(j) * (H.leftCols(j).transpose() * H.col(j)).eval();
    H.col(j).normalize();
    Z -= H.col(j) * (H.col(j).transpose() * Z).eval();
  }
}

/// Lower Cholesky factor in place of the lower triangle. False if the matrix is not numerically positive definite.
bool cholesky_in_place(Matrix& A) {
  const Eigen::LLT<Eigen::Ref<Matrix>> llt(A);
  return llt.info() == Eigen::Success && A.diagonal().allFinite() && (A.diagonal().array() > 0).all();
}

/// L^-1 in place of the lower triangle: [A 0; B C]^-1 = [A^-1 0; -C^-1 B A^-1 C^-1]. Halving leaves nearly all work to
/// matrix products and, unlike solving for the columns of the identity, never touches the zeros.
void invert_lower(Eigen::Ref<Matrix> L) {
  const Eigen::Index n = L.rows();
  if (n <= 16) {
    for (Eigen::Index j = 0; j < n; ++j) {
      L(j, j) = 1 / L(j, j);
      for (Eigen::Index i = j + 1; i < n; ++i) {
        L(i, j) = -L.row(i).segment(j, i - j).dot(L.col(j).segment(j, i - j)) / L(i, i);
      }
    }
    return;
  }
  const Eigen::Index h = n / 2;
  auto A = L.topLeftCorner(h, h);
  auto B = L.bottomLeftCorner(n - h, h);
  auto C = L.bottomRightCorner(n - h, n - h);
  invert_lower(A);
  C.triangularView<Eigen::Lower>().solveInPlace(B);
  B = -(B * A.triangularView<Eigen::Lower>());
  invert_lower(C);
}

/// L^T L in place of the lower triangle: [A 0; B C] gives [A^T A + B^T B, .; C^T B, C^T C].
void multiply_transposed_by_itself(Eigen::Ref<Matrix> L) {
  const Eigen::Index n = L.rows();
  if (n <= 16) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j; i < n; ++i) L(i, j) = L.col(i).tail(n - i).dot(L.col(j).tail(n - i));
    }
    return;
  }
  const Eigen::Index h = n / 2;
  auto A = L.topLeftCorner(h, h);
  auto B = L.bottomLeftCorner(n - h, h);
  auto C = L.bottomRightCorner(n - h, n - h);
  multiply_transposed_by_itself(A);
  A.selfadjointView<Eigen::Lower>().rankUpdate(B.transpose());
  B = C.triangularView<Eigen::Lower>().transpose() * B;
  multiply_transposed_by_itself(C);
}

}  // namespace

Matrix mean_basis(MeanType mean, const Eigen::Ref<const Matrix>& X) {
  if (mean == MeanType::zero) return Matrix(X.rows(), 0);
  Matrix H = Matrix::Ones(X.rows(), mean == MeanType::constant ? 1 : 1 + X.cols());
  if (mean == MeanType::linear) H.rightCols(X.cols()) = X;
  return H;
}

Evidence::Evidence(const Eigen::Ref<const Matrix>& X, const Eigen::Ref<const Matrix>& Y, const Kernel& kernel,
                   const EvidenceSettings& settings)
    : Evidence(X, std::vector<OutputBlock>{{Y, settings.psi, settings.nu}}, kernel, settings) {}

Evidence::Evidence(const Eigen::Ref<const Matrix>& X, const std::vector<OutputBlock>& blocks, const Kernel& kernel,
                   const EvidenceSettings& settings)
    : kernel_(kernel),
      kernel_matrix_(X, kernel),
      row_noise_(settings.row_noise.size() > 0 ? settings.row_noise : Vector::Ones(X.rows())),
      H_(mean_basis(settings.mean, X)),
      kernel_size_(log_hyperparameters(kernel).size()),
      n_(X.rows()),
      integrated_(settings.omega == OmegaRule::integrated),
      student_t_(settings.process == ProcessType::student_t) {
  if (student_t_ && !integrated_) {
    throw DataError("mvgp.omega_unbounded",
                    "the likelihood of a Student-t process with a free Omega grows without bound; use the integrated "
                    "Omega");
  }
  refuse_undetermined_mean(settings.mean, H_);
  for (const auto& outputs : blocks) blocks_.push_back(turned(outputs));
}

Evidence::Block Evidence::turned(const OutputBlock& outputs) {
  const Eigen::Index d_outputs = outputs.Y.cols();
  if (!integrated_ && n_ - H_.cols() <= d_outputs) {
    throw DataError("mvgp.omega_unbounded",
                    "a free Omega needs more rows than outputs: the likelihood grows without bound as the empty "
                    "directions of Omega shrink; use the integrated Omega");
  }
  const double n = static_cast<double>(n_);
  const double d = static_cast<double>(d_outputs);
  const Matrix psi =
      outputs.psi.size() == 1 ? Matrix(Matrix::Identity(d_outputs, d_outputs) * outputs.psi(0, 0)) : outputs.psi;
  const Matrix L_psi = cholesky(psi);
  const double log_psi = log_determinant_from_cholesky(L_psi);
  Block block{{}, d, integrated_ ? n + outputs.nu : n, {}, {}};
  if (integrated_) {
    constant_ += n * d / 2 * std::log(std::numbers::pi) + n / 2 * log_psi;
    if (!student_t_) {
      constant_ +=
          log_multivariate_gamma(d_outputs, outputs.nu / 2) - log_multivariate_gamma(d_outputs, block.weight / 2);
    }
  } else {
    constant_ += n * d / 2 * (log_2pi + 1 - std::log(n)) + n / 2 * log_psi;
  }

  // Y Psi^-1/2, and for n < d a factor of n columns with the same Gram matrix: Y^T = Q R P^T gives P R^T.
  block.Y = L_psi.triangularView<Eigen::Lower>().solve(outputs.Y.transpose()).transpose();
  if (n_ < d_outputs) {
    const Eigen::ColPivHouseholderQR<Matrix> qr(block.Y.transpose());
    block.Y = qr.colsPermutation() * Matrix(qr.matrixQR().topRows(n_).triangularView<Eigen::Upper>()).transpose();
  }
  if (!integrated_) {
    Matrix rest = block.Y;
    remove_span(H_, rest);
    if (Eigen::ColPivHouseholderQR<Matrix>(rest).rank() < d_outputs) {
      throw DataError("mvgp.omega_unbounded",
                      "a free Omega needs linearly independent outputs: the likelihood grows without bound as the "
                      "empty directions of Omega shrink; use the integrated Omega");
    }
  }
  return block;
}

bool Evidence::factorize(const Vector& theta) {
  if (!theta.allFinite()) return false;
  kernel_matrix_.evaluate(with_log_hyperparameters(kernel_, theta.head(kernel_size_)), K_);
  K_.diagonal() += std::exp(theta(kernel_size_)) * row_noise_;
  return cholesky_in_place(K_);
}

double Evidence::operator()(const Vector& theta, Vector* gradient) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!factorize(theta)) return infinity;
  const double half_log_K = K_.diagonal().array().log().sum();
  Matrix H;
  if (H_.cols() > 0) H = K_.triangularView<Eigen::Lower>().solve(H_);
  double value = constant_;
  double d = 0;
  const double n = static_cast<double>(n_);
  const double delta = student_t_ ? std::exp(theta(kernel_size_ + 1)) : 1.0;  // Psi over the psi that turned Y
  double slope = 0;                                                           // dvalue/ddelta
  for (auto& block : blocks_) {
    auto& [Y, outputs, weight, Z, S] = block;
    Z = Y;
    K_.triangularView<Eigen::Lower>().solveInPlace(Z);
    // L^-1 (Y - H beta) at the generalised least squares beta is what is left of L^-1 Y outside the span of L^-1 H.
    if (H.cols() > 0) remove_span(H, Z);
    if (!Z.allFinite()) return infinity;
    S.setZero(Z.cols(), Z.cols());
    S.selfadjointView<Eigen::Lower>().rankUpdate(Z.transpose());
    if (integrated_) S.diagonal().array() += delta;
    if (!cholesky_in_place(S)) return infinity;
    const double half_log_S = S.diagonal().array().log().sum();
    d += outputs;
    if (student_t_) {
      // With r columns left of d, |Psi + S| = |psi| delta^(d - r) |delta I + S|, S turned.
      const double nu = outputs + 1 + delta;
      const double r = static_cast<double>(S.rows());
      weight = n + nu;
      value += (n * outputs - weight * r) / 2 * std::log(delta) +
               log_multivariate_gamma(static_cast<Eigen::Index>(outputs), nu / 2) -
               log_multivariate_gamma(static_cast<Eigen::Index>(outputs), weight / 2);
      if (gradient != nullptr) {
        const Matrix L_inverse = S.triangularView<Eigen::Lower>().solve(Matrix::Identity(S.rows(), S.rows()));
        slope += half_log_S - r / 2 * std::log(delta) + weight / 2 * L_inverse.squaredNorm() +
                 (n * outputs - weight * r) / (2 * delta) +
                 (multivariate_digamma(outputs, nu / 2) - multivariate_digamma(outputs, weight / 2)) / 2;
      }
    }
    value += outputs * half_log_K + weight * half_log_S;
  }
  if (!std::isfinite(value)) return infinity;
  if (gradient == nullptr) return value;

  // dvalue/dK' = d/2 K'^-1 - weight/2 B B^T with B B^T = K'^-1 R (I + S)^-1 R^T K'^-1, symmetric.
  for (auto& block : blocks_) {
    block.S.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(block.Z);
    K_.transpose().triangularView<Eigen::Upper>().solveInPlace(block.Z);
  }
  invert_lower(K_);
  multiply_transposed_by_itself(K_);
  K_.triangularView<Eigen::Lower>() *= d / 2;
  for (const auto& block : blocks_) {
    K_.selfadjointView<Eigen::Lower>().rankUpdate(block.Z, -block.weight / 2);
  }
  gradient->resize(size());
  kernel_matrix_.gradient(K_, gradient->head(kernel_size_));
  if (student_t_) (*gradient)(kernel_size_ + 1) = delta * slope;
  (*gradient)(kernel_size_) = std::exp(theta(kernel_size_)) * K_.diagonal().dot(row_noise_);
  return value;
}

}  // namespace lfd
