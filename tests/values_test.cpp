#include "lfdtools/cli/values.hpp"

#include <catch2/catch.hpp>

#include "lfdtools/error.hpp"
#include "refusal.hpp"

using namespace lfd;
using namespace lfd::cli;

TEST_CASE("integers are decimal, whole, without leading zeros") {
  CHECK(integer_value("-k", "12") == 12);
  CHECK(integer_value("-k", "-3") == -3);
  CHECK(integer_value("-k", "0") == 0);
  for (const auto* word : {"", "010", "0x10", "1e3", "4.5", "+4", " 4", "4 ", "99999999999999999999", "true", "-"}) {
    INFO(word);
    CHECK_THROWS_AS(integer_value("-k", word), UsageError);
  }
}

TEST_CASE("numbers are finite and fully consumed") {
  CHECK(number_value("--dt", "1.5") == 1.5);
  CHECK(number_value("--dt", "+1.5") == 1.5);
  CHECK(number_value("--dt", "-2e-3") == -2e-3);
  for (const auto* word : {"", "nan", "inf", "-inf", "1,5", "1.5abc", "0x1p3", "1e400", "+-1", "+"}) {
    INFO(word);
    CHECK_THROWS_AS(number_value("--dt", word), UsageError);
  }
}

TEST_CASE("lists and ranges") {
  CHECK(number_list("--goal", "0.1,-0.2,3") == std::vector<double>{0.1, -0.2, 3});
  CHECK_THROWS_AS(number_list("--goal", "0.1,,3"), UsageError);
  CHECK(integer_range_value("-k", "4") == std::pair<std::int64_t, std::int64_t>{4, 4});
  CHECK(integer_range_value("-k", "1:12") == std::pair<std::int64_t, std::int64_t>{1, 12});
  CHECK_THROWS_AS(integer_range_value("-k", "12:1"), UsageError);
  CHECK_THROWS_AS(integer_range_value("-k", "1:"), UsageError);
  CHECK(word_list("--columns", "x,y") == std::vector<std::string>{"x", "y"});
  CHECK_THROWS_AS(word_list("--columns", "x,x"), UsageError);
  CHECK_THROWS_AS(word_list("--columns", "x,"), UsageError);
}

TEST_CASE("the message names option and value") {
  const Refusal refusal = refusal_of([] { (void)integer_value("-k", "4.5"); });
  CHECK(refusal.text == "-k takes a whole decimal number, not '4.5'");
  CHECK(refusal.id == "usage.value");
  CHECK(refusal.fault == Fault::usage);
}
