// Fitting: invariances, degenerate data, choice of K, errors. gmm_test.cpp has the figures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "gmm_fixture.hpp"
#include "lfdtools/em_run.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/gmm.hpp"
#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

std::string id_of(const Samples& x, const EmOptions& options) {
  return refusal_of([&] { (void)fit_gmm(x, options); }).id;
}

std::string id_of(const Gmm& gmm) {
  const Refusal refusal = refusal_of([&] { check(gmm); });
  return refusal.id.empty() ? "" : refusal.id + " " + refusal.place.pointer;
}

bool same_bytes(const Gmm& a, const Gmm& b) {
  return a.priors == b.priors && a.means == b.means && a.covariances == b.covariances;
}

Gmm in_order_of_time(const Gmm& gmm) {
  std::vector<Index> order(static_cast<std::size_t>(gmm.components()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return gmm.means(a, 0) < gmm.means(b, 0); });
  Gmm result = gmm;
  for (Index k = 0; k < gmm.components(); ++k) {
    const Index from = order[static_cast<std::size_t>(k)];
    result.priors[k] = gmm.priors[from];
    result.means.row(k) = gmm.means.row(from);
    result.covariances[static_cast<std::size_t>(k)] = gmm.covariances[static_cast<std::size_t>(from)];
  }
  return result;
}

}  // namespace

TEST_CASE("the order of the samples does not matter, nor does the number of threads") {
  EmOptions options;
  options.components = 4;
  const Samples x = demonstrations(10, 1);
  const GmmFit fit = fit_gmm(x, options);
  Samples reversed = x.colwise().reverse();
  CHECK(same_bytes(fit.gmm, fit_gmm(reversed, options).gmm));
  options.jobs = 3;
  CHECK(same_bytes(fit.gmm, fit_gmm(x, options).gmm));
  const ComponentSelection three = select_components(x, 1, 5, {}, options);
  options.jobs = 1;
  const ComponentSelection one = select_components(x, 1, 5, {}, options);
  CHECK(same_bytes(one.fit.gmm, three.fit.gmm));
  for (std::size_t i = 0; i < 5; ++i) CHECK(one.table[i].log_likelihood == three.table[i].log_likelihood);
  options.seed = 2;
  CHECK_FALSE(same_bytes(fit.gmm, fit_gmm(x, options).gmm));
}

TEST_CASE("for each type neither units nor order matter, and the likelihood rises") {
  EmOptions options;
  options.components = 4;
  options.covariance_type =
      GENERATE(CovarianceType::full, CovarianceType::tied, CovarianceType::diagonal, CovarianceType::spherical);
  const Samples x = demonstrations(10, 2);
  GmmFit fit = fit_gmm(x, options);
  CHECK(same_bytes(fit.gmm, fit_gmm(x.colwise().reverse(), options).gmm));
  Vector scale(4);
  scale << 1e3, 1e-3, 7.3, 1e6;
  Samples scaled = x * scale.asDiagonal();
  scaled.rowwise() += Vector::Constant(4, 3.0).transpose();
  GmmFit other = fit_gmm(scaled, options);
  // Rounding decides which of the starts that end at the same maximum wins, and so the order of the components.
  fit.gmm = in_order_of_time(fit.gmm);
  other.gmm = in_order_of_time(other.gmm);
  CHECK(other.log_likelihood ==
        Approx(fit.log_likelihood - static_cast<double>(x.rows()) * scale.array().log().sum()).epsilon(1e-7));
  CHECK((other.gmm.priors - fit.gmm.priors).cwiseAbs().maxCoeff() < 1e-6);
  const Samples expected = (fit.gmm.means * scale.asDiagonal()).rowwise() + Vector::Constant(4, 3.0).transpose();
  CHECK(((other.gmm.means - expected).array().rowwise() / scale.transpose().array()).abs().maxCoeff() < 1e-6);
  CHECK(other.entropy == Approx(fit.entropy).epsilon(1e-4));
  for (std::size_t i = 1; i < fit.history.size(); ++i) {
    const bool reseeded = std::any_of(fit.collapses.begin(), fit.collapses.end(),
                                      [&](const Collapse& c) { return c.iteration == static_cast<int>(i); });
    if (!reseeded) CHECK(fit.history[i] >= fit.history[i - 1] - 1e-12 * std::abs(fit.history[i]));
  }
}

TEST_CASE("the covariances of a fit are of the type asked for") {
  EmOptions options;
  options.components = 3;
  Samples x = demonstrations(5, 12);
  x.col(2).setConstant(0.7);
  Vector variances(4);
  for (Index j = 0; j < 4; ++j) variances[j] = (x.col(j).array() - x.col(j).mean()).square().mean();
  options.covariance_type = CovarianceType::tied;
  const GmmFit tied = fit_gmm(x, options);
  for (const Matrix& Sigma : tied.gmm.covariances) CHECK(Sigma == tied.gmm.covariances[0]);
  // Also where the last iteration has started a component again.
  Matrix y = Matrix(demonstrations(2, 3)).rowwise() - demonstrations(2, 3).colwise().mean();
  EmRun run;
  run.gmm = {Vector::Constant(2, 0.5), y.topRows(2), std::vector<Matrix>(2, Matrix::Identity(4, 4))};
  run.gmm.means.row(1).setConstant(50.0);
  advance(y, Vector::Constant(4, 1e-6), options, 1, 1, run);
  REQUIRE(run.collapses.size() == 1);
  CHECK(run.gmm.covariances[0] == run.gmm.covariances[1]);
  options.covariance_type = CovarianceType::diagonal;
  for (const Matrix& Sigma : fit_gmm(x, options).gmm.covariances) CHECK(Sigma.isDiagonal(0.0));
  options.covariance_type = CovarianceType::spherical;
  const GmmFit spherical = fit_gmm(x, options);
  for (const Matrix& Sigma : spherical.gmm.covariances) {  // one variance, in standardised units
    CHECK(Sigma.isDiagonal(0.0));
    CHECK(Sigma(1, 1) / variances[1] == Approx(Sigma(0, 0) / variances[0]).epsilon(1e-9));
    CHECK(Sigma(3, 3) / variances[3] == Approx(Sigma(0, 0) / variances[0]).epsilon(1e-9));
    CHECK(Sigma(2, 2) == Approx(spherical.regularization[2]).epsilon(1e-9));  // constant
  }
  // One component is the mean of the standardised variances, 1, and the regularisation.
  options.components = 1;
  CHECK(fit_gmm(x, options).gmm.covariances[0](1, 1) == Approx(variances[1] * (1.0 + 1e-6)).epsilon(1e-12));
}

TEST_CASE("constant columns, copies of columns and equal samples are fitted") {
  EmOptions options;
  options.components = 3;
  Samples x = demonstrations(10, 3);
  const GmmFit whole = fit_gmm(x, options);
  x.col(3).setConstant(0.25);
  const GmmFit constant = fit_gmm(x, options);
  CHECK_NOTHROW(check(constant.gmm));
  CHECK(constant.regularization[3] == 1e-6);
  for (Index k = 0; k < 3; ++k) {
    CHECK(constant.gmm.means(k, 3) == 0.25);
    CHECK(constant.gmm.covariances[static_cast<std::size_t>(k)](3, 3) == Approx(1e-6).epsilon(1e-9));
  }
  CHECK(constant.gmm.priors.minCoeff() > 0.05);  // still three components that share the samples
  options.regularization = 0.0;
  CHECK_NOTHROW(check(fit_gmm(x, options).gmm));  // least_variance keeps the constant column

  x.col(3) = 2.0 * x.col(1);
  CHECK(id_of(x, options) == "gmm.singular");
  options.regularization = 1e-6;
  CHECK_NOTHROW(check(fit_gmm(x, options).gmm));

  x = Samples::Constant(20, 2, -7.0);
  const GmmFit point = fit_gmm(x, options);
  CHECK_NOTHROW(check(point.gmm));
  CHECK((point.gmm.means.array() == -7.0).all());
  options.components = 1;
  CHECK_NOTHROW(check(fit_gmm(Samples::Ones(1, 3), options).gmm));
}

TEST_CASE("a component that collapses is sown again where the mixture explains worst") {
  // Three clusters; the start puts two components on the first, one of them on a single sample.
  Random random(7);
  Matrix x(90, 2);
  for (Index i = 0; i < 90; ++i) {
    x.row(i) << static_cast<double>(i / 30) + 0.05 * random.normal(), 0.05 * random.normal();
  }
  EmRun run;
  run.gmm = {Vector::Constant(3, 1.0 / 3), Samples(3, 2), {}};
  run.gmm.means << 0.5, 0.0, x(89, 0), x(89, 1), x(0, 0), x(0, 1);
  run.gmm.covariances = {Matrix::Identity(2, 2) * 0.3, Matrix::Identity(2, 2) * 0.01, Matrix::Identity(2, 2) * 1e-9};
  const Vector R = Vector::Constant(2, 1e-6);
  EmOptions options;
  advance(x, R, options, 500, 1, run);
  REQUIRE_FALSE(run.collapses.empty());
  CHECK(run.collapses.front().component == 2);
  CHECK(run.collapses.front().iteration == 1);
  CHECK(run.collapses.front().samples < 3.0);
  CHECK(run.collapses.size() <= 3);
  CHECK(run.converged);
  CHECK((run.gmm.priors.array() - 1.0 / 3).abs().maxCoeff() < 0.02);
  // Apart from the re-seedings the objective never falls.
  for (std::size_t i = 1; i < run.history.size(); ++i) {
    const bool reseeded = std::any_of(run.collapses.begin(), run.collapses.end(),
                                      [&](const Collapse& c) { return c.iteration == static_cast<int>(i); });
    if (!reseeded) CHECK(run.history[i] >= run.history[i - 1] - 1e-12 * std::abs(run.history[i]));
  }
}

TEST_CASE("a run that is continued is the run that was not interrupted") {
  const Matrix x = demonstrations(5, 8);
  EmRun whole;
  whole.gmm = {Vector::Constant(2, 0.5), x.topRows(2), {Matrix::Identity(4, 4), Matrix::Identity(4, 4)}};
  EmRun parts = whole;
  const Vector R = Vector::Constant(4, 1e-6);
  advance(x, R, {}, 30, 1, whole);
  for (const int until : {1, 7, 30}) advance(x, R, {}, until, 1, parts);
  CHECK(parts.history == whole.history);
  CHECK(parts.iterations == whole.iterations);
  CHECK(same_bytes(parts.gmm, whole.gmm));
}

TEST_CASE("the table holds every K, the least BIC wins, and an edge is flagged") {
  Random random(9);
  Samples x(600, 2);
  for (Index i = 0; i < 600; ++i) x.row(i) << 4.0 * static_cast<double>(i % 3) + random.normal(), random.normal();
  EmOptions options;
  const ComponentSelection chosen = select_components(x, 1, 6, {}, options);
  CHECK(chosen.fit.gmm.components() == 3);
  CHECK_FALSE(chosen.at_edge);
  CHECK(chosen.bic_n == 600.0);
  REQUIRE(chosen.table.size() == 6);
  for (const Selection& row : chosen.table) {
    const double q = static_cast<double>(6 * row.k - 1);
    CHECK(row.bic == Approx(-2 * row.log_likelihood + q * std::log(600.0)).epsilon(1e-14));
    CHECK(row.aic == Approx(-2 * row.log_likelihood + 2 * q).epsilon(1e-14));
    CHECK(row.bic >= chosen.fit.bic);
  }
  CHECK(chosen.table[2].log_likelihood == chosen.fit.log_likelihood);
  options.components = 3;
  CHECK(same_bytes(chosen.fit.gmm, fit_gmm(x, options).gmm));
  CHECK(select_components(x, 1, 3, {}, options).at_edge);
  CHECK(select_components(x, 3, 5, {}, options).at_edge);
  CHECK_FALSE(select_components(x, 3, 3, {}, options).at_edge);
  const ComponentSelection fewer = select_components(x, 1, 3, {.bic_n = 50}, options);
  CHECK(fewer.fit.bic == Approx(-2 * fewer.fit.log_likelihood + 17 * std::log(50.0)).epsilon(1e-14));
}

TEST_CASE("what cannot be fitted is named") {
  EmOptions options;
  options.components = 4;
  Samples x = demonstrations(1, 4);
  CHECK(id_of(x.topRows(3), options) == "gmm.too_few_samples");
  CHECK(id_of(Samples(10, 0), options) == "gmm.shape");
  Samples bad = x;
  bad(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(id_of(bad, options) == "gmm.not_finite");
  bad(3, 1) = std::numeric_limits<double>::infinity();
  CHECK(id_of(bad, options) == "gmm.not_finite");
  bad(3, 1) = 1e300;
  CHECK(id_of(bad, options) == "gmm.out_of_range");
  CHECK_THROWS_AS(select_components(x, 3, 2, {}, options), UsageError);
  CHECK_THROWS_AS(select_components(x, 1, 2, {.bic_n = 0.5}, options), UsageError);
  CHECK_THROWS_AS(select_components(x, 1, 101, {}, options), DataError);
  for (const int wrong : {0, 1, 2, 3, 4}) {
    EmOptions broken = options;
    if (wrong == 0) broken.components = 0;
    if (wrong == 1) broken.restarts = 0;
    if (wrong == 2) broken.max_iterations = 0;
    if (wrong == 3) broken.tolerance = -1.0;
    if (wrong == 4) broken.regularization = std::numeric_limits<double>::quiet_NaN();
    CHECK(id_of(x, broken) == "gmm.option");
  }
}

TEST_CASE("a broken mixture is named with its place") {
  const Gmm good{Vector::Constant(2, 0.5), Samples::Zero(2, 2), {Matrix::Identity(2, 2), Matrix::Identity(2, 2)}};
  CHECK(id_of(good).empty());
  Gmm bad = good;
  bad.priors << 0.7, 0.7;
  CHECK(id_of(bad) == "gmm.priors /priors");
  bad.priors << 1.5, -0.5;
  CHECK(id_of(bad) == "gmm.priors /priors");
  bad = good;
  bad.covariances[1](0, 1) = 0.1;
  CHECK(id_of(bad) == "gmm.not_symmetric /covariances/1");
  bad.covariances[1] = Matrix::Ones(2, 2) * 2.0 - Matrix::Identity(2, 2);
  CHECK(id_of(bad) == "gmm.not_positive_definite /covariances/1");
  bad.covariances[1](1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(id_of(bad) == "gmm.not_finite /covariances/1");
  bad = good;
  bad.covariances.pop_back();
  CHECK(id_of(bad) == "gmm.shape ");
  CHECK(id_of(Gmm{}) == "gmm.shape ");
}
