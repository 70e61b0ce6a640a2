// The default skill with its bands, as mvgpr-train writes and skill-generate reads it: one a way round.
#pragma once

#include <optional>
#include <vector>

#include "lfdtools/hand_spread.hpp"
#include "lfdtools/prediction.hpp"
#include "lfdtools/skill_train.hpp"
#include "lfdtools/ways.hpp"

namespace lfd::scenes {

class BandedSkill {
 public:
  explicit BandedSkill(std::vector<SkillRow> rows);

  /// The two ways that the rows take, if they do.
  [[nodiscard]] const std::optional<Ways>& ways() const { return ways_; }
  /// The way that goes to a goal. @param change  from start to goal [m]
  [[nodiscard]] std::size_t way_to(const Vector3& change) const;

  /// How far the hand may be off by the calibrated latent covariance, the frame being the base.
  /// @param goal  where its covariance is not empty, what that adds is part of it
  /// @param times  T
  [[nodiscard]] HandSpread spread(const Goal& goal, const Vector& times) const;

 private:
  std::vector<SkillRow> rows_;
  std::optional<Ways> ways_;
  std::vector<SkillPredictor> predictors_;  // by way
};

}  // namespace lfd::scenes
