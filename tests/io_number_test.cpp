#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "lfdtools/io/number.hpp"
#include "lfdtools/random.hpp"

using lfd::number_text;
using lfd::NumberFault;
using lfd::parse_number;

namespace {

NumberFault fault_of(const std::string& text) {
  double value = 0;
  return parse_number(text, value);
}

double value_of(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const NumberFault fault = parse_number(text, value);
  REQUIRE((fault == NumberFault::none || fault == NumberFault::underflow));
  return value;
}

}  // namespace

TEST_CASE("random bits are read back bit for bit, by this reader and by strtod, and no shorter text would do") {
  lfd::Random random(7);
  int checked = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto value = std::bit_cast<double>(random.bits());
    if (!std::isfinite(value) || value == 0) continue;
    ++checked;
    const std::string text = number_text(value);
    REQUIRE(std::bit_cast<std::uint64_t>(value_of(text)) == std::bit_cast<std::uint64_t>(value));
    REQUIRE(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)) == std::bit_cast<std::uint64_t>(value));
    // Digits of the standard library's shortest form, which is another implementation.
    char other[40];
    const auto end = std::to_chars(other, other + 40, value, std::chars_format::scientific).ptr;
    const auto digits = [](const std::string& form) {
      std::string only;
      for (const char c : form.substr(0, form.find_first_of("eE"))) {
        if (c >= '0' && c <= '9' && (c != '0' || !only.empty())) only += c;
      }
      return only.erase(only.find_last_not_of('0') + 1);
    };
    REQUIRE(digits(text) == digits({other, end}));
    REQUIRE(text.size() < lfd::number_room);
  }
  REQUIRE(checked > 190'000);
}

TEST_CASE("extreme doubles are read back") {
  using Limits = std::numeric_limits<double>;
  for (const double value : {Limits::max(), Limits::min(), Limits::denorm_min(), -Limits::max(), 0.1, 1.0 / 3, 1e15,
                             1e16, 1e22, 123456789012345680.0}) {
    REQUIRE(value_of(number_text(value)) == value);
  }
}

TEST_CASE("whole numbers have no point, and minus zero is zero") {
  REQUIRE(number_text(1.0) == "1");
  REQUIRE(number_text(-200.0) == "-200");
  REQUIRE(number_text(0.1) == "0.1");
  REQUIRE(number_text(0.0) == "0");
  REQUIRE(number_text(-0.0) == "0");
}

TEST_CASE("a leading plus, bare points and exponents are accepted") {
  REQUIRE(value_of("+1.5") == 1.5);
  REQUIRE(value_of("+.5") == 0.5);
  REQUIRE(value_of("-.5") == -0.5);
  REQUIRE(value_of("5.") == 5.0);
  REQUIRE(value_of("1E3") == 1000.0);
  REQUIRE(value_of("1e+3") == 1000.0);
}

TEST_CASE("a number below the range is zero and says so, one above is refused") {
  for (const char* text : {"1e-400", "-1e-400", "0.00001e-330", "+1e-99999999999999999999"}) {
    INFO(text);
    REQUIRE(fault_of(text) == NumberFault::underflow);
    REQUIRE(value_of(text) == 0.0);
  }
  for (const char* text : {"1e400", "-1e400", "100000e305", "1e99999999999999999999", "0.001e312"}) {
    INFO(text);
    REQUIRE(fault_of(text) == NumberFault::overflow);
  }
  REQUIRE(fault_of(std::string(400, '9')) == NumberFault::overflow);
  REQUIRE(fault_of("0." + std::string(400, '0') + "1") == NumberFault::underflow);
  REQUIRE(fault_of("4e-320") == NumberFault::none);
}

TEST_CASE("what is no decimal number is refused, with its kind") {
  for (const char* text : {"", "nan", "NaN", "-nan", "inf", "-Inf", "+inf", "Infinity", "NA", "n/a", "null"}) {
    INFO(text);
    REQUIRE(fault_of(text) == NumberFault::not_finite);
  }
  for (const char* text : {"1,5", "-0,25", "+1,5e3"}) {
    INFO(text);
    REQUIRE(fault_of(text) == NumberFault::decimal_comma);
  }
  for (const char* text : {"1.5abc", "0x1p3", "0x10", "abc", " 1", "1 ", "1.5.2", "+-1", "--1", "1,000,000", "e5", ".",
                           "+", "-", "1e", "nan(1)", "1'000"}) {
    INFO(text);
    REQUIRE(fault_of(text) == NumberFault::not_a_number);
  }
}
