// A predicted motion with its band, and the shape of every method that is judged.
#pragma once

#include <functional>

#include "lfdtools/calibration.hpp"
#include "lfdtools/fold.hpp"

namespace lfd {

/// Half-widths of a band about a path, phase_count x D [m]. @param level  share promised, in (0, 1)
using Band = std::function<Samples(BandKind kind, double level)>;

/// A predicted motion on the phases.
struct Predicted {
  Samples path;  ///< phase_count x D [m]
  Band band;     ///< empty: the method has none
};

/// A method that has learnt: asked for targets by their ends alone, so that nothing else of them can reach it.
using Predictor = std::function<Predicted(const Query&)>;

/// A method: learns from the targets of a fold. The targets outlive the predictor.
using Trainer = std::function<Predictor(const Fold&, const PreparationOptions&)>;

/// The pointwise band of normal errors, for either kind. @param variance  phase_count x D [m^2]; what rounding left
/// negative counts as 0
[[nodiscard]] Band normal_band(const Samples& variance);

}  // namespace lfd
