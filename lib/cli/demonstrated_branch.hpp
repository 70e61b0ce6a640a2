// The posture of --posture: which branch of the inverse kinematics demonstrations keep.
#pragma once

#include <string>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/ur10.hpp"

namespace lfd::cli {

/// The branch that the demonstrations of a file keep, 0..7, see branch_name. Warns where they do not agree, leave their
/// branch, or are near a singularity.
/// @param file  demonstrations with q1..q6 [rad]
/// @throws those of CsvTable, DemonstrationSource and demonstrated_posture
[[nodiscard]] int demonstrated_branch(const std::string& file, const InverseKinematics& arm, Run& run);

}  // namespace lfd::cli
