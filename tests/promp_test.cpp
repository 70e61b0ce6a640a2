#include "lfdtools/promp.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "judge_fixture.hpp"
#include "lfdtools/metrics.hpp"
#include "random_matrix.hpp"

using namespace lfd;

TEST_CASE("conditioning is that of the joint Gaussian, by its information form") {
  const Matrix root = random_matrix(6, 6, 1);
  const WeightDistribution prior{random_matrix(6, 1, 2), root * root.transpose()};
  const Matrix H = random_matrix(2, 6, 3);
  const Vector values = random_matrix(2, 1, 4);
  const WeightDistribution w = conditioned(prior, H, values, 0.1);
  const Matrix information = prior.covariance.inverse() + H.transpose() * H / 0.1;
  const Matrix covariance = information.inverse();
  CHECK((w.covariance - covariance).norm() < 1e-10);
  CHECK((w.mean - covariance * (prior.covariance.inverse() * prior.mean + H.transpose() * values / 0.1)).norm() <
        1e-10);
}

TEST_CASE("shrinkage is Ledoit and Wolf's, row by row from the definition") {
  Matrix rows = random_matrix(9, 5, 5);
  rows.col(0) *= 5;  // far enough from a multiple of the identity
  const Matrix centred = rows.rowwise() - rows.colwise().mean();
  Matrix S = Matrix::Zero(5, 5);
  for (Eigen::Index i = 0; i < 9; ++i) S += centred.row(i).transpose() * centred.row(i) / 9.0;
  const double m = S.trace() / 5;
  double error = 0;
  for (Eigen::Index i = 0; i < 9; ++i) error += (centred.row(i).transpose() * centred.row(i) - S).squaredNorm() / 81.0;
  const double share = error / (S - m * Matrix::Identity(5, 5)).squaredNorm();
  REQUIRE(share < 1);
  CHECK((shrunk_covariance(rows) - (1 - share) * S - share * m * Matrix::Identity(5, 5)).norm() < 1e-12);
  CHECK(shrunk_covariance(Matrix::Ones(1, 3)).norm() == 0);
}

TEST_CASE("basis functions sum to one and peak at their centres") {
  const Matrix Phi = phase_basis(linspace(0, 1, 11), 6);
  CHECK((Phi.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-14);
  for (Eigen::Index b = 0; b < 6; ++b) CHECK(Phi(2 * b, b) == Phi.row(2 * b).maxCoeff());
}

TEST_CASE("a conditioned motion meets both ends of the query, where its band closes") {
  const auto training = small_training();
  const Query query = small_query();
  const Predicted predicted = train_promp(all_of(training), {})(query);
  CHECK((predicted.path.row(0).transpose() - query.start).norm() < 2e-3);
  CHECK((predicted.path.row(phase_count - 1).transpose() - query.goal).norm() < 2e-3);
  REQUIRE(predicted.band);
  CHECK(predicted.band(BandKind::pointwise, 0.95).row(0).maxCoeff() <
        predicted.band(BandKind::pointwise, 0.95).row(100).maxCoeff());
  CHECK(predicted.band(BandKind::pointwise, 0.95).row(0).maxCoeff() < 2.1e-3);
}
