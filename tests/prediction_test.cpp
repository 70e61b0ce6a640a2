#include "lfdtools/prediction.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "lfdtools/gaussian.hpp"

using namespace lfd;

TEST_CASE("a band at another level is scaled by the quantiles of its own distribution") {
  Vector nu(2);
  nu << 4, std::numeric_limits<double>::infinity();
  const Band band{Samples::Ones(3, 2), nu};
  CHECK(band.at(0.95).isApprox(band.half_width));
  CHECK(band.at(0.5)(1, 0) == Approx(student_t_quantile(0.75, 4) / student_t_quantile(0.975, 4)));
  CHECK(band.at(0.5)(1, 1) == Approx(0.674489750196 / 1.959963984540).epsilon(1e-9));
}

TEST_CASE("the normal band is 1.96 standard deviations; rounding below zero is zero") {
  Samples variance(1, 2);
  variance << 4, -1e-18;
  const Band band = normal_band(variance);
  CHECK(band.half_width(0, 0) == Approx(3.919927969080).epsilon(1e-9));
  CHECK(band.half_width(0, 1) == 0);
}
