#include "lfdtools/prediction.hpp"

#include <limits>

#include "lfdtools/gaussian.hpp"

namespace lfd {

Band normal_band(const Samples& variance) {
  const Samples sd = variance.cwiseMax(0.0).cwiseSqrt();
  return [sd](BandKind, double level) -> Samples {
    return student_t_quantile((1 + level) / 2, std::numeric_limits<double>::infinity()) * sd;
  };
}

}  // namespace lfd
