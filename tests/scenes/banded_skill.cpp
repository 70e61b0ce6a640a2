#include "banded_skill.hpp"

#include "lfdtools/calibration.hpp"
#include "lfdtools/posterior.hpp"

namespace lfd::scenes {

BandedSkill::BandedSkill(std::vector<SkillRow> rows) : rows_(std::move(rows)) {
  const std::vector<std::string> xyz = {"x", "y", "z"};
  SkillOptions options;
  options.kernel = choose_kernel(xyz, rows_, options);
  const Skill together = train_skill(xyz, rows_, options);
  ways_ = two_ways(together, rows_);
  for (const int way : {0, 1}) {
    if (!ways_ && way == 1) break;
    const auto of_way = ways_ ? rows_of_way(rows_, *ways_, way) : rows_;
    Skill skill = ways_ ? train_skill(xyz, of_way, options) : together;
    skill.calibration = calibrate(skill, of_way, options);
    predictors_.emplace_back(std::move(skill));
  }
}

std::size_t BandedSkill::way_to(const Vector3& change) const {
  return ways_ ? static_cast<std::size_t>(nearest_way(rows_, *ways_, change)) : 0;
}

HandSpread BandedSkill::spread(const Goal& goal, const Vector& times) const {
  const SkillPredictor& predictor = predictors_.at(way_to(goal.position - *goal.start));
  std::vector<Matrix> covariance = motion_covariance(predict_motion(predictor, goal), times, Spread::latent);
  const Vector factors = covariance_factors(predictor, predictor.reach(goal));
  for (std::size_t j = 0; j < covariance.size() && factors.size() > 0; ++j) {
    covariance[j] *= factors[static_cast<Eigen::Index>(j)];
  }
  const HandSpread spread = hand_spread(covariance, Matrix3::Identity());
  const GoalSpread of_goal = goal_spread(predictor, goal, {}, times);
  if (of_goal.factors.empty()) return spread;
  HandSpread more{Matrix(3 * times.size(), 3)};
  for (Eigen::Index t = 0; t < times.size(); ++t) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      more.factor.row(3 * t + j) = of_goal.factors[static_cast<std::size_t>(j)].row(t);
    }
  }
  return together(spread, more);
}

}  // namespace lfd::scenes
