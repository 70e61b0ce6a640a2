// How mvgpr-train learns, and what it says of its rows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/skill_train.hpp"

namespace lfd::cli {

struct TrainingRequest {
  SkillOptions options;
  bool calibrated = true;
  bool leave_out_outliers = false;
  bool two_ways_refused = true;     ///< by the gate two_ways; else warned of
  std::optional<std::int64_t> way;  ///< of two ways round the one to learn, 1 or 2
};

/// A skill with its kernel chosen, and calibrated if asked for. Rows that repeat an earlier one of their target are
/// left out [skill.repeated_row]; outliers are named, or left out and the skill learnt again until there is none
/// [skill.outlier]. Where demonstrations go two ways round the gate two_ways refuses them, unless one way is asked for
/// [skill.one_way where there is no other], or warns of them [skill.two_ways]. Warned of too: targets that coincide
/// [skill.targets_coincide]. A note where there are too few targets to calibrate [skill.not_calibrated].
/// @param rows  those learnt from, on return
/// @throws those of train_skill
[[nodiscard]] Skill learn(const std::vector<std::string>& columns, std::vector<SkillRow>& rows, TrainingRequest request,
                          Run& run);

}  // namespace lfd::cli
