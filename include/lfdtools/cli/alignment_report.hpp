// What demo-align says and writes beside the aligned demonstrations.
#pragma once

#include "lfdtools/alignment.hpp"
#include "lfdtools/cli/run.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/labelled_table.hpp"

namespace lfd::cli {

/// Warns of outliers [align.outlier]; notes of what was cut, if `trimmed` [align.trimmed], and for --verbose the
/// reference [align.reference].
/// @param pool  the recordings of the group, every one with a demo label
void report(const GroupAlignment& group, const Pool& pool, bool trimmed, Run& run);

/// A row `demo_a,demo_b,cost` a pair.   @param costs  M x M, symmetric
void write_costs(LabelledTable& table, const Pool& pool, const Matrix& costs);

}  // namespace lfd::cli
