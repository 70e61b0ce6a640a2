#include "lfdtools/em.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/lanes.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

Matrix random_samples(Index N, Index D, Random& random) {
  Matrix x(N, D);
  for (Index i = 0; i < N; ++i) {
    const double group = static_cast<double>(random.below(3));
    for (Index j = 0; j < D; ++j) x(i, j) = 2.0 * group * (j % 2 == 0 ? 1.0 : -1.0) + random.normal();
  }
  return x;
}

Gmm random_mixture(Index K, Index D, Random& random) {
  Gmm gmm{Vector(K), Samples(K, D), {}};
  for (Index k = 0; k < K; ++k) {
    gmm.priors[k] = random.uniform(0.5, 1.5);
    for (Index j = 0; j < D; ++j) gmm.means(k, j) = 2.0 * random.normal();
    Matrix A(D, D);
    for (Index j = 0; j < D * D; ++j) A.data()[j] = random.normal();
    gmm.covariances.push_back(A * A.transpose() + 0.3 * Matrix::Identity(D, D));
  }
  gmm.priors /= gmm.priors.sum();
  return gmm;
}

/// The sigma^2 at which -1/2 (D ln sigma^2 + tr(S) / sigma^2 + tr(R) / sigma^2) is greatest, by bisection of its slope.
double variance_of_greatest_q(const Matrix& S, const Vector& R) {
  const auto slope = [&](double v) { return -static_cast<double>(S.rows()) / v + (S.trace() + R.sum()) / (v * v); };
  double low = 1e-12;
  double high = 1e12;
  for (int i = 0; i < 400; ++i) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

/// The definition, sample by sample, with explicit inverses and centred sums.
EmStep plain_step(const Gmm& gmm, const Matrix& x, const Vector& R, CovarianceType type) {
  const Index N = x.rows();
  const Index K = gmm.components();
  Matrix r(N, K);
  EmStep step{gmm, 0.0, Vector::Zero(K)};
  for (Index i = 0; i < N; ++i) {
    for (Index k = 0; k < K; ++k) {
      const Matrix& Sigma = gmm.covariances[static_cast<std::size_t>(k)];
      const Matrix L = cholesky(Sigma);
      const double trace = (cholesky_solve(L, Matrix::Identity(x.cols(), x.cols())) * R.asDiagonal()).trace();
      r(i, k) = gmm.priors[k] *
                std::exp(log_normal_density(x.row(i).transpose(), gmm.means.row(k).transpose(), L) - 0.5 * trace);
    }
    step.objective += std::log(r.row(i).sum());
    r.row(i) /= r.row(i).sum();
  }
  Matrix shared = R.asDiagonal();
  for (Index k = 0; k < K; ++k) {
    step.counts[k] = r.col(k).sum();
    step.gmm.priors[k] = step.counts[k] / static_cast<double>(N);
    step.gmm.means.row(k) = r.col(k).transpose() * x / step.counts[k];
    const Matrix e = x.rowwise() - step.gmm.means.row(k);
    Matrix S = e.transpose() * r.col(k).asDiagonal() * e / step.counts[k];
    shared += step.gmm.priors[k] * S;
    if (type == CovarianceType::diagonal) S = Matrix(S.diagonal().asDiagonal());
    if (type == CovarianceType::spherical && N > 1) {  // of a single sample every column is constant
      S = variance_of_greatest_q(S, R) * Matrix::Identity(x.cols(), x.cols());
    } else {
      S += Matrix(R.asDiagonal());
    }
    step.gmm.covariances[static_cast<std::size_t>(k)] = S;
  }
  if (type == CovarianceType::tied) std::fill(step.gmm.covariances.begin(), step.gmm.covariances.end(), shared);
  return step;
}

double largest_difference(const Gmm& a, const Gmm& b) {
  double worst = (a.priors - b.priors).cwiseAbs().maxCoeff();
  worst = std::max(worst, (a.means - b.means).cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < a.covariances.size(); ++k) {
    worst = std::max(worst, (a.covariances[k] - b.covariances[k]).cwiseAbs().maxCoeff());
  }
  return worst;
}

bool same_bytes(const EmStep& a, const EmStep& b) {
  return a.objective == b.objective && a.counts == b.counts && largest_difference(a.gmm, b.gmm) == 0.0;
}

}  // namespace

TEST_CASE("a step is the E step and the M step as they are defined") {
  const auto type =
      GENERATE(CovarianceType::full, CovarianceType::tied, CovarianceType::diagonal, CovarianceType::spherical);
  Random random(11);
  for (const Index D : {1, 2, 3, 4, 5, 7, 9}) {
    for (const Index N : {1, 63, 64, 65, 700}) {
      const Matrix x = random_samples(N, D, random);
      const Gmm gmm = random_mixture(3, D, random);
      const Vector R = D > 1 ? Vector(Vector::LinSpaced(D, 0.0, 0.02)) : Vector::Constant(1, 0.01);
      const EmStep step = em_step(gmm, x, R, type);
      const EmStep plain = plain_step(gmm, x, R, type);
      INFO("D " << D << " N " << N);
      CHECK(step.objective == Approx(plain.objective).epsilon(1e-13));
      CHECK((step.counts - plain.counts).cwiseAbs().maxCoeff() < 1e-11);
      CHECK(largest_difference(step.gmm, plain.gmm) < 1e-11);
    }
  }
}

TEST_CASE("a constant column takes no part in the variance of a spherical component") {
  Random random(14);
  Matrix x = random_samples(400, 3, random);
  const Vector R = Vector::Constant(3, 0.01);
  Gmm gmm{Vector::Constant(2, 0.5), x.topRows(2), std::vector<Matrix>(2, Matrix::Identity(3, 3))};
  Gmm without{gmm.priors, gmm.means.leftCols(2), std::vector<Matrix>(2, Matrix::Identity(2, 2))};
  x.col(2).setConstant(4.5);
  gmm.means.col(2).setConstant(4.5);
  CHECK(varying_columns(x) == Vector(Eigen::Vector3d(1, 1, 0)));
  for (int i = 0; i < 5; ++i) {
    gmm = em_step(gmm, x, R, CovarianceType::spherical).gmm;
    without = em_step(without, x.leftCols(2), R.head(2), CovarianceType::spherical).gmm;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK((gmm.covariances[k].topLeftCorner(2, 2) - without.covariances[k]).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(gmm.covariances[k](2, 2) == Approx(0.01).epsilon(1e-12));
  }
}

TEST_CASE("every vector width and every number of threads gives the same bytes") {
  Random random(12);
  for (const Index D : {1, 3, 4, 7, 8}) {
    const Matrix x = random_samples(20011, D, random);  // three chunks, the last one short
    const Gmm gmm = random_mixture(4, D, random);
    const Vector R = Vector::Constant(D, 1e-6);
    const EmStep one = em_step(gmm, x, R, CovarianceType::full, 1, 2);
    for (const int width : vector_widths()) {
      INFO("D " << D << " width " << width);
      CHECK(same_bytes(one, em_step(gmm, x, R, CovarianceType::full, 1, width)));
    }
    CHECK(same_bytes(one, em_step(gmm, x, R, CovarianceType::full, 3)));
  }
}

TEST_CASE("the objective never falls, whatever is added to the diagonal") {
  const auto type =
      GENERATE(CovarianceType::full, CovarianceType::tied, CovarianceType::diagonal, CovarianceType::spherical);
  const double added = GENERATE(0.0, 1e-6, 1e-2, 0.5);
  Random random(13);
  for (int trial = 0; trial < 10; ++trial) {
    const Index D = 1 + trial % 4;
    const Matrix x = random_samples(300, D, random);
    Gmm gmm{Vector::Constant(3, 1.0 / 3), x.topRows(3), std::vector<Matrix>(3, 2.0 * Matrix::Identity(D, D))};
    const Vector R = Vector::Constant(D, added);
    double before = -1e300;
    for (int i = 0; i < 40; ++i) {
      const EmStep step = em_step(gmm, x, R, type);
      INFO("added " << added << " trial " << trial << " iteration " << i);
      // Nothing but rounding: the sum of 300 terms carries about 1e-14 of itself.
      CHECK(step.objective >= before - 1e-12 * std::abs(before));
      before = step.objective;
      gmm = step.gmm;
    }
  }
}

TEST_CASE("samples far from every component still count, without overflow") {
  Gmm gmm{Vector::Constant(2, 0.5), Samples(2, 1), {Matrix::Constant(1, 1, 1e-4), Matrix::Constant(1, 1, 1e-4)}};
  gmm.means << 0.0, 1.0;
  Matrix x(3, 1);
  x << -1000.0, 0.0, 1000.0;
  const EmStep step = em_step(gmm, x, Vector::Zero(1));
  CHECK(step.counts[0] == Approx(2.0));
  CHECK(step.counts[1] == Approx(1.0));
  const double near = -0.5 * log_2pi - 0.5 * std::log(1e-4) + std::log(0.5);
  CHECK(step.objective == Approx(3.0 * near - 0.5e4 * (1000.0 * 1000.0 + 999.0 * 999.0)).epsilon(1e-14));
}

TEST_CASE("a component without responsibility keeps its place") {
  Gmm gmm{Vector(2), Samples(2, 1), {Matrix::Constant(1, 1, 1.0), Matrix::Constant(1, 1, 1.0)}};
  gmm.priors << 1.0, 0.0;
  gmm.means << 0.0, 500.0;
  const Matrix x = Vector::LinSpaced(100, -1.0, 1.0);
  const EmStep step = em_step(gmm, x, Vector::Zero(1));
  CHECK(step.gmm.means(1, 0) == 500.0);
  CHECK(step.gmm.covariances[1](0, 0) == 1.0);
  CHECK(step.gmm.priors[1] < 1e-100);
  CHECK(step.gmm.priors[0] == 1.0);
}

TEST_CASE("what a step cannot take is named") {
  const Gmm flat{Vector::Ones(1), Samples::Zero(1, 2), {Matrix::Ones(2, 2)}};
  CHECK_THROWS_AS(em_step(flat, Matrix::Ones(5, 2), Vector::Zero(2)), DataError);
  const Gmm good{Vector::Ones(1), Samples::Zero(1, 2), {Matrix::Identity(2, 2)}};
  CHECK_THROWS_AS(em_step(good, Matrix::Ones(5, 2), Vector::Zero(2), CovarianceType::full, 1, 3), UsageError);
  const Gmm wide{Vector::Ones(1), Samples::Zero(1, 65), {Matrix::Identity(65, 65)}};
  CHECK_THROWS_AS(em_step(wide, Matrix::Ones(5, 65), Vector::Zero(65)), DataError);
}
