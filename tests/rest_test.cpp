#include "lfdtools/rest.hpp"

#include <catch2/catch.hpp>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/trajectory.hpp"

using namespace lfd;

namespace {

Dmp random_primitive(Random& random, DmpScaling scaling, double alpha_z) {
  Dmp dmp;
  dmp.settings = make_dmp_settings(15, scaling, alpha_z);
  dmp.tau = 2.5;
  dmp.start = Vector::Zero(2);
  dmp.goal = Vector::Zero(2);
  dmp.goal << 0.4, -0.2;
  dmp.weights = Matrix(2, 15);
  for (Eigen::Index i = 0; i < dmp.weights.size(); ++i) dmp.weights(i) = 200 * random.normal();
  dmp.rmse = Vector::Zero(2);
  return dmp;
}

}  // namespace

TEST_CASE("corrected weights bring the motion to its goal at tau, at rest, and it stays") {
  Random random(3);
  for (const auto scaling : {DmpScaling::none, DmpScaling::goal}) {
    for (const double alpha_z : {10.0, 25.0, 60.0}) {
      Dmp dmp = random_primitive(random, scaling, alpha_z);
      dmp.weights = RestConditions(dmp.settings, Matrix::Identity(15, 15)).apply(dmp);
      const Motion end = rollout(dmp, Vector::Constant(1, dmp.tau));
      CHECK((end.positions.row(0).transpose() - dmp.goal).norm() < 1e-10);
      CHECK(end.velocities.row(0).norm() < 1e-9);
      CHECK(end.accelerations.row(0).norm() < 1e-7);
    }
  }
}

TEST_CASE("the change is the smallest in the metric: any other way to meet the conditions is longer") {
  Random random(5);
  Dmp dmp = random_primitive(random, DmpScaling::none, 25);
  Matrix A = Matrix::Identity(15, 15);
  for (Eigen::Index i = 0; i < 15; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) A(i, j) = 0.2 * random.normal();
  }
  const RestConditions conditions(dmp.settings, A);
  const Matrix corrected = conditions.apply(dmp);
  const double shortest = ((corrected - dmp.weights) * A).norm();
  for (int trial = 0; trial < 50; ++trial) {
    Dmp other = dmp;
    for (Eigen::Index i = 0; i < 30; ++i) other.weights(i) += 5 * random.normal();
    CHECK(((conditions.apply(other) - dmp.weights) * A).norm() >= shortest * (1 - 1e-9));
  }
}

TEST_CASE("weights that meet the conditions stay as they are, and mixtures of them meet them") {
  Random random(9);
  const auto first = random_primitive(random, DmpScaling::none, 25);
  auto second = random_primitive(random, DmpScaling::none, 25);
  second.goal << 0.1, 0.3;
  const RestConditions conditions(first.settings, Matrix::Identity(15, 15));
  Dmp mixture = first;
  mixture.goal = 0.3 * first.goal + 0.7 * second.goal;
  mixture.weights = 0.3 * conditions.apply(first) + 0.7 * conditions.apply(second);
  CHECK((conditions.apply(mixture) - mixture.weights).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("four bases are too few") {
  CHECK_THROWS_AS(RestConditions(make_dmp_settings(4), Matrix::Identity(4, 4)), DataError);
}
