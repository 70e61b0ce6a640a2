// A predicted motion with its band, and the shape of every method that is judged.
#pragma once

#include <functional>
#include <optional>

#include "lfdtools/fold.hpp"

namespace lfd {

/// Band about a path, one interval a phase and signal.
struct Band {
  Samples half_width;         ///< of the 95 % band, phase_count x D [m]
  Vector degrees_of_freedom;  ///< of the Student-t of each signal, D; infinite: normal

  /// Half-width at another level: by the ratio of the quantiles. @param level  in (0, 1)
  [[nodiscard]] Samples at(double level) const;
};

/// A predicted motion on the phases.
struct Predicted {
  Samples path;              ///< phase_count x D [m]
  std::optional<Band> band;  ///< if the method has one
};

/// A method that has learnt: asked for targets by their ends alone, so that nothing else of them can reach it.
using Predictor = std::function<Predicted(const Query&)>;

/// A method: learns from the targets of a fold. The targets outlive the predictor.
using Trainer = std::function<Predictor(const Fold&, const PreparationOptions&)>;

/// The 95 % band of normal errors. @param variance  phase_count x D [m^2]; what rounding left negative counts as 0
[[nodiscard]] Band normal_band(const Samples& variance);

}  // namespace lfd
