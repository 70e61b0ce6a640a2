// How a motion follows its goal (posterior.hpp).
#include <Eigen/Eigenvalues>

#include "lfdtools/posterior.hpp"

namespace lfd {

std::vector<Samples> goal_derivative(const SkillPredictor& predictor, const Goal& goal,
                                     const MotionConstraints& constraints, const Vector& times) {
  constexpr double h = 1e-5;
  Goal moved = goal;
  if (!goal.duration) {
    const Vector change = goal.position - goal.start.value_or(predictor.skill().start);
    moved.duration = predictor.skill().duration.predict(change);
  }
  std::vector<Samples> derivative;
  for (Eigen::Index j = 0; j < goal.position.size(); ++j) {
    moved.position = goal.position + h * Vector::Unit(goal.position.size(), j);
    const Samples above = rollout(predict_motion(predictor, moved, constraints).course, times).positions;
    moved.position = goal.position - h * Vector::Unit(goal.position.size(), j);
    const Samples below = rollout(predict_motion(predictor, moved, constraints).course, times).positions;
    derivative.emplace_back((above - below) / (2 * h));
  }
  return derivative;
}

Samples GoalSpread::variance(const Samples& like) const {
  Samples result = Samples::Zero(like.rows(), like.cols());
  for (std::size_t j = 0; j < factors.size(); ++j) {
    result.col(static_cast<Eigen::Index>(j)) = factors[j].rowwise().squaredNorm();
  }
  return result;
}

GoalSpread goal_spread(const SkillPredictor& predictor, const Goal& goal, const MotionConstraints& constraints,
                       const Vector& times) {
  GoalSpread spread;
  if (goal.covariance.size() == 0) return spread;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(goal.covariance);  // a signal may be exactly known
  const Matrix G = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const auto J = goal_derivative(predictor, goal, constraints, times);
  const Eigen::Index D = goal.position.size();
  for (Eigen::Index j = 0; j < D; ++j) {
    Matrix rows(times.size(), D);
    for (Eigen::Index i = 0; i < D; ++i) rows.col(i) = J[static_cast<std::size_t>(i)].col(j);
    spread.factors.emplace_back(rows * G);
  }
  return spread;
}

}  // namespace lfd
