#include "lfdtools/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "lfdtools/error.hpp"

namespace lfd {

namespace {

constexpr std::array<std::string_view, 5> type_names = {"se-ard", "matern32", "matern52", "linear", "constant"};

bool is_radial(KernelType type) {
  return type != KernelType::linear && type != KernelType::constant;
}

/// The term's inputs in units of their length scales, n x q.
Matrix scaled_inputs(const KernelTerm& term, const Eigen::Ref<const Matrix>& X) {
  Matrix scaled(X.rows(), static_cast<Eigen::Index>(term.inputs.size()));
  for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
    scaled.col(j) = X.col(term.inputs[static_cast<std::size_t>(j)]) / term.length_scales(j);
  }
  return scaled;
}

/// Turns r^2 in `k` into the kernel value, and sets `slope` to dk / d ln l_j divided by ((a_j - b_j) / l_j)^2. For
/// se-ard that is k itself, so `slope` is left alone. The Matern slopes stay finite at r = 0, where k has no second
/// derivative.
template <typename Column, typename Slope>
void radial(KernelType type, double variance, Column&& k, Slope&& slope) {
  if (type == KernelType::se_ard) {
    k = variance * (-0.5 * k).exp();
    return;
  }
  if (type == KernelType::matern32) {
    k = (3.0 * k).sqrt();
    slope = 3.0 * variance * (-k).exp();
    k = slope * (1.0 + k) / 3.0;
    return;
  }
  k = (5.0 * k).sqrt();
  slope = 5.0 / 3.0 * variance * (-k).exp() * (1.0 + k);
  k = variance * (1.0 + k + k.square() / 3.0) * (-k).exp();
}

/// 1 where a term holds between the rows of A and one point, else 0, m.
template <typename Rows, typename Point>
auto agreement(const KernelTerm& term, const Rows& A, const Point& b) {
  return (A.col(term.within).array() == b(term.within)).template cast<double>();
}

/// Squared scaled distances of the rows of A to one point, m.
template <typename Rows, typename Point>
Eigen::ArrayXd squared_distances(const Rows& A, const Point& b) {
  Eigen::ArrayXd r2 = Eigen::ArrayXd::Zero(A.rows());
  for (Eigen::Index j = 0; j < A.cols(); ++j) r2 += (A.col(j).array() - b(j)).square();
  return r2;
}

}  // namespace

std::string_view kernel_type_name(KernelType type) {
  return type_names.at(static_cast<std::size_t>(type));
}

KernelType kernel_type_from_name(std::string_view name) {
  const auto found = std::find(type_names.begin(), type_names.end(), name);
  if (found == type_names.end()) {
    throw DataError("kernel.unknown_type", "unknown kernel type " + std::string(name) +
                                               "; known are se-ard, matern32, matern52, linear, constant");
  }
  return static_cast<KernelType>(found - type_names.begin());
}

Kernel se_ard_kernel(int p) {
  std::vector<int> inputs(static_cast<std::size_t>(p));
  std::iota(inputs.begin(), inputs.end(), 0);
  return {{{KernelType::se_ard, 1, inputs, Vector::Ones(p)}}};
}

Kernel additive_kernel(const std::vector<std::vector<int>>& groups) {
  Kernel kernel{{{KernelType::constant, 1, {}, {}}}};
  for (const auto& inputs : groups) {
    kernel.terms.push_back({KernelType::linear, 1, inputs, Vector::Ones(static_cast<Eigen::Index>(inputs.size()))});
  }
  for (const auto& inputs : groups) {
    for (const int j : inputs) kernel.terms.push_back({KernelType::matern32, 1, {j}, Vector::Ones(1)});
  }
  return kernel;
}

Kernel sum_kernel(const std::vector<std::vector<int>>& groups) {
  Kernel kernel = additive_kernel(groups);
  const auto& first = groups.front();
  if (first.size() > 1) {
    kernel.terms.push_back({KernelType::se_ard, 1, first, Vector::Ones(static_cast<Eigen::Index>(first.size()))});
  }
  return kernel;
}

Kernel additive_kernel(int p) {
  return additive_kernel(std::vector<std::vector<int>>{se_ard_kernel(p).terms.front().inputs});
}

Kernel sum_kernel(int p) {
  return sum_kernel(std::vector<std::vector<int>>{se_ard_kernel(p).terms.front().inputs});
}

Kernel with_own_part(Kernel kernel, const std::vector<std::vector<int>>& groups, int within) {
  kernel.terms.push_back({KernelType::constant, 1, {}, {}, within});
  for (const auto& inputs : groups) {
    kernel.terms.push_back(
        {KernelType::linear, 1, inputs, Vector::Ones(static_cast<Eigen::Index>(inputs.size())), within});
  }
  return kernel;
}

void check_kernel(const Kernel& kernel, int p) {
  if (kernel.terms.empty()) throw DataError("kernel.no_terms", "the kernel has no terms");
  for (const auto& term : kernel.terms) {
    const std::string name(kernel_type_name(term.type));
    std::vector<int> inputs = term.inputs;
    std::sort(inputs.begin(), inputs.end());
    const bool repeated = std::adjacent_find(inputs.begin(), inputs.end()) != inputs.end();
    const bool outside = !inputs.empty() && (inputs.front() < 0 || inputs.back() >= p);
    if (repeated || outside || inputs.empty() != (term.type == KernelType::constant)) {
      throw DataError("kernel.bad_inputs", "a " + name + " term needs inputs from 0 to " + std::to_string(p - 1) +
                                               ", each once (a constant term none)");
    }
    if (term.within < -1 || term.within >= p) {
      throw DataError("kernel.bad_inputs", "a " + name + " term holds within an input that there is not");
    }
    const auto& l = term.length_scales;
    if (l.size() != static_cast<Eigen::Index>(inputs.size()) || !l.allFinite() || (l.array() <= 0).any()) {
      throw DataError("kernel.bad_length_scales", "a " + name + " term needs one positive length scale an input");
    }
    if (!std::isfinite(term.variance) || term.variance <= 0) {
      throw DataError("kernel.bad_variance", "the variance of a " + name + " term is not a positive number");
    }
  }
}

Matrix covariance(const Kernel& kernel, const Eigen::Ref<const Matrix>& A, const Eigen::Ref<const Matrix>& B) {
  Matrix K = Matrix::Zero(A.rows(), B.rows());
  Eigen::ArrayXd slope(A.rows());
  for (const auto& term : kernel.terms) {
    const Matrix a = scaled_inputs(term, A);
    const Matrix b = scaled_inputs(term, B);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      Eigen::ArrayXd k;
      if (term.type == KernelType::constant) {
        k.setConstant(A.rows(), term.variance);
      } else if (term.type == KernelType::linear) {
        k = term.variance * (a * b.row(i).transpose()).array();
      } else {
        k = squared_distances(a, b.row(i));
        radial(term.type, term.variance, k, slope);
      }
      if (term.within >= 0) k *= agreement(term, A, B.row(i));
      K.col(i).array() += k;
    }
  }
  return K;
}

Matrix covariance(const Kernel& kernel, const Eigen::Ref<const Matrix>& X) {
  Matrix K = Matrix::Zero(X.rows(), X.rows());
  KernelMatrix(X, kernel).evaluate(kernel, K);
  K.triangularView<Eigen::StrictlyUpper>() = K.transpose();
  return K;
}

double prior_variance(const Kernel& kernel, const Eigen::Ref<const Vector>& x) {
  double k = 0;
  for (const auto& term : kernel.terms) {
    k += term.type == KernelType::linear ? term.variance * scaled_inputs(term, x.transpose()).squaredNorm()
                                         : term.variance;
  }
  return k;
}

Vector log_hyperparameters(const Kernel& kernel) {
  std::vector<double> theta;
  for (const auto& term : kernel.terms) {
    if (kernel.terms.size() > 1) theta.push_back(std::log(term.variance));
    if (!is_radial(term.type)) continue;
    for (const double l : term.length_scales) theta.push_back(std::log(l));
  }
  return Eigen::Map<const Vector>(theta.data(), static_cast<Eigen::Index>(theta.size()));
}

Kernel with_log_hyperparameters(Kernel kernel, const Eigen::Ref<const Vector>& theta) {
  Eigen::Index i = 0;
  const auto next = [&] {
    if (i >= theta.size()) throw DataError("kernel.hyperparameter_count", "too few hyperparameters for the kernel");
    return std::exp(theta(i++));
  };
  const bool sum = kernel.terms.size() > 1;
  for (auto& term : kernel.terms) {
    if (sum) term.variance = next();
    if (!is_radial(term.type)) continue;
    for (double& l : term.length_scales) l = next();
  }
  if (i != theta.size()) throw DataError("kernel.hyperparameter_count", "too many hyperparameters for the kernel");
  return kernel;
}

KernelMatrix::KernelMatrix(const Eigen::Ref<const Matrix>& X, const Kernel& kernel)
    : X_(X), kernel_(kernel), K_(kernel.terms.size()), slope_(kernel.terms.size()) {
  check_kernel(kernel, static_cast<int>(X.cols()));
  for (std::size_t t = 0; t < K_.size(); ++t) {
    const KernelType type = kernel.terms[t].type;
    if (type == KernelType::constant && kernel.terms[t].within < 0) continue;
    K_[t].setZero(X.rows(), X.rows());
    if (is_radial(type) && type != KernelType::se_ard) slope_[t].setZero(X.rows(), X.rows());
  }
}

void KernelMatrix::evaluate(const Kernel& kernel, Matrix& K) {
  const Eigen::Index n = X_.rows();
  kernel_ = kernel;
  K.resize(n, n);
  K.triangularView<Eigen::Lower>().setZero();
  Eigen::ArrayXd none;
  for (std::size_t t = 0; t < K_.size(); ++t) {
    const KernelTerm& term = kernel_.terms[t];
    const Matrix x = scaled_inputs(term, X_);
    for (Eigen::Index i = 0; i < n; ++i) {
      auto sum = K.col(i).tail(n - i).array();
      if (term.type == KernelType::constant && term.within < 0) {
        sum += term.variance;
        continue;
      }
      auto k = K_[t].col(i).tail(n - i).array();
      if (term.type == KernelType::constant) {
        k = term.variance;
      } else if (term.type == KernelType::linear) {
        k = term.variance * (x.bottomRows(n - i) * x.row(i).transpose()).array();
      } else {
        k.setZero();
        for (Eigen::Index j = 0; j < x.cols(); ++j) k += (x.col(j).tail(n - i).array() - x(i, j)).square();
        if (term.type == KernelType::se_ard) {
          radial(term.type, term.variance, k, none);
        } else {
          radial(term.type, term.variance, k, slope_[t].col(i).tail(n - i).array());
        }
      }
      if (term.within >= 0) {
        const Eigen::ArrayXd agrees = agreement(term, X_.bottomRows(n - i), X_.row(i));
        k *= agrees;
        if (slope_[t].size() > 0) slope_[t].col(i).tail(n - i).array() *= agrees;
      }
      sum += k;
    }
  }
}

void KernelMatrix::gradient(const Matrix& V, Eigen::Ref<Vector> gradient) const {
  const Eigen::Index n = X_.rows();
  const bool sum = kernel_.terms.size() > 1;
  Eigen::Index offset = 0;
  gradient.setZero();
  Eigen::ArrayXd weight(n);
  for (std::size_t t = 0; t < K_.size(); ++t) {
    const KernelTerm& term = kernel_.terms[t];
    const bool radial_term = is_radial(term.type);
    const Matrix x = scaled_inputs(term, X_);
    // The strict lower triangle counts twice, for the pairs above the diagonal; on the diagonal all distances are 0.
    double by_variance = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index m = n - i - 1;
      const auto v = V.col(i).tail(m).array();
      if (sum && term.type == KernelType::constant && term.within < 0) {
        by_variance += term.variance * (V(i, i) + 2 * v.sum());
      } else if (sum) {
        by_variance += V(i, i) * K_[t](i, i) + 2 * (v * K_[t].col(i).tail(m).array()).sum();
      }
      if (!radial_term) continue;
      const Matrix& slope = term.type == KernelType::se_ard ? K_[t] : slope_[t];
      weight.head(m) = v * slope.col(i).tail(m).array();
      for (Eigen::Index j = 0; j < x.cols(); ++j) {
        gradient(offset + (sum ? 1 : 0) + j) +=
            2 * (weight.head(m) * (x.col(j).tail(m).array() - x(i, j)).square()).sum();
      }
    }
    if (sum) gradient(offset++) = by_variance;
    if (radial_term) offset += x.cols();
  }
}

}  // namespace lfd
