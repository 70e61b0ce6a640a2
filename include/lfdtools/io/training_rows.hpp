// The rows that a skill is learnt from: primitives as files.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/skill.hpp"

namespace lfd {

struct TrainingRows {
  FileHeader header;  ///< columns and provenance of the first document
  std::vector<SkillRow> rows;
};

/// All `lfdtools.dmp` documents of a stream.
/// @throws DataError [json.group_reappears] for two documents of one target, teacher and demo; [skill.mixed_settings]
///         with the pointer, where columns, scaling, alpha_z, beta_z, alpha_x, centers or widths are not those of the
///         first; those of read_dmp
[[nodiscard]] TrainingRows read_training_rows(JsonStream& stream);

}  // namespace lfd
