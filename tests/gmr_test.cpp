#include "lfdtools/gmr.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/lanes.hpp"
#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

/// Components along the time from 0 to 3 s, with correlated signals.
Gmm random_mixture(Index K, Index D, std::uint64_t seed) {
  Random random(seed);
  Gmm gmm{Vector(K), Samples(K, 1 + D), {}};
  for (Index k = 0; k < K; ++k) {
    gmm.priors[k] = random.uniform(0.5, 1.5);
    gmm.means(k, 0) = 3.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(K);
    for (Index j = 1; j <= D; ++j) gmm.means(k, j) = 0.3 * random.normal();
    Matrix A(1 + D, 1 + D);
    for (Index j = 0; j < A.size(); ++j) A.data()[j] = 0.2 * random.normal();
    gmm.covariances.push_back(A * A.transpose() + 0.003 * Matrix::Identity(1 + D, 1 + D));
  }
  gmm.priors /= gmm.priors.sum();
  return gmm;
}

/// (4)-(7) as written, in extended precision.
struct Plain {
  Eigen::Matrix<long double, Eigen::Dynamic, 1> mean;
  Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> covariance;
};

Plain plain_regression(const Gmm& gmm, double t) {
  const Index D = gmm.dimensions() - 1;
  Plain result;
  result.mean.setZero(D);
  result.covariance.setZero(D, D);
  long double sum = 0.0L;
  for (Index k = 0; k < gmm.components(); ++k) {
    const auto Sigma = gmm.covariances[static_cast<std::size_t>(k)].cast<long double>().eval();
    const auto mu = gmm.means.row(k).transpose().cast<long double>().eval();
    const long double dt = static_cast<long double>(t) - mu[0];
    const long double h =
        static_cast<long double>(gmm.priors[k]) * std::exp(-dt * dt / (2 * Sigma(0, 0))) / std::sqrt(Sigma(0, 0));
    const auto xi = (mu.tail(D) + Sigma.col(0).tail(D) / Sigma(0, 0) * dt).eval();
    const auto conditional =
        (Sigma.bottomRightCorner(D, D) - Sigma.col(0).tail(D) * Sigma.row(0).tail(D) / Sigma(0, 0)).eval();
    sum += h;
    result.mean += h * xi;
    result.covariance += h * (conditional + xi * xi.transpose());
  }
  result.mean /= sum;
  result.covariance = (result.covariance / sum - result.mean * result.mean.transpose()).eval();
  return result;
}

std::string id_of(const Gmm& gmm, const Vector& times) {
  return refusal_of([&] { (void)gmr(gmm, times); }).id;
}

}  // namespace

TEST_CASE("mean and covariance are the definition to 1e-12") {
  for (const Index D : {1, 2, 3, 6}) {
    for (const Index K : {1, 4, 9}) {
      const Gmm gmm = random_mixture(K, D, static_cast<std::uint64_t>(10 * D + K));
      const Vector times = Vector::LinSpaced(101, -0.5, 3.5);
      const GmrPath path = gmr(gmm, times);
      REQUIRE(path.covariance.size() == 101);
      CHECK(path.derivative.size() == 0);
      for (Index i = 0; i < times.size(); ++i) {
        const Plain plain = plain_regression(gmm, times[i]);
        INFO("D " << D << " K " << K << " t " << times[i]);
        CHECK((path.mean.row(i).transpose() - plain.mean.cast<double>()).cwiseAbs().maxCoeff() < 1e-12);
        CHECK((path.covariance[i] - plain.covariance.cast<double>()).cwiseAbs().maxCoeff() < 1e-12);
        CHECK(path.covariance[i] == path.covariance[i].transpose());
      }
    }
  }
}

TEST_CASE("without a correlation to the time, components have levels, and the definition holds") {
  Gmm gmm = random_mixture(4, 3, 5);
  for (Matrix& Sigma : gmm.covariances) Sigma = Matrix(Sigma.diagonal().asDiagonal());
  const bool spherical = GENERATE(false, true);
  if (spherical) {
    for (Matrix& Sigma : gmm.covariances)
      Sigma = Sigma(0, 0) * Matrix(Vector(gmm.means.row(0).cwiseAbs()).asDiagonal());
  }
  const Vector times = Vector::LinSpaced(51, -0.5, 3.5);
  const GmrPath path = gmr(gmm, times);
  for (Index i = 0; i < times.size(); ++i) {
    const Plain plain = plain_regression(gmm, times[i]);
    CHECK((path.mean.row(i).transpose() - plain.mean.cast<double>()).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((path.covariance[i] - plain.covariance.cast<double>()).cwiseAbs().maxCoeff() < 1e-12);
    for (Index j = 0; j < 3; ++j) {  // an average of the components' means
      CHECK(path.mean(i, j) <= gmm.means.col(1 + j).maxCoeff() + 1e-12);
      CHECK(path.mean(i, j) >= gmm.means.col(1 + j).minCoeff() - 1e-12);
    }
  }
}

TEST_CASE("mean and covariance are the moments of the joint density along the line of the time") {
  const Gmm gmm = random_mixture(4, 2, 77);
  std::vector<Matrix> factors;
  for (const Matrix& Sigma : gmm.covariances) factors.push_back(cholesky(Sigma));
  Vector times(3);
  times << 0.4, 1.5, 2.8;
  const GmrPath path = gmr(gmm, times);
  for (Index i = 0; i < times.size(); ++i) {
    // The rectangle rule is exact to rounding for smooth densities that vanish at the border.
    double p_0 = 0.0;
    Vector p_1 = Vector::Zero(2);
    Matrix p_2 = Matrix::Zero(2, 2);
    const double step = 0.02;
    for (int a = -350; a <= 350; ++a) {
      for (int b = -350; b <= 350; ++b) {
        Vector x(3);
        x << times[i], step * a, step * b;
        double p = 0.0;
        for (Index k = 0; k < 4; ++k) {
          const auto& L = factors[static_cast<std::size_t>(k)];
          p += gmm.priors[k] * std::exp(log_normal_density(x, gmm.means.row(k).transpose(), L));
        }
        p_0 += p;
        p_1 += p * x.tail(2);
        p_2 += p * x.tail(2) * x.tail(2).transpose();
      }
    }
    const Vector mean = p_1 / p_0;
    CHECK((path.mean.row(i).transpose() - mean).norm() < 1e-10);
    CHECK((path.covariance[i] - (p_2 / p_0 - mean * mean.transpose())).norm() < 1e-10);
  }
}

TEST_CASE("the derivative is the slope of the mean") {
  for (const Index D : {2, 3}) {
    const Gmm gmm = random_mixture(5, D, 5);
    const Vector times = Vector::LinSpaced(60, -0.3, 3.3);
    const GmrPath path = gmr(gmm, times, {.covariance = false, .derivative = true});
    CHECK(path.covariance.empty());
    const double h = 3e-4;  // fourth order: h^4 / 30 times the fifth derivative, and rounding of 1e-12
    const auto mean_at = [&](double shift) { return gmr(gmm, times.array() + shift).mean; };
    const Samples slope = (8.0 * (mean_at(h) - mean_at(-h)) - (mean_at(2 * h) - mean_at(-2 * h))) / (12.0 * h);
    CHECK(slope.cwiseAbs().maxCoeff() > 0.1);
    CHECK((path.derivative - slope).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("one component is linear regression") {
  Random random(3);
  Matrix x(50, 3);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = random.normal();
  x.col(1) += 2.0 * x.col(0);
  const Vector mu = x.colwise().mean().transpose();
  const Matrix e = x.rowwise() - mu.transpose();
  const Gmm gmm{Vector::Ones(1), mu.transpose(), {e.transpose() * e / 50.0}};
  // Least squares by the normal equations of the raw samples
  Matrix A(2, 2);
  A << 50.0, x.col(0).sum(), x.col(0).sum(), x.col(0).squaredNorm();
  Matrix B(2, 2);
  B << x.rightCols(2).colwise().sum(), x.col(0).transpose() * x.rightCols(2);
  const Matrix line = cholesky_solve(cholesky(A), B);
  const Matrix rest = x.rightCols(2) - (Matrix(50, 2) << Vector::Ones(50), x.col(0)).finished() * line;
  const GmrPath path = gmr(gmm, Vector::LinSpaced(21, -30.0, 30.0), {.covariance = true, .derivative = true});
  for (Index i = 0; i < 21; ++i) {
    CHECK((path.mean.row(i) - (line.row(0) + path.times[i] * line.row(1))).norm() < 1e-12);
    CHECK((path.derivative.row(i) - line.row(1)).norm() < 1e-12);
    CHECK((path.covariance[i] - rest.transpose() * rest / 50.0).norm() < 1e-12);
  }
}

TEST_CASE("far outside, the component with the widest time rules") {
  Gmm gmm = random_mixture(4, 3, 8);
  for (auto& Sigma : gmm.covariances) Sigma(0, 0) = 1.0;
  gmm.covariances[2](0, 0) = 1.5;
  const Gmm widest{Vector::Ones(1), gmm.means.row(2), {gmm.covariances[2]}};
  Vector times(4);
  times << -1e9, -1e3, 1e3, 1e9;
  const GmrOptions all{.covariance = true, .derivative = true};
  const GmrPath path = gmr(gmm, times, all);
  const GmrPath alone = gmr(widest, times, all);
  CHECK((path.mean - alone.mean).cwiseAbs().maxCoeff() < 1e-12 * alone.mean.cwiseAbs().maxCoeff());
  CHECK((path.derivative - alone.derivative).cwiseAbs().maxCoeff() < 1e-12);
  for (Index i = 0; i < 4; ++i) CHECK((path.covariance[i] - alone.covariance[i]).norm() < 1e-12);
  CHECK(id_of(gmm, Vector::Constant(1, 1e200)) == "gmr.out_of_range");
}

TEST_CASE("every vector width gives the same bytes, for every number of queries") {
  for (const Index D : {1, 3, 6}) {
    const Gmm gmm = random_mixture(5, D, 4);
    for (const Index T : {0, 1, 7, 8, 9, 33}) {
      const Vector times = Vector::LinSpaced(T, 0.0, 3.0);
      const GmrPath base = gmr(gmm, times, {.covariance = true, .derivative = true, .vector_width = 2});
      for (const int width : vector_widths()) {
        const GmrPath path = gmr(gmm, times, {.covariance = true, .derivative = true, .vector_width = width});
        CHECK(path.mean == base.mean);
        CHECK(path.derivative == base.derivative);
        for (Index i = 0; i < T; ++i) CHECK(path.covariance[i] == base.covariance[i]);
      }
    }
  }
}

TEST_CASE("what cannot be regressed is named") {
  const Gmm gmm = random_mixture(2, 3, 1);
  CHECK(id_of(gmm, Vector::Constant(1, std::numeric_limits<double>::quiet_NaN())) == "gmr.not_finite");
  const Gmm time_alone{Vector::Ones(1), Samples::Zero(1, 1), {Matrix::Ones(1, 1)}};
  CHECK(id_of(time_alone, Vector::Zero(1)) == "gmr.shape");
  Gmm broken = gmm;
  broken.priors *= 2.0;
  CHECK(id_of(broken, Vector::Zero(1)) == "gmm.priors");
  CHECK_THROWS_AS(gmr(gmm, Vector::Zero(1), {.covariance = true, .derivative = false, .vector_width = 3}), UsageError);
}
