#include "lfdtools/evidence.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/gaussian.hpp"
#include "lfdtools/random.hpp"
#include "random_matrix.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

Matrix random_positive(Eigen::Index d, std::uint64_t seed) {
  const Matrix B = random_matrix(d, d + 3, seed);
  return B * B.transpose() / static_cast<double>(d);
}

double log_gamma_d(int d, double a) {
  double value = 0.25 * d * (d - 1) * std::log(std::numbers::pi);
  for (int j = 1; j <= d; ++j) value += std::lgamma(a + 0.5 * (1 - j));
  return value;
}

Vector theta_of(const Kernel& kernel, double noise_variance) {
  Vector theta(log_hyperparameters(kernel).size() + 1);
  theta << log_hyperparameters(kernel), std::log(noise_variance);
  return theta;
}

/// K' and the residual of generalised least squares, by dense inverses.
struct Dense {
  Matrix K, R;
  Dense(const Matrix& X, const Matrix& Y, const Kernel& kernel, double noise, const EvidenceSettings& settings)
      : K(covariance(kernel, X)), R(Y) {
    const Vector factors = settings.row_noise.size() > 0 ? settings.row_noise : Vector(Vector::Ones(X.rows()));
    K += Matrix((noise * factors).asDiagonal());
    const Matrix H = mean_basis(settings.mean, X);
    if (H.cols() > 0) R -= H * (H.transpose() * K.inverse() * H).inverse() * (H.transpose() * K.inverse() * Y);
  }
};

/// The d x d determinant form, with Psi + S itself.
double explicit_form(const Matrix& X, const Matrix& Y, const Kernel& kernel, double noise,
                     const EvidenceSettings& settings) {
  const Dense dense(X, Y, kernel, noise, settings);
  const int d = static_cast<int>(Y.cols());
  const double n = static_cast<double>(Y.rows());
  const double nd = n * d;
  const Matrix S = dense.R.transpose() * dense.K.inverse() * dense.R;
  const double log_K = std::log(dense.K.determinant());
  if (settings.omega == OmegaRule::ml) {
    return nd / 2 * log_2pi + 0.5 * d * log_K + n / 2 * std::log((S / n).determinant()) + nd / 2;
  }
  const Matrix Psi = settings.psi.size() == 1 ? Matrix(Matrix::Identity(d, d) * settings.psi(0, 0)) : settings.psi;
  const double nu = settings.nu;
  return nd / 2 * std::log(std::numbers::pi) + 0.5 * d * log_K + (n + nu) / 2 * std::log((Psi + S).determinant()) -
         nu / 2 * std::log(Psi.determinant()) - log_gamma_d(d, (n + nu) / 2) + log_gamma_d(d, nu / 2);
}

/// ln MN(R; 0, K', Omega), eq. (18).
double log_matrix_normal(const Matrix& R, const Matrix& K, const Matrix& Omega) {
  const double n = static_cast<double>(R.rows());
  const double d = static_cast<double>(R.cols());
  return -0.5 * (n * d * log_2pi + d * std::log(K.determinant()) + n * std::log(Omega.determinant()) +
                 (K.inverse() * R * Omega.inverse() * R.transpose()).trace());
}

}  // namespace

TEST_CASE("the evidence equals its d x d determinant form, with fewer and with more rows than outputs") {
  const int d = GENERATE(1, 3, 6, 14);
  const MeanType mean = GENERATE(MeanType::zero, MeanType::constant, MeanType::linear);
  const bool full_psi = GENERATE(false, true);
  const Matrix X = random_matrix(9, 2, 11);
  const Matrix Y = random_matrix(9, d, 12);
  const Kernel kernel = sum_kernel(2);
  EvidenceSettings settings{OmegaRule::integrated, mean, Matrix::Constant(1, 1, 0.7), d + 2.5, {}};
  if (full_psi) {
    settings.psi = random_positive(d, 13);
    settings.row_noise = random_matrix(9, 1, 14).array().square() + 0.1;
  }
  Evidence evidence(X, Y, kernel, settings);
  const double expected = explicit_form(X, Y, kernel, 0.2, settings);
  CHECK(std::abs(evidence(theta_of(kernel, 0.2)) - expected) < 1e-8);
}

TEST_CASE("the gradient is that of differences") {
  const int d = GENERATE(1, 4, 12);
  const MeanType mean = GENERATE(MeanType::zero, MeanType::constant, MeanType::linear);
  const OmegaRule omega = GENERATE(OmegaRule::integrated, OmegaRule::ml);
  const int n = 10;
  if (omega == OmegaRule::ml && d == 12) return;  // refused, see below
  const Matrix X = random_matrix(n, 2, 21);
  const Matrix Y = random_matrix(n, d, 22);
  Kernel kernel = sum_kernel(2);
  kernel.terms[2].type = KernelType::matern52;
  EvidenceSettings settings{omega, mean, Matrix::Constant(1, 1, 1.4), d + 2.0, {}};
  settings.row_noise = random_matrix(n, 1, 23).array().square() + 0.5;
  Evidence evidence(X, Y, kernel, settings);
  const Vector theta = theta_of(kernel, 0.1) + 0.3 * random_matrix(evidence.size(), 1, 24);
  Vector gradient;
  evidence(theta, &gradient);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    // Richardson's extrapolation of two central differences.
    const auto central = [&](double h) {
      Vector up = theta;
      Vector down = theta;
      up(i) += h;
      down(i) -= h;
      return (evidence(up) - evidence(down)) / (2 * h);
    };
    const double expected = (4 * central(5e-4) - central(1e-3)) / 3;
    CHECK(std::abs(gradient(i) - expected) < 1e-6 * std::max(1.0, std::abs(expected)));
  }
}

TEST_CASE("the gradient holds for many rows, where the inverse is worked in blocks") {
  const Matrix X = random_matrix(61, 2, 31);
  const Matrix Y = random_matrix(61, 3, 32);
  const Kernel kernel = se_ard_kernel(2);
  const EvidenceSettings settings{OmegaRule::integrated, MeanType::zero, Matrix::Ones(1, 1), 5, {}};
  Evidence evidence(X, Y, kernel, settings);
  const Vector theta = theta_of(kernel, 0.3);
  Vector gradient;
  CHECK(std::abs(evidence(theta, &gradient) - explicit_form(X, Y, kernel, 0.3, settings)) < 1e-8);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    Vector up = theta;
    Vector down = theta;
    up(i) += 1e-4;
    down(i) -= 1e-4;
    const double expected = (evidence(up) - evidence(down)) / 2e-4;
    CHECK(std::abs(gradient(i) - expected) < 1e-6 * std::max(1.0, std::abs(expected)));
  }
}

TEST_CASE("one output is a multivariate Student-t") {
  const Matrix X = random_matrix(6, 2, 41);
  const Matrix y = random_matrix(6, 1, 42);
  const Kernel kernel = se_ard_kernel(2);
  const double psi = 0.8;
  const double nu = 3.5;
  const EvidenceSettings settings{OmegaRule::integrated, MeanType::zero, Matrix::Constant(1, 1, psi), nu, {}};
  const Matrix scale = psi / nu * (covariance(kernel, X) + 0.05 * Matrix::Identity(6, 6));
  const double quadratic = (y.transpose() * scale.inverse() * y).value();
  const double log_t = std::lgamma((nu + 6) / 2) - std::lgamma(nu / 2) - 3 * std::log(nu * std::numbers::pi) -
                       0.5 * std::log(scale.determinant()) - (nu + 6) / 2 * std::log1p(quadratic / nu);
  Evidence evidence(X, y, kernel, settings);
  CHECK(std::abs(-evidence(theta_of(kernel, 0.05)) - log_t) < 1e-10);
}

TEST_CASE("the evidence is the mean of eq. (18) over Omega from the inverse-Wishart") {
  // Importance-free Monte Carlo: Omega^-1 is Wishart(Psi^-1, nu), a sum of nu outer products for whole nu.
  const Matrix X = random_matrix(3, 1, 51);
  const Matrix Y = 0.7 * random_matrix(3, 2, 52);
  const Kernel kernel = se_ard_kernel(1);
  const Matrix Psi = 4 * random_positive(2, 53);
  const int nu = 5;
  const EvidenceSettings settings{OmegaRule::integrated, MeanType::zero, Psi, static_cast<double>(nu), {}};
  Evidence evidence(X, Y, kernel, settings);
  const Matrix K = covariance(kernel, X) + 0.3 * Matrix::Identity(3, 3);
  const Matrix L = cholesky(Psi.inverse());
  Random random(54);
  const int count = 100000;
  double sum = 0;
  double square = 0;
  for (int i = 0; i < count; ++i) {
    const Matrix G = L * Matrix::NullaryExpr(2, nu, [&] { return random.normal(); });
    const double p = std::exp(log_matrix_normal(Y, K, (G * G.transpose()).inverse()));
    sum += p;
    square += p * p;
  }
  const double mean = sum / count;
  const double error = std::sqrt((square / count - mean * mean) / count);
  CHECK(error < 0.02 * mean);  // sharp enough to mean something
  CHECK(std::abs(std::exp(-evidence(theta_of(kernel, 0.3))) - mean) < 4 * error);
}

TEST_CASE("a free Omega is at its maximum, and refused where it has none") {
  const Matrix X = random_matrix(8, 1, 61);
  const Matrix Y = random_matrix(8, 2, 62);
  const Kernel kernel = se_ard_kernel(1);
  const EvidenceSettings settings{OmegaRule::ml, MeanType::zero, Matrix::Constant(1, 1, 3.0), 0, {}};
  Evidence evidence(X, Y, kernel, settings);
  const double value = evidence(theta_of(kernel, 0.2));
  CHECK(std::abs(value - explicit_form(X, Y, kernel, 0.2, settings)) < 1e-8);
  const Dense dense(X, Y, kernel, 0.2, settings);
  const Matrix Omega = dense.R.transpose() * dense.K.inverse() * dense.R / 8;
  CHECK(-log_matrix_normal(Y, dense.K, Omega) == Approx(value).epsilon(1e-12));
  for (int seed = 0; seed < 20; ++seed) {
    const Matrix other = Omega + 0.1 * random_positive(2, 70 + static_cast<std::uint64_t>(seed));
    CHECK(-log_matrix_normal(Y, dense.K, other) > value);
  }

  const auto id_of = [&](const Matrix& outputs, MeanType mean) {
    return refused_as(Fault::data, [&] {
      Evidence(X, outputs, kernel, {OmegaRule::ml, mean, Matrix::Ones(1, 1), 0, {}});
    });
  };
  CHECK(id_of(random_matrix(8, 7, 63), MeanType::zero) == "");
  CHECK(id_of(random_matrix(8, 8, 63), MeanType::zero) == "mvgp.omega_unbounded");
  CHECK(id_of(random_matrix(8, 7, 63), MeanType::constant) == "mvgp.omega_unbounded");
  CHECK(id_of(Y.replicate(1, 2), MeanType::zero) == "mvgp.omega_unbounded");
}

TEST_CASE("generalised least squares coefficients are the best ones") {
  const Matrix X = random_matrix(7, 1, 81);
  const Matrix Y = random_matrix(7, 3, 82);
  const Kernel kernel = se_ard_kernel(1);
  EvidenceSettings settings{OmegaRule::integrated, MeanType::linear, Matrix::Ones(1, 1), 5, {}};
  Evidence evidence(X, Y, kernel, settings);
  const double best = evidence(theta_of(kernel, 0.2));
  const Dense dense(X, Y, kernel, 0.2, settings);
  settings.mean = MeanType::zero;
  const Matrix H = mean_basis(MeanType::linear, X);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Matrix R = dense.R + 0.05 * H * random_matrix(2, 3, 90 + seed);
    CHECK(Evidence(X, R, kernel, settings)(theta_of(kernel, 0.2)) > best);
  }
}

TEST_CASE("blocks that share K' add their evidence and its gradient") {
  const OmegaRule omega = GENERATE(OmegaRule::integrated, OmegaRule::ml);
  const MeanType mean = GENERATE(MeanType::zero, MeanType::linear);
  const Matrix X = random_matrix(12, 2, 61);
  const Kernel kernel = additive_kernel(2);
  std::vector<OutputBlock> blocks;
  for (const int d : {3, 5, 1}) {
    blocks.push_back({random_matrix(12, d, 62 + static_cast<std::uint64_t>(d)), random_positive(d, 70), d + 1.5});
  }
  EvidenceSettings settings{omega, mean, {}, 0, {}};
  Evidence together(X, blocks, kernel, settings);
  const Vector theta = Vector::LinSpaced(together.size(), -1.0, 0.7);
  Vector gradient;
  const double value = together(theta, &gradient);
  double sum = 0;
  Vector sum_of_gradients = Vector::Zero(together.size());
  for (const auto& block : blocks) {
    settings.psi = block.psi;
    settings.nu = block.nu;
    Evidence alone(X, block.Y, kernel, settings);
    Vector own;
    sum += alone(theta, &own);
    sum_of_gradients += own;
  }
  CHECK(value == Approx(sum).epsilon(1e-12));
  CHECK((gradient - sum_of_gradients).norm() < 1e-9 * (1 + gradient.norm()));
}

TEST_CASE("the digamma function is the derivative of ln Gamma") {
  CHECK(digamma(1) == Approx(-std::numbers::egamma).epsilon(1e-14));
  CHECK(digamma(0.5) == Approx(-std::numbers::egamma - 2 * std::numbers::ln2).epsilon(1e-14));
  for (const double x : {0.01, 0.7, 3.3, 9.99, 10.01, 250.0}) {
    const double h = 1e-3 * x;
    const double wide = (std::lgamma(x + 2 * h) - std::lgamma(x - 2 * h)) / (4 * h);
    const double narrow = (std::lgamma(x + h) - std::lgamma(x - h)) / (2 * h);
    CHECK(digamma(x) == Approx((4 * narrow - wide) / 3).epsilon(1e-9));
    CHECK(digamma(x + 1) == Approx(digamma(x) + 1 / x).epsilon(1e-13).margin(1e-13));
  }
}

namespace {

/// ln of the density of the matrix-variate t with nu_t degrees of freedom, T_{n,d}(nu_t, 0, Sigma, Omega), as Gupta and
/// Nagar (Matrix Variate Distributions, definition 4.2.1) write it: gamma functions of order n, an n x n determinant.
double log_matrix_t(const Matrix& R, double nu_t, const Matrix& Sigma, const Matrix& Omega) {
  const int n = static_cast<int>(R.rows());
  const int d = static_cast<int>(R.cols());
  const Matrix inside = Matrix::Identity(n, n) + Sigma.inverse() * R * Omega.inverse() * R.transpose();
  return log_gamma_d(n, (nu_t + d + n - 1) / 2) - log_gamma_d(n, (nu_t + n - 1) / 2) -
         0.5 * n * d * std::log(std::numbers::pi) - 0.5 * d * std::log(Sigma.determinant()) -
         0.5 * n * std::log(Omega.determinant()) - (nu_t + d + n - 1) / 2 * std::log(inside.determinant());
}

Vector with_delta(const Kernel& kernel, double noise_variance, double delta) {
  Vector theta(log_hyperparameters(kernel).size() + 2);
  theta << theta_of(kernel, noise_variance), std::log(delta);
  return theta;
}

}  // namespace

TEST_CASE("a Student-t process has the density of the matrix-variate t") {
  const int d = GENERATE(1, 4, 11);  // 7 rows
  const double delta = GENERATE(0.03, 1.0, 40.0);
  const Matrix X = random_matrix(7, 2, 101);
  const Matrix Y = random_matrix(7, d, 102);
  const Matrix psi = random_positive(d, 103);
  const Kernel kernel = sum_kernel(2);
  EvidenceSettings settings{OmegaRule::integrated, MeanType::zero, psi, 0, {}, ProcessType::student_t};
  Evidence evidence(X, Y, kernel, settings);
  const Matrix K = covariance(kernel, X) + 0.2 * Matrix::Identity(7, 7);
  const double value = evidence(with_delta(kernel, 0.2, delta));
  CHECK(-value == Approx(log_matrix_t(Y, delta + 2, K, delta * psi)).epsilon(1e-10));
  // The Gaussian process with that prior of Omega; with the default's nu = d + 2 where delta = 1.
  settings.process = ProcessType::gaussian;
  settings.nu = d + 1 + delta;
  settings.psi = delta * psi;
  CHECK(value == Approx(Evidence(X, Y, kernel, settings)(theta_of(kernel, 0.2))).epsilon(1e-12));
}

TEST_CASE("the gradient of a Student-t process is that of differences, for blocks of several sizes") {
  const MeanType mean = GENERATE(MeanType::zero, MeanType::linear);
  const double delta = GENERATE(0.05, 3.0, 500.0);
  const Matrix X = random_matrix(9, 2, 111);
  const Kernel kernel = additive_kernel(2);
  std::vector<OutputBlock> blocks;
  for (const int d : {1, 4, 12}) {
    blocks.push_back({random_matrix(9, d, 112 + static_cast<std::uint64_t>(d)), random_positive(d, 115), 0});
  }
  Evidence evidence(X, blocks, kernel, {OmegaRule::integrated, mean, {}, 0, {}, ProcessType::student_t});
  const Vector theta = with_delta(kernel, 0.1, delta);
  REQUIRE(theta.size() == evidence.size());
  Vector gradient;
  evidence(theta, &gradient);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const auto central = [&](double h) {
      const Vector step = h * Vector::Unit(theta.size(), i);
      return (evidence(theta + step) - evidence(theta - step)) / (2 * h);
    };
    const double expected = (4 * central(5e-4) - central(1e-3)) / 3;
    CHECK(std::abs(gradient(i) - expected) < 1e-6 * std::max(1.0, std::abs(expected)));
  }
}
