#include "lfdtools/canonical.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "lfdtools/trajectory.hpp"
#include "refusal.hpp"

using namespace lfd;

TEST_CASE("the phase solves tau x' = -alpha_x x from 1") {
  // Independent of the closed form: Runge and Kutta's fourth-order steps through eq. (8).
  const CanonicalSystem canonical{3.7};
  const double tau = 2.5;
  const int steps = 20000;
  const double h = 2 * tau / steps;
  const auto slope = [&](double x) { return -canonical.alpha_x * x / tau; };
  double x = 1;
  for (int k = 0; k < steps; ++k) {
    const double k1 = slope(x);
    const double k2 = slope(x + h / 2 * k1);
    const double k3 = slope(x + h / 2 * k2);
    const double k4 = slope(x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  CHECK(canonical.phase(Vector::Constant(1, 2 * tau), tau)[0] == Approx(x).epsilon(1e-12));
  CHECK(canonical.phase(2.0) == Approx(x).epsilon(1e-12));
}

TEST_CASE("the default phase is 1 at the start and 0.01 at tau, whatever tau") {
  const CanonicalSystem canonical;
  for (const double tau : {0.1, 1.0, 30.0}) {
    Vector t(2);
    t << 0, tau;
    const Vector x = canonical.phase(t, tau);
    CHECK(x[0] == 1);
    CHECK(x[1] == Approx(0.01).epsilon(1e-14));
  }
}

TEST_CASE("relative time undoes the phase") {
  const CanonicalSystem canonical{2.0};
  for (const double s : linspace(0, 5, 21))
    CHECK(canonical.relative_time(canonical.phase(s)) == Approx(s).margin(1e-14));
}

TEST_CASE("a decay that is not a positive number is refused") {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK(refused_as(Fault::data, [&] { check(CanonicalSystem{bad}); }) == "dmp.alpha_x");
  }
}
