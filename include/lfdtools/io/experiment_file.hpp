// Experiments as files, format lfdtools.experiment: members as in struct Experiment and the structs inside it.
#pragma once

#include "lfdtools/io/json.hpp"
#include "lfdtools/io/output.hpp"
#include "lfdtools/synthesis.hpp"

namespace lfd {

/// Needs start and holes; every other member has the default of its struct. At most 10^4 holes and 10^6 repetitions.
/// @throws as JsonView and check(Experiment), with the file
[[nodiscard]] Experiment read_experiment(const JsonDocument& document);

/// One line that states everything, defaults included.
void write_experiment(const Experiment& experiment, Output& out);

}  // namespace lfd
