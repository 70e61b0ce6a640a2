// Demonstrations by target, to learn from and to be judged on.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/fold.hpp"
#include "lfdtools/io/demonstrations.hpp"

namespace lfd {

/// All targets of a table with their demonstrations, in order of first appearance.
[[nodiscard]] std::vector<TargetDemonstrations> read_targets(const DemonstrationSource& source);

/// Targets of a file to be judged on, with the signals that were learnt. Noted: those that were learnt from too
/// [validation.target_known].
/// @param columns     signals   @param known  targets that are learnt from
/// @param noise_free  what is there are intentions: one path a target
/// @throws as CsvTable and DemonstrationSource; DataError [validation.noise_free] for a second path of a target
[[nodiscard]] std::vector<TargetDemonstrations> read_test_targets(const std::string& name,
                                                                  const std::vector<std::string>& columns,
                                                                  const std::vector<TargetDemonstrations>& known,
                                                                  bool noise_free, Messages& messages);

}  // namespace lfd
