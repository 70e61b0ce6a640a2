// Skill files, format lfdtools.skill.
#pragma once

#include "lfdtools/io/provenance.hpp"
#include "lfdtools/skill.hpp"

namespace lfd {

inline constexpr std::string_view skill_format = "lfdtools.skill";

struct SkillFile {
  FileHeader header;  ///< columns: the signals
  Skill skill;
};

/// @throws as JsonView; DataError [skill.shape] where parts disagree, [skill.outputs] unless every signal is the output
/// of
///         exactly one model; those of check(DmpSettings) and MvgpPredictor, each with its pointer
[[nodiscard]] SkillFile read_skill(const JsonDocument& document);

/// One line.
void write_skill(const SkillFile& file, Output& out);

}  // namespace lfd
