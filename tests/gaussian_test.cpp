#include "lfdtools/gaussian.hpp"

#include <catch2/catch.hpp>

using namespace lfd;

TEST_CASE("Student's t has the quantiles of the tables") {
  CHECK(student_t_quantile(0.975, 4) == Approx(2.7764451051977987).epsilon(1e-12));
  CHECK(student_t_quantile(0.975, 21) == Approx(2.0796138447276626).epsilon(1e-12));
  CHECK(student_t_quantile(0.95, 9.5) == Approx(1.8216).epsilon(1e-3));
}
