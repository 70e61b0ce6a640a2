// How mvgpr-train learns, and what it says of its rows.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/skill.hpp"

namespace lfd::cli {

struct TrainingRequest {
  SkillOptions options;
  bool calibrated = true;
  bool leave_out_outliers = false;
};

/// A skill with its kernel chosen, and calibrated if asked for. Rows that repeat an earlier one of their target are
/// left out [skill.repeated_row]; outliers are named, or left out and the skill learnt again until there is none
/// [skill.outlier]. Warned of too: targets that coincide [skill.targets_coincide]. A note where there are too few
/// targets to calibrate [skill.not_calibrated].
/// @param rows  those learnt from, on return
/// @throws those of train_skill
[[nodiscard]] Skill learn(const std::vector<std::string>& columns, std::vector<SkillRow>& rows, TrainingRequest request,
                          Run& run);

}  // namespace lfd::cli
