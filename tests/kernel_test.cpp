#include "lfdtools/kernel.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "random_matrix.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

/// The documented formula, written once more without vectors.
double by_definition(const KernelTerm& term, const Vector& a, const Vector& b) {
  if (term.within >= 0 && a(term.within) != b(term.within)) return 0;
  double r2 = 0;
  double dot = 0;
  for (std::size_t q = 0; q < term.inputs.size(); ++q) {
    const double l = term.length_scales(static_cast<Eigen::Index>(q));
    const double x = a(term.inputs[q]) / l;
    const double y = b(term.inputs[q]) / l;
    r2 += (x - y) * (x - y);
    dot += x * y;
  }
  const double r = std::sqrt(r2);
  switch (term.type) {
    case KernelType::se_ard:
      return term.variance * std::exp(-r2 / 2);
    case KernelType::matern32:
      return term.variance * (1 + std::sqrt(3.0) * r) * std::exp(-std::sqrt(3.0) * r);
    case KernelType::matern52:
      return term.variance * (1 + std::sqrt(5.0) * r + 5 * r2 / 3) * std::exp(-std::sqrt(5.0) * r);
    case KernelType::linear:
      return term.variance * dot;
    case KernelType::constant:
      return term.variance;
  }
  return 0;
}

Kernel every_type() {
  Vector two(2);
  two << 0.7, 1.9;
  return {{{KernelType::se_ard, 0.8, {0, 2}, two},
           {KernelType::matern32, 1.3, {1}, Vector::Constant(1, 0.6)},
           {KernelType::matern52, 0.5, {2, 1}, two},
           {KernelType::linear, 0.4, {0, 1}, two},
           {KernelType::constant, 2.0, {}, {}}}};
}

/// Every type over columns 0 to 2, and again between rows that agree in column 3.
Kernel every_type_within() {
  Kernel kernel = every_type();
  for (KernelTerm term : every_type().terms) {
    term.within = 3;
    term.variance *= 0.7;
    kernel.terms.push_back(term);
  }
  return kernel;
}

/// Rows with a fourth column that tells three groups apart.
Matrix grouped(Matrix X) {
  X.conservativeResize(X.rows(), 4);
  for (Eigen::Index i = 0; i < X.rows(); ++i) X(i, 3) = static_cast<double>(i % 3);
  return X;
}

}  // namespace

TEST_CASE("a kernel is the sum of its terms' formulas") {
  const Kernel kernel = every_type_within();
  const Matrix A = grouped(random_matrix(7, 3, 1));
  const Matrix B = grouped(random_matrix(4, 3, 2));
  const Matrix K = covariance(kernel, A, B);
  const Matrix KA = covariance(kernel, A);
  REQUIRE(K.rows() == 7);
  REQUIRE(K.cols() == 4);
  for (Eigen::Index i = 0; i < 7; ++i) {
    double own = 0;
    for (const auto& term : kernel.terms) own += by_definition(term, A.row(i), A.row(i));
    CHECK(prior_variance(kernel, A.row(i).transpose()) == Approx(own).epsilon(1e-14));
    for (Eigen::Index j = 0; j < 7; ++j) {
      double expected = 0;
      double expected_own = 0;
      for (const auto& term : kernel.terms) {
        if (j < 4) expected += by_definition(term, A.row(i), B.row(j));
        expected_own += by_definition(term, A.row(i), A.row(j));
      }
      if (j < 4) CHECK(K(i, j) == Approx(expected).epsilon(1e-14));
      CHECK(KA(i, j) == Approx(expected_own).epsilon(1e-14));
    }
  }
  CHECK(KA == KA.transpose());
}

TEST_CASE("gradients in the logarithms of the hyperparameters are those of differences") {
  Kernel kernel;
  SECTION("a sum of every type, where variances are free") {
    kernel = every_type();
  }
  SECTION("a single se-ard term, whose variance stays") {
    kernel = se_ard_kernel(3);
  }
  SECTION("a single Matern term") {
    kernel = {{every_type().terms[2]}};
  }
  SECTION("terms that hold within groups") {
    kernel = every_type_within();
  }
  Matrix X = grouped(random_matrix(9, 3, 3));
  X.row(4) = X.row(1);  // two rows coincide: Matern kernels have no second derivative there
  Matrix V = random_matrix(9, 9, 4);
  V = (V + V.transpose()).eval();
  const Vector theta = log_hyperparameters(kernel);

  KernelMatrix matrix(X, kernel);
  Matrix K;
  matrix.evaluate(kernel, K);
  Vector gradient(theta.size());
  matrix.gradient(V.triangularView<Eigen::Lower>(), gradient);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double h = 1e-5;
    Vector up = theta;
    Vector down = theta;
    up(i) += h;
    down(i) -= h;
    const Matrix difference =
        covariance(with_log_hyperparameters(kernel, up), X) - covariance(with_log_hyperparameters(kernel, down), X);
    const double expected = V.cwiseProduct(difference).sum() / (2 * h);
    CHECK(gradient(i) == Approx(expected).epsilon(1e-7).margin(1e-7));
  }
}

TEST_CASE("hyperparameters go out and come back in the documented order") {
  const Kernel kernel = sum_kernel(2);  // constant, linear, two of one input, one of both
  REQUIRE(kernel.terms.size() == 5);
  Vector theta = log_hyperparameters(kernel);
  REQUIRE(theta.size() == 5 + 1 + 1 + 2);
  for (Eigen::Index i = 0; i < theta.size(); ++i) theta(i) = 0.1 * static_cast<double>(i + 1);
  const Kernel moved = with_log_hyperparameters(kernel, theta);
  CHECK((log_hyperparameters(moved) - theta).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(moved.terms[1].variance == Approx(std::exp(0.2)));
  CHECK(moved.terms[1].length_scales == Vector::Ones(2));  // a linear term keeps its length scales
  CHECK(moved.terms[2].length_scales(0) == Approx(std::exp(0.4)));
  CHECK(moved.terms[4].length_scales(1) == Approx(std::exp(0.9)));
  CHECK_THROWS_AS(with_log_hyperparameters(kernel, theta.head(8)), DataError);
  CHECK_THROWS_AS(with_log_hyperparameters(kernel, Vector::Zero(10)), DataError);
  CHECK(sum_kernel(1).terms.size() == 3);
}

TEST_CASE("a kernel that cannot be used is refused by name") {
  const auto id_of = [](const Kernel& kernel) { return refused_as(Fault::data, [&] { check_kernel(kernel, 2); }); };
  const KernelTerm good = se_ard_kernel(2).terms.front();
  CHECK(id_of({{good}}) == "");
  CHECK(id_of({}) == "kernel.no_terms");
  KernelTerm bad = good;
  bad.inputs = {0, 2};
  CHECK(id_of({{bad}}) == "kernel.bad_inputs");
  bad.inputs = {1, 1};
  CHECK(id_of({{bad}}) == "kernel.bad_inputs");
  bad = good;
  bad.within = 2;
  CHECK(id_of({{bad}}) == "kernel.bad_inputs");
  bad = good;
  bad.length_scales(1) = 0;
  CHECK(id_of({{bad}}) == "kernel.bad_length_scales");
  bad = good;
  bad.variance = std::nan("");
  CHECK(id_of({{bad}}) == "kernel.bad_variance");
  CHECK(id_of({{good, {KernelType::constant, 1, {0}, Vector::Ones(1)}}}) == "kernel.bad_inputs");
}

TEST_CASE("kernel types have names that read back") {
  for (const auto type :
       {KernelType::se_ard, KernelType::matern32, KernelType::matern52, KernelType::linear, KernelType::constant}) {
    CHECK(kernel_type_from_name(kernel_type_name(type)) == type);
  }
  CHECK(kernel_type_name(KernelType::se_ard) == "se-ard");
  CHECK_THROWS_AS(kernel_type_from_name("rbf"), DataError);
}
