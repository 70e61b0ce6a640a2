#include "lfdtools/prediction.hpp"

#include <limits>

#include "lfdtools/gaussian.hpp"

namespace lfd {

Samples Band::at(double level) const {
  Samples scaled = half_width;
  for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
    const double nu = degrees_of_freedom[j];
    scaled.col(j) *= student_t_quantile((1 + level) / 2, nu) / student_t_quantile(0.975, nu);
  }
  return scaled;
}

Band normal_band(const Samples& variance) {
  const double infinite = std::numeric_limits<double>::infinity();
  return {student_t_quantile(0.975, infinite) * variance.cwiseMax(0.0).cwiseSqrt(),
          Vector::Constant(variance.cols(), infinite)};
}

}  // namespace lfd
