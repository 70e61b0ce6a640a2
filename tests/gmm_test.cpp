#include "lfdtools/gmm.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gmm_fixture.hpp"
#include "lfdtools/error.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

// Fisher's irises: sepal length and width, petal length and width [mm], 50 each of three species.
const int irises[600] = {
    51, 35, 14, 2,  49, 30, 14, 2,  47, 32, 13, 2,  46, 31, 15, 2,  50, 36, 14, 2,  54, 39, 17, 4,  46, 34, 14, 3,  50,
    34, 15, 2,  44, 29, 14, 2,  49, 31, 15, 1,  54, 37, 15, 2,  48, 34, 16, 2,  48, 30, 14, 1,  43, 30, 11, 1,  58, 40,
    12, 2,  57, 44, 15, 4,  54, 39, 13, 4,  51, 35, 14, 3,  57, 38, 17, 3,  51, 38, 15, 3,  54, 34, 17, 2,  51, 37, 15,
    4,  46, 36, 10, 2,  51, 33, 17, 5,  48, 34, 19, 2,  50, 30, 16, 2,  50, 34, 16, 4,  52, 35, 15, 2,  52, 34, 14, 2,
    47, 32, 16, 2,  48, 31, 16, 2,  54, 34, 15, 4,  52, 41, 15, 1,  55, 42, 14, 2,  49, 31, 15, 2,  50, 32, 12, 2,  55,
    35, 13, 2,  49, 36, 14, 1,  44, 30, 13, 2,  51, 34, 15, 2,  50, 35, 13, 3,  45, 23, 13, 3,  44, 32, 13, 2,  50, 35,
    16, 6,  51, 38, 19, 4,  48, 30, 14, 3,  51, 38, 16, 2,  46, 32, 14, 2,  53, 37, 15, 2,  50, 33, 14, 2,  70, 32, 47,
    14, 64, 32, 45, 15, 69, 31, 49, 15, 55, 23, 40, 13, 65, 28, 46, 15, 57, 28, 45, 13, 63, 33, 47, 16, 49, 24, 33, 10,
    66, 29, 46, 13, 52, 27, 39, 14, 50, 20, 35, 10, 59, 30, 42, 15, 60, 22, 40, 10, 61, 29, 47, 14, 56, 29, 36, 13, 67,
    31, 44, 14, 56, 30, 45, 15, 58, 27, 41, 10, 62, 22, 45, 15, 56, 25, 39, 11, 59, 32, 48, 18, 61, 28, 40, 13, 63, 25,
    49, 15, 61, 28, 47, 12, 64, 29, 43, 13, 66, 30, 44, 14, 68, 28, 48, 14, 67, 30, 50, 17, 60, 29, 45, 15, 57, 26, 35,
    10, 55, 24, 38, 11, 55, 24, 37, 10, 58, 27, 39, 12, 60, 27, 51, 16, 54, 30, 45, 15, 60, 34, 45, 16, 67, 31, 47, 15,
    63, 23, 44, 13, 56, 30, 41, 13, 55, 25, 40, 13, 55, 26, 44, 12, 61, 30, 46, 14, 58, 26, 40, 12, 50, 23, 33, 10, 56,
    27, 42, 13, 57, 30, 42, 12, 57, 29, 42, 13, 62, 29, 43, 13, 51, 25, 30, 11, 57, 28, 41, 13, 63, 33, 60, 25, 58, 27,
    51, 19, 71, 30, 59, 21, 63, 29, 56, 18, 65, 30, 58, 22, 76, 30, 66, 21, 49, 25, 45, 17, 73, 29, 63, 18, 67, 25, 58,
    18, 72, 36, 61, 25, 65, 32, 51, 20, 64, 27, 53, 19, 68, 30, 55, 21, 57, 25, 50, 20, 58, 28, 51, 24, 64, 32, 53, 23,
    65, 30, 55, 18, 77, 38, 67, 22, 77, 26, 69, 23, 60, 22, 50, 15, 69, 32, 57, 23, 56, 28, 49, 20, 77, 28, 67, 20, 63,
    27, 49, 18, 67, 33, 57, 21, 72, 32, 60, 18, 62, 28, 48, 18, 61, 30, 49, 18, 64, 28, 56, 21, 72, 30, 58, 16, 74, 28,
    61, 19, 79, 38, 64, 20, 64, 28, 56, 22, 63, 28, 51, 15, 61, 26, 56, 14, 77, 30, 61, 23, 63, 34, 56, 24, 64, 31, 55,
    18, 60, 30, 48, 18, 69, 31, 54, 21, 67, 31, 56, 24, 69, 31, 51, 23, 58, 27, 51, 19, 68, 32, 59, 23, 67, 33, 57, 25,
    67, 30, 52, 23, 63, 25, 50, 19, 65, 30, 52, 20, 62, 34, 54, 23, 59, 30, 51, 18};

Samples iris() {
  return Eigen::Map<const Eigen::Matrix<int, 150, 4, Eigen::RowMajor>>(irises).cast<double>() / 10.0;
}

/// ln p(x) by the definition: inverse and determinant by Gauss's elimination in extended precision.
long double plain_log_density(const Gmm& gmm, const Eigen::Ref<const Vector>& x) {
  const Index D = gmm.dimensions();
  long double p = 0.0L;
  for (Index k = 0; k < gmm.components(); ++k) {
    using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    Wide A(D, D + 1);
    A.leftCols(D) = gmm.covariances[static_cast<std::size_t>(k)].cast<long double>();
    A.col(D) = (x - gmm.means.row(k).transpose()).cast<long double>();
    const Wide e = A.col(D);
    long double determinant = 1.0L;
    for (Index i = 0; i < D; ++i) {
      determinant *= A(i, i);
      A.row(i) /= Wide(A)(i, i);
      for (Index j = 0; j < D; ++j) {
        if (j != i) A.row(j) -= Wide(A)(j, i) * A.row(i);
      }
    }
    const long double square = (e.transpose() * A.col(D))(0, 0);
    p += static_cast<long double>(gmm.priors[k]) * std::exp(-square / 2) /
         std::sqrt(std::pow(2.0L * 3.14159265358979323846264338327950288L, static_cast<long double>(D)) * determinant);
  }
  return std::log(p);
}

}  // namespace

// R mclust 6.0.0 on the irises, with emControl(tol = 1e-13). With its own tolerance mclust stops at -180.185838744
// (VVV, 3).
TEST_CASE("the fit of the irises is that of R's mclust") {
  struct Oracle {
    CovarianceType type;
    Index K;
    double log_likelihood;
    Index q;
  };
  const auto oracle = GENERATE(
      Oracle{CovarianceType::full, 2, -214.354704370512, 29}, Oracle{CovarianceType::full, 3, -180.185477131308, 44},
      Oracle{CovarianceType::tied, 2, -296.447574769275, 19}, Oracle{CovarianceType::tied, 3, -256.354043125593, 24},
      Oracle{CovarianceType::diagonal, 2, -386.185346934487, 17},
      // VII of standardised columns, with N sum_j ln scale_j taken off
      Oracle{CovarianceType::spherical, 2, -526.738949997750, 11},
      Oracle{CovarianceType::spherical, 3, -460.482020369606, 17});
  EmOptions options;
  options.components = oracle.K;
  options.covariance_type = oracle.type;
  options.regularization = 0.0;
  options.tolerance = 1e-11;
  options.max_iterations = 10000;
  for (const std::uint64_t seed : {1, 2, 3}) {
    options.seed = seed;
    const GmmFit fit = fit_gmm(iris(), options);
    CHECK(fit.converged);
    CHECK(fit.log_likelihood == Approx(oracle.log_likelihood).margin(1e-6).epsilon(0));
    CHECK(fit.bic == Approx(-2 * oracle.log_likelihood + static_cast<double>(oracle.q) * std::log(150.0)).margin(2e-6));
    CHECK(fit.aic == Approx(-2 * oracle.log_likelihood + 2.0 * static_cast<double>(oracle.q)).margin(2e-6));
    CHECK(fit.samples == 150);
    if (oracle.type == CovarianceType::full) {  // from mclust's responsibilities
      CHECK(fit.entropy == Approx(oracle.K == 2 ? 0.00533685 : 4.87324396).margin(2e-5));
      CHECK(fit.icl == Approx(fit.bic + 2 * fit.entropy).epsilon(1e-14));
    }
  }
}

TEST_CASE("with the defaults the irises come out as well as mclust's own stop") {
  EmOptions options;
  options.components = 3;
  const GmmFit fit = fit_gmm(iris(), options);
  CHECK(fit.log_likelihood > -180.185838744 - 150 * options.tolerance);
  CHECK(fit.log_likelihood < -180.1854);
  const ComponentSelection two = select_components(iris(), 1, 6, {}, options);
  CHECK(two.fit.gmm.components() == 2);  // mclust: BIC 574.018 at K = 2, 580.839 at 3
  CHECK(two.fit.bic == Approx(574.017832).margin(1e-3));
}

TEST_CASE("density, likelihood and responsibilities are those of the definition") {
  EmOptions options;
  options.components = 4;
  const Samples x = iris();
  const Gmm gmm = fit_gmm(x, options).gmm;
  const Vector density = log_densities(gmm, x);
  const Samples r = responsibilities(gmm, x);
  long double sum = 0.0L;
  for (Index i = 0; i < x.rows(); ++i) {
    const auto plain = plain_log_density(gmm, x.row(i).transpose());
    CHECK(density[i] == Approx(static_cast<double>(plain)).epsilon(1e-11));
    sum += plain;
    for (Index k = 0; k < 4; ++k) {
      const Gmm one{Vector::Ones(1), gmm.means.row(k), {gmm.covariances[static_cast<std::size_t>(k)]}};
      const auto share = gmm.priors[k] * std::exp(plain_log_density(one, x.row(i).transpose()) - plain);
      CHECK(r(i, k) == Approx(static_cast<double>(share)).margin(1e-11));
    }
  }
  CHECK(log_likelihood(gmm, x) == Approx(static_cast<double>(sum)).epsilon(1e-12));
  double entropy = 0.0;
  for (Index i = 0; i < x.rows(); ++i) {
    for (Index k = 0; k < 4; ++k) entropy -= r(i, k) > 0.0 ? r(i, k) * std::log(r(i, k)) : 0.0;
  }
  CHECK(responsibility_entropy(gmm, x) == Approx(entropy).epsilon(1e-9));
  Gmm idle = gmm;  // a prior of 0 adds nothing
  idle.priors << gmm.priors[0] + gmm.priors[3], gmm.priors[1], gmm.priors[2], 0.0;
  CHECK(responsibility_entropy(idle, x) >= 0.0);
  CHECK(responsibility_entropy(idle, x) <= 150.0 * std::log(3.0));
  // So far away that even logarithms are all that is left.
  Samples far = Samples::Constant(1, 4, 1e9);
  CHECK(std::isfinite(log_densities(gmm, far)[0]));
  CHECK(responsibilities(gmm, far).sum() == Approx(1.0));
  far.setConstant(1e200);
  CHECK(log_densities(gmm, far)[0] == -std::numeric_limits<double>::infinity());
  CHECK_THROWS_AS(responsibilities(gmm, far), DataError);
}

TEST_CASE("the figures of a fit are those of the model that it returns") {
  EmOptions options;
  options.components = 6;
  const Samples x = demonstrations(20, 5);
  const GmmFit fit = fit_gmm(x, options);
  CHECK_NOTHROW(check(fit.gmm));
  CHECK(fit.converged);
  CHECK(fit.log_likelihood == Approx(log_likelihood(fit.gmm, x)).epsilon(1e-14));
  CHECK(fit.history.size() == static_cast<std::size_t>(fit.iterations) + 1);
  CHECK(free_parameters(6, 4) == 5 + 24 + 60);
  for (Index j = 0; j < 4; ++j) {
    const double variance = (x.col(j).array() - x.col(j).mean()).square().mean();
    CHECK(fit.regularization[j] == Approx(1e-6 * variance).epsilon(1e-10));
  }
  // The last entry of the history from its definition: each density times exp(-tr(Sigma^-1 R) / 2).
  const Samples r = responsibilities(fit.gmm, x);
  Vector factor(6);
  for (Index k = 0; k < 6; ++k) {
    const Matrix L = cholesky(fit.gmm.covariances[static_cast<std::size_t>(k)]);
    factor[k] = std::exp(-0.5 * cholesky_solve(L, fit.regularization.asDiagonal()).trace());
  }
  CHECK(fit.history.back() == Approx(fit.log_likelihood + (r * factor).array().log().sum()).epsilon(1e-11));
}

TEST_CASE("the objective rises to the end, and little is left to gain") {
  EmOptions options;
  options.components = 5;
  const Samples x = demonstrations(20, 6);
  const GmmFit fit = fit_gmm(x, options);
  REQUIRE(fit.collapses.empty());
  for (std::size_t i = 1; i < fit.history.size(); ++i) {
    CHECK(fit.history[i] >= fit.history[i - 1] - 1e-12 * std::abs(fit.history[i]));
  }
  Gmm further =
      fit.gmm;  // sixty textbook iterations: plain responsibilities, the regularisation added to each covariance
  for (int step = 0; step < 60; ++step) {
    const Samples r = responsibilities(further, x);
    for (Index k = 0; k < 5; ++k) {
      const double count = r.col(k).sum();
      further.priors[k] = count / static_cast<double>(x.rows());
      further.means.row(k) = r.col(k).transpose() * x / count;
      const Matrix e = x.rowwise() - further.means.row(k);
      Matrix& Sigma = further.covariances[static_cast<std::size_t>(k)];
      Sigma = e.transpose() * r.col(k).asDiagonal() * e / count;
      Sigma.diagonal() += fit.regularization;
    }
  }
  CHECK(log_likelihood(further, x) - fit.log_likelihood < 1e-3 * static_cast<double>(x.rows()));
}
