// What the scores of a validation say over all targets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/validation.hpp"

namespace lfd {

/// Errors of one method.
struct MethodErrors {
  std::string method;
  std::vector<double> rmse;  ///< of each target, in the order of the scores [m]
  double mean = 0;           ///< [m]
};
/// By method, in the order of the scores.
[[nodiscard]] std::vector<MethodErrors> errors_by_method(const Validation& validation);

/// Mean noise floor over the targets that have one [m]; empty if none has.
[[nodiscard]] std::optional<double> mean_noise_floor(const Validation& validation);

/// A method's mean error over that of an opponent.
struct ErrorRatio {
  std::string method;
  std::string opponent;
  double ratio = 1;
  double low = 1;  ///< 95 % interval of the ratio
  double high = 1;
};

/// `skill` beside the method marked simple (methods.hpp) that has the least mean rmse over all targets. The interval is
/// the percentile bootstrap's over targets: 2000 resamples of the targets, with replacement and one seed for ever; the
/// opponent stays that one.
/// @return empty unless the validation holds `skill` and a simple method, with a mean error over zero
[[nodiscard]] std::optional<ErrorRatio> against_best_simple(const Validation& validation);

/// How often a band holds what it says, over all targets.
struct Reliability {
  std::string method;
  double nominal = 0;    ///< level of the band
  double pointwise = 0;  ///< mean of BandScore::pointwise
  double path = 0;       ///< share of targets whose whole path is inside
  double width = 0;      ///< mean of BandScore::width [m]
};
/// By method with a band, then by nominal level.
[[nodiscard]] std::vector<Reliability> reliability(const Validation& validation);

}  // namespace lfd
