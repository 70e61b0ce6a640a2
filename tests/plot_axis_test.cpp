#include <catch2/catch.hpp>

#include "io_fixture.hpp"
#include "lfdtools/plot/axis.hpp"

using namespace lfd;
using namespace lfd::plot;

namespace {

Range range(double low, double high) {
  return {low, high, false};
}

std::vector<std::string> texts(const std::vector<Tick>& ticks) {
  std::vector<std::string> out;
  for (const Tick& tick : ticks) out.push_back(tick.text);
  return out;
}

}  // namespace

TEST_CASE("Ticks are multiples of 1, 2 or 5 times a power of ten, inside the range") {
  CHECK(texts(nice_ticks(range(0, 1), 6)) == std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(texts(nice_ticks(range(0.1, 9.9), 5)) == std::vector<std::string>{"2", "4", "6", "8"});
  CHECK(texts(nice_ticks(range(120, 390), 6)) == std::vector<std::string>{"150", "200", "250", "300", "350"});
}

TEST_CASE("Ticks are never more than asked for, and at least one") {
  for (const double length : {1e-9, 3e-4, 0.07, 1.0, 2.5, 4.1, 9.99, 37.0, 1e5, 6e12}) {
    for (const double low : {-0.37, 0.0, 0.51, 12.0}) {
      for (int most = 2; most <= 12; ++most) {
        const auto ticks = nice_ticks(range(low * length, (low + 1) * length), most);
        CAPTURE(length, low, most);
        CHECK(ticks.size() <= static_cast<std::size_t>(most));
        CHECK(!ticks.empty());
        for (const Tick& tick : ticks) {
          CHECK(tick.value >= low * length - 1e-6 * length);
          CHECK(tick.value <= (low + 1) * length + 1e-6 * length);
        }
      }
    }
  }
}

TEST_CASE("Tick texts have one number of decimals, a minus sign of their own, and no minus zero") {
  CHECK(texts(nice_ticks(range(-0.1, 0.1), 3)) == std::vector<std::string>{"\u22120.1", "0.0", "0.1"});
  CHECK(texts(nice_ticks(range(0.795, 0.806), 3)) == std::vector<std::string>{"0.795", "0.800", "0.805"});
  CHECK(texts(nice_ticks(range(0, 3e-12), 4)) ==
        std::vector<std::string>{"0", "1e\u221212", "2e\u221212", "3e\u221212"});
  CHECK(texts(nice_ticks(range(0, 2e7), 3)) == std::vector<std::string>{"0", "1e+07", "2e+07"});
}

TEST_CASE("Small and large values share a power of ten") {
  CHECK(exponent_of(range(0, 1)) == 0);
  CHECK(exponent_of(range(-0.5, 0)) == 0);
  CHECK(exponent_of(range(0, 0.0015)) == -3);
  CHECK(exponent_of(range(1e-9, 2e-9)) == -9);
  CHECK(exponent_of(range(-3e7, 1)) == 6);
  CHECK(exponent_of(range(0, 0)) == 0);
}

TEST_CASE("A range grows by a share, and a constant gets room on both sides") {
  const Range wide = range(0, 2).padded(0.05);
  CHECK(wide.low == Approx(-0.1));
  CHECK(wide.high == Approx(2.1));
  const Range constant = range(0.8, 0.8).padded();
  CHECK(constant.low == Approx(0.76));
  CHECK(constant.high == Approx(0.84));
  CHECK(range(0, 0).padded(0.05, 0.01).high == Approx(0.01));
  CHECK(range(1, 1 + 1e-13).padded().length() == Approx(0.1));
  CHECK(Range().padded().length() == 1);
}

TEST_CASE("Values beyond what can be laid on a page are refused") {
  for (const double value : {1e308, -1e200}) {
    Range huge;
    huge.include(value);
    huge.include(0);
    CHECK(refusal_of([&] { (void)huge.padded(); }).id == "plot.out_of_range");
  }
}

TEST_CASE("An axis lays its range along the page") {
  const Axis axis{range(2, 4), 300, 100, ""};
  CHECK(axis.at(2) == 300);
  CHECK(axis.at(3) == 200);
  CHECK(axis.at(4) == 100);
}

TEST_CASE("Labels have the units of the toolchain") {
  CHECK(with_unit("x", unit_of("x")) == "x [m]");
  CHECK(unit_of("q6") == "rad");
  CHECK(unit_of("t") == "s");
  CHECK(with_unit("grip", unit_of("grip")) == "grip");
}
