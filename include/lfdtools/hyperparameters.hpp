// The search for the hyperparameters of the multivariate process.
#pragma once

#include "lfdtools/mvgp.hpp"

namespace lfd {

/// theta of `Evidence` at the maximum of evidence times priors, inside the box of `train_mvgp`. Descents from several
/// starts: one from the distances of the rows, the others each from the best of seeded draws, uniform in the logarithm.
/// The same for any number of threads.
/// @param X  n x p [m]
/// @param blocks  outputs that share the hyperparameters, transformed
/// @param kernel  terms; the length scales of linear terms stay as they are
/// @param options  its priors, starts, seed and jobs are used
/// @throws DataError those of `Evidence`
[[nodiscard]] Vector hyperparameters_of_maximum_evidence(const Matrix& X, const std::vector<OutputBlock>& blocks,
                                                         const Kernel& kernel, const EvidenceSettings& settings,
                                                         const MvgpOptions& options);

}  // namespace lfd
