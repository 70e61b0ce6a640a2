#include "lfdtools/spring.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"

using namespace lfd;

namespace {

struct State {
  long double e;
  long double v;
};

// e'' = -alpha_z e' - alpha_z beta_z e by its power series, over short substeps, in long double.
State series(const Spring& spring, State state, double s) {
  const long double b = spring.alpha_z;
  const long double k = static_cast<long double>(spring.alpha_z) * spring.beta_z;
  const int pieces = 1 + static_cast<int>(s * spring.fast_rate() * 4);
  const long double h = static_cast<long double>(s) / pieces;
  for (int piece = 0; piece < pieces; ++piece) {
    // Coefficients of e(h) = sum c_n h^n: (n + 2)(n + 1) c_{n+2} = -b (n + 1) c_{n+1} - k c_n.
    long double c = state.e;
    long double next = state.v;
    long double power = 1;
    long double e = 0;
    long double v = 0;
    for (int n = 0; n < 40; ++n) {
      e += c * power;
      v += (n + 1) * next * power;
      const long double after = (-b * (n + 1) * next - k * c) / ((n + 2.0L) * (n + 1.0L));
      c = next;
      next = after;
      power *= h;
    }
    state = {e, v};
  }
  return state;
}

}  // namespace

TEST_CASE("one step equals the power series of the equation, under every damping") {
  for (const double alpha_z : {5.0, 25.0, 200.0}) {
    for (const double ratio : {0.01, 0.1, 0.2499999, 0.25, 0.2500001, 0.25 + 1e-12, 0.5, 4.0}) {
      const Spring spring{alpha_z, alpha_z * ratio};
      for (const double s : {0.0, 1e-6, 0.01, 0.3, 1.0, 3.0}) {
        const SpringStep step = spring.step(s);
        const State one = series(spring, {1, 0}, s);
        const State two = series(spring, {0, 1}, s);
        INFO("alpha_z " << alpha_z << " ratio " << ratio << " s " << s);
        const double rate = alpha_z * std::max(1.0, ratio);
        CHECK(std::abs(step.ee - static_cast<double>(one.e)) < 1e-12);
        CHECK(std::abs(step.ve - static_cast<double>(one.v)) < 1e-12 * rate);
        CHECK(std::abs(step.ev - static_cast<double>(two.e)) < 1e-12);
        CHECK(std::abs(step.vv - static_cast<double>(two.v)) < 1e-12 * rate);
      }
    }
  }
}

TEST_CASE("critical damping is (1 + a s) exp(-a s), and the closed form is continuous there") {
  const Spring critical{25, 6.25};
  for (const double s : {0.05, 0.4, 1.0}) {
    const double a = 12.5;
    CHECK(critical.step(s).ee == Approx((1 + a * s) * std::exp(-a * s)).epsilon(1e-13));
    CHECK(critical.step(s).ev == Approx(s * std::exp(-a * s)).epsilon(1e-13));
    for (const double nudge : {-1e-13, -1e-9, 1e-9, 1e-13}) {
      const SpringStep step = Spring{25, 6.25 * (1 + nudge)}.step(s);
      CHECK(std::abs(step.ee - critical.step(s).ee) < 200 * std::abs(nudge) + 1e-15);
      CHECK(std::abs(step.ev - critical.step(s).ev) < 200 * std::abs(nudge) + 1e-15);
    }
  }
}

TEST_CASE("very stiff and very long steps neither overflow nor lose the slow part") {
  // Roots -slow and -(2000 - slow); after a long time e = fast / (fast - slow) exp(-slow s) alone is left.
  const double slow = 1000 / (1000 + std::sqrt(999000.0));
  const double fast = 2000 - slow;
  const SpringStep stiff = Spring{2000, 0.5}.step(1000);
  CHECK(stiff.ee == Approx(fast / (fast - slow) * std::exp(-slow * 1000)).epsilon(1e-11));
  const SpringStep late = Spring{25, 6.25}.step(1e6);
  CHECK(late.ee == 0);
  CHECK(late.vv == 0);
}

TEST_CASE("rates are the moduli and decays of the roots") {
  // Roots -2 and -8: sum 10, product 16.
  CHECK(Spring{10, 1.6}.slow_rate() == Approx(2));
  CHECK(Spring{10, 1.6}.fast_rate() == Approx(8));
  // Roots -3 +- 4i: sum 6, product 25.
  CHECK(Spring{6, 25.0 / 6}.slow_rate() == Approx(3));
  CHECK(Spring{6, 25.0 / 6}.fast_rate() == Approx(5));
}

TEST_CASE("a spring without damping or stiffness is refused") {
  for (const Spring& bad : {Spring{0, 1}, Spring{1, 0}, Spring{-1, 1}, Spring{std::nan(""), 1}, Spring{1, INFINITY}}) {
    CHECK_THROWS_AS(check(bad), DataError);
  }
  CHECK_NOTHROW(check(Spring{}));
}
