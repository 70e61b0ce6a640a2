// How a motion follows a goal that is not exactly known (posterior.hpp).
#include <Eigen/Eigenvalues>

#include "lfdtools/posterior.hpp"

namespace lfd {

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
  Goal moved = goal;
  if (!goal.duration) {
    const Vector change = goal.position - goal.start.value_or(predictor.skill().start);
    moved.duration = predictor.skill().duration.predict(change);
  }
  const Eigen::Index D = goal.position.size();
  spread.factors.assign(static_cast<std::size_t>(D), Matrix::Zero(times.size(), D));
  const auto motion_to = [&](const Vector& position) {
    moved.position = position;
    return rollout(predict_motion(predictor, moved, constraints).course, times).positions;
  };
  for (Eigen::Index i = 0; i < D; ++i) {
    if (!(G.col(i).norm() > 0)) continue;
    const Samples half = (motion_to(goal.position + G.col(i)) - motion_to(goal.position - G.col(i))) / 2;
    for (Eigen::Index j = 0; j < D; ++j) spread.factors[static_cast<std::size_t>(j)].col(i) = half.col(j);
  }
  return spread;
}

}  // namespace lfd
