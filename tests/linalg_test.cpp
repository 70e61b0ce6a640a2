#include "lfdtools/linalg.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/semidefinite.hpp"

using namespace lfd;

TEST_CASE("a Cholesky factor reproduces its matrix, its determinant and its inverse") {
  Matrix A(3, 3);
  A << 4, 2, 0.6, 2, 5, 1, 0.6, 1, 3;
  const Matrix L = cholesky(A);
  CHECK((L * L.transpose() - A).cwiseAbs().maxCoeff() < 1e-14);
  const double determinant = 4 * (5 * 3 - 1) - 2 * (2 * 3 - 0.6) + 0.6 * (2 - 5 * 0.6);
  CHECK(log_determinant_from_cholesky(L) == Approx(std::log(determinant)).epsilon(1e-14));
  CHECK((A * cholesky_solve(L, Matrix::Identity(3, 3)) - Matrix::Identity(3, 3)).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a matrix with NaN or a negative eigenvalue has no Cholesky factor") {
  Matrix A = Matrix::Identity(2, 2);
  A(1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(cholesky(A), DataError);
  A << 1, 2, 2, 1;
  CHECK_THROWS_AS(cholesky(A), DataError);
}

TEST_CASE("a thin Cholesky factor is that of the rank, and what is not positive semidefinite has none") {
  const Matrix F = (Matrix(4, 2) << 1, 2, -1, 0.5, 3, 1, 0, 2).finished();
  const Matrix A = 1e-8 * F * F.transpose();
  Matrix L;
  REQUIRE(try_thin_cholesky(A, L));
  CHECK(L.cols() == 2);
  CHECK((L * L.transpose() - A).cwiseAbs().maxCoeff() < 1e-20);
  CHECK(try_thin_cholesky(Matrix::Zero(3, 3), L));
  CHECK(L.cols() == 0);
  CHECK(try_thin_cholesky(Matrix::Identity(40, 40), L));
  CHECK(L.cols() == 40);
  CHECK(!try_thin_cholesky((Matrix(2, 2) << 1, 2, 2, 1).finished(), L));
  CHECK(!try_thin_cholesky((Matrix(2, 2) << 0, 1, 1, 0).finished(), L));
  CHECK(!try_thin_cholesky((Matrix(2, 2) << 1, 0, 0, -1e-3).finished(), L));
  CHECK(!try_thin_cholesky(Matrix::Constant(2, 2, std::numeric_limits<double>::quiet_NaN()), L));
  CHECK(!try_thin_cholesky(Matrix::Zero(2, 3), L));
}

TEST_CASE("log-sum-exp neither overflows nor loses the smallest") {
  Vector v(3);
  v << 1000, 1000 + std::log(2.0), -1e308;
  CHECK(log_sum_exp(v) == Approx(1000 + std::log(3.0)).epsilon(1e-15));
  v.setConstant(-std::numeric_limits<double>::infinity());
  CHECK(log_sum_exp(v) == -std::numeric_limits<double>::infinity());
}

TEST_CASE("the log density of a plane normal equals the formula") {
  Matrix Sigma(2, 2);
  Sigma << 2, 0.5, 0.5, 1;
  Vector x(2);
  x << 0.3, -1.2;
  const Vector mu = Vector::Constant(2, 0.1);
  const double determinant = 2 * 1 - 0.25;
  const Vector e = x - mu;
  const double form = (1 * e[0] * e[0] - 2 * 0.5 * e[0] * e[1] + 2 * e[1] * e[1]) / determinant;
  const double expected = -std::log(2 * M_PI) - 0.5 * std::log(determinant) - 0.5 * form;
  CHECK(log_normal_density(x, mu, cholesky(Sigma)) == Approx(expected).epsilon(1e-14));
}

TEST_CASE("quantiles of Student's t equal its tables") {
  CHECK(student_t_quantile(0.975, 1) == Approx(12.706204736174698).epsilon(1e-12));
  CHECK(student_t_quantile(0.975, 2) == Approx(4.302652729749464).epsilon(1e-12));
  CHECK(student_t_quantile(0.975, 10) == Approx(2.228138851986273).epsilon(1e-12));
  CHECK(student_t_quantile(0.025, 30) == Approx(-2.0422724563012373).epsilon(1e-12));
  CHECK(student_t_quantile(0.975, std::numeric_limits<double>::infinity()) == Approx(1.959963984540054).epsilon(1e-12));
  CHECK(student_t_quantile(0.5, 3) == Approx(0).margin(1e-12));
}
