#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/posterior.hpp"
#include "posterior_fixture.hpp"

using namespace lfd;

TEST_CASE("a goal that is not exactly known spreads the motion: at the end as itself, at the start not at all") {
  MotionConstraints via;
  via.via.push_back(via_beside(full(), vec(0.002, 0, 0.001)));
  const Vector times = linspace(0, 2, 21);
  Goal goal = some_goal();
  CHECK(goal_spread(full(), goal, {}, times).factors.empty());
  goal.covariance = Matrix::Zero(3, 3);
  goal.covariance(0, 0) = 4e-6;
  goal.covariance(0, 1) = goal.covariance(1, 0) = 1e-6;
  goal.covariance(1, 1) = 1e-6;  // the third signal is exactly known
  for (const auto& constraints : {MotionConstraints(), via}) {
    const GoalSpread spread = goal_spread(full(), goal, constraints, times);
    const Samples variance = spread.variance(Samples::Zero(21, 3));
    CHECK(variance.row(0).maxCoeff() < 1e-15);
    Matrix end(3, 3);
    for (Eigen::Index j = 0; j < 3; ++j) end.row(j) = spread.factors[static_cast<std::size_t>(j)].row(20);
    CHECK(distance(end * end.transpose(), goal.covariance) < 1e-10);
    if (constraints.empty()) continue;
    CHECK(variance.row(9).maxCoeff() < 1e-15);  // the point to pass stays where it is
  }
  // Many goals drawn from that distribution: the spread of their motions.
  const GoalSpread spread = goal_spread(full(), goal, {}, times);
  const Samples variance = spread.variance(Samples::Zero(21, 3));
  const Matrix L = cholesky(goal.covariance + 1e-18 * Matrix::Identity(3, 3));
  const Samples mean = positions(predict_motion(full(), some_goal()), times);
  Samples squares = Samples::Zero(21, 3);
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    Goal drawn = some_goal();
    drawn.position += L * vec(random.normal(), random.normal(), random.normal());
    squares.array() += (positions(predict_motion(full(), drawn), times) - mean).array().square() / 2000;
  }
  CHECK(distance(squares, variance) < 0.15 * variance.maxCoeff());
}
