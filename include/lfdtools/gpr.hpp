// Scalar Gaussian process regression, one output at a time: the road before multivariate processes.
#pragma once

#include "lfdtools/prediction.hpp"

namespace lfd {

/// Every weight a process of its own over dP (Forte, Gams, Morimoto and Ude 2012, reference [7] of the paper): se-ard
/// kernel, zero mean, weights standardised over all rows, signal variance, length scales and noise at the maximum of
/// the evidence. Needs primitives. The band takes weights as independent, and the noise as one demonstration's over
/// Query::repetitions.
[[nodiscard]] Predictor train_gpr(const Fold& fold, const PreparationOptions& options);

}  // namespace lfd
