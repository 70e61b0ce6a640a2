#include "lfdtools/affine.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "judge_fixture.hpp"
#include "lfdtools/metrics.hpp"
#include "random_matrix.hpp"

using namespace lfd;

namespace {

/// The evidence by its definition, without singular vectors.
double evidence(const Matrix& X, const Matrix& Y, double penalty) {
  const Matrix A = X.rowwise() - X.colwise().mean();
  const Matrix Yc = Y.rowwise() - Y.colwise().mean();
  const Matrix K = Matrix::Identity(X.rows(), X.rows()) + A * A.transpose() / penalty;
  const double trace = (Yc.transpose() * K.inverse() * Yc).trace();
  const double d = static_cast<double>(Y.cols());
  return d / 2 * std::log(K.determinant()) + static_cast<double>(X.rows() - 1) * d / 2 * std::log(trace);
}

}  // namespace

TEST_CASE("least squares solves the normal equations, and where rows leave it open, with the smallest coefficients") {
  const Matrix X = random_matrix(20, 3, 1);
  const Matrix Y = random_matrix(20, 4, 2);
  Matrix H(20, 4);
  H << Vector::Ones(20), X;
  CHECK((fit_affine(X, Y) - (H.transpose() * H).inverse() * H.transpose() * Y).norm() < 1e-12);
  const Matrix few = H.topRows(2);  // B = H^T (H H^T)^-1 Y
  const Matrix smallest = few.transpose() * (few * few.transpose()).inverse() * Y.topRows(2);
  CHECK((fit_affine(X.topRows(2), Y.topRows(2)) - smallest).norm() < 1e-12);
}

TEST_CASE("the prior's slopes are ridge regression at a penalty of greatest evidence") {
  const Matrix X = random_matrix(15, 3, 3);
  const Matrix Y = X * random_matrix(3, 5, 4) + 2 * random_matrix(15, 5, 5);
  const AffinePosterior fit = fit_affine_prior(X, Y);
  const Matrix A = X.rowwise() - X.colwise().mean();
  const Matrix ridge = (A.transpose() * A + fit.penalty * Matrix::Identity(3, 3)).inverse() * A.transpose() *
                       (Y.rowwise() - Y.colwise().mean());
  CHECK((fit.slopes - ridge).norm() < 1e-11);
  for (const double factor : {0.5, 0.8, 0.93, 1.07, 1.25, 2.0}) {
    CHECK(evidence(X, Y, fit.penalty) <= evidence(X, Y, factor * fit.penalty));
  }
}

TEST_CASE("a map that is affine is found by all four, whatever way they go") {
  // Every path: a bump whose height is affine in dP.
  const Vector phases = linspace(0, 1, phase_count);
  const Vector bump = 4 * (phases.array() * (1 - phases.array())).cube();  // up to 62 mm a unit
  const auto path = [&](const Vector& start, const Vector& goal) -> Samples {
    const Vector change = goal - start;
    Samples motion = straight_line(start, goal, phases);
    motion.col(1) += (2 + 3 * change[0] - change[1]) * bump;
    return motion;
  };
  auto training = small_training();
  PreparationOptions options;
  std::vector<TrainingTarget> bumps;
  for (std::size_t i = 0; i < training.size(); ++i) {
    std::vector<Trajectory> recordings;
    for (const auto& e : training[i].examples) recordings.push_back({phases, path(e.start, e.goal)});
    bumps.push_back(training_target({}, recordings, options, {.primitives = true, .paper = false}, i));
  }
  Query query = small_query();
  query.goal[2] = query.start[2] + training[0].change()[2];  // does not vary: no map can know what it does
  const Samples wanted = path(query.start, query.goal);
  for (const auto train : {train_affine, train_affine_means, train_affine_prior, train_affine_ends}) {
    CHECK(rms_distance(train(all_of(bumps), options)(query).path, wanted) < 2e-3);  // of 150 mm; a prior shrinks
  }
}

TEST_CASE("inputs or outputs that do not vary give no slope") {
  const AffinePosterior same = fit_affine_prior(Matrix::Ones(4, 2), random_matrix(4, 3, 6));
  CHECK(same.slopes.norm() == 0);
  CHECK(fit_affine_prior(random_matrix(4, 2, 7), Matrix::Ones(4, 3))(Vector::Zero(2)) == Vector::Ones(3));
}
