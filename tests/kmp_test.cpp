#include "lfdtools/kmp.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "judge_fixture.hpp"

using namespace lfd;

TEST_CASE("with covariances that are multiples of the identity, every signal is kernel ridge regression") {
  KmpReference reference{linspace(0, 1, 6), Samples(6, 2), CovarianceList(6, 2)};
  Vector noise(6);
  noise << 0.1, 0.2, 0.05, 0.3, 0.1, 0.01;
  for (Eigen::Index i = 0; i < 6; ++i) {
    reference.means.row(i) << std::sin(3.0 * static_cast<double>(i)), static_cast<double>(i * i) / 10;
    reference.covariances[i] = noise[i] * Matrix::Identity(2, 2);
  }
  const Vector phases = linspace(0, 1, 4);
  const auto kernel = [](const Vector& a, const Vector& b) {
    Matrix k(a.size(), b.size());
    for (Eigen::Index i = 0; i < a.size(); ++i) {
      for (Eigen::Index j = 0; j < b.size(); ++j) k(i, j) = std::exp(-5 * (a[i] - b[j]) * (a[i] - b[j]));
    }
    return k;
  };
  const Matrix K = kernel(reference.phases, reference.phases) + 0.7 * Matrix(noise.asDiagonal());
  const Matrix cross = kernel(phases, reference.phases);
  const KmpPrediction prediction = predict_kmp(reference, phases, 5, 0.7);
  CHECK((prediction.mean - cross * K.inverse() * reference.means).norm() < 1e-10);
  const Matrix left = cross * K.inverse() * cross.transpose();
  for (Eigen::Index t = 0; t < 4; ++t) {
    const Matrix expected = 6 / 0.7 * (1 - left(t, t)) * Matrix::Identity(2, 2);
    CHECK((prediction.covariances[t] - expected).norm() < 1e-9);
  }
}

TEST_CASE("the desired points hold: a motion begins at the query's start and ends at its goal") {
  const auto training = small_training();
  const Query query = small_query();
  const Predicted predicted = train_kmp(all_of(training), {})(query);
  CHECK((predicted.path.row(0).transpose() - query.start).norm() < 1e-3);
  CHECK((predicted.path.row(phase_count - 1).transpose() - query.goal).norm() < 1e-3);
}
