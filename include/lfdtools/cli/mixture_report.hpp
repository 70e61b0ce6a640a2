// What gmm-fit says about a fit.
#pragma once

#include <string>

#include "lfdtools/cli/run.hpp"
#include "lfdtools/gmm.hpp"

namespace lfd::cli {

/// The table of the choice of K for --verbose; warnings where K is an edge of the range [gmm.edge], EM did not converge
/// [gmm.not_converged], or the criterion counts more samples than there are [gmm.bic_n]; a note of each component that
/// had collapsed [gmm.collapse]; the number of components for --summary.
/// @param who  the target, in words
void report(const ComponentSelection& selection, const CriterionOptions& criterion, const std::string& who, Run& run);

}  // namespace lfd::cli
