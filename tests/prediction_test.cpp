#include "lfdtools/prediction.hpp"

#include <catch2/catch.hpp>

using namespace lfd;

TEST_CASE("the normal band is 1.96 standard deviations, rounding below zero is zero") {
  Samples variance(1, 2);
  variance << 4, -1e-18;
  const Band band = normal_band(variance);
  CHECK(band(BandKind::pointwise, 0.95)(0, 0) == Approx(3.919927969080).epsilon(1e-9));
  CHECK(band(BandKind::path, 0.5)(0, 0) == Approx(2 * 0.674489750196).epsilon(1e-9));
  CHECK(band(BandKind::pointwise, 0.95)(0, 1) == 0);
}
