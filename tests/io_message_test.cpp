#include <catch2/catch.hpp>

#include "io_fixture.hpp"
#include "lfdtools/io/message.hpp"
#include "lfdtools/io/utf8.hpp"

using namespace lfd;

TEST_CASE("a message names the parts of the place that are known") {
  const auto line_for = [](const Place& place) {
    const CapturedMessages captured;
    captured.messages.error(DataError("csv.ragged", "the row is short", place));
    return captured.text();
  };
  REQUIRE(line_for({"a.csv", 3, 7, ""}) == "prog:a.csv:3:7: the row is short [csv.ragged]\n");
  REQUIRE(line_for({"a.csv", 3, 0, ""}) == "prog:a.csv:3: the row is short [csv.ragged]\n");
  REQUIRE(line_for({"<stdin>", 0, 0, ""}) == "prog:<stdin>: the row is short [csv.ragged]\n");
  REQUIRE(line_for({"m.json", 0, 0, "/covariances/2"}) ==
          "prog:m.json:/covariances/2: the row is short [csv.ragged]\n");
  REQUIRE(line_for({}) == "prog: the row is short [csv.ragged]\n");
}

TEST_CASE("warnings and notes say so, and are left out when quiet") {
  CapturedMessages captured;
  captured.messages.warning("demo.gap", "a gap", {"a.csv", 4, 0, ""});
  captured.messages.note("csv.ignored_columns", "column k");
  REQUIRE(captured.text() == "prog:a.csv:4: warning: a gap [demo.gap]\nprog: note: column k [csv.ignored_columns]\n");

  CapturedMessages quiet(MessageFormat::text, true);
  quiet.messages.warning("demo.gap", "a gap");
  quiet.messages.note("csv.ignored_columns", "column k");
  quiet.messages.error(65, "x.y", "still told");
  REQUIRE(quiet.text() == "prog: still told [x.y]\n");
  REQUIRE(quiet.messages.warnings() == 1);
}

TEST_CASE("control characters and bytes that are no UTF-8 cannot reach the terminal") {
  REQUIRE(escape_controls("a\tb\nc\rd\x1b[31m\x7f") == "a\\tb\\nc\\rd\\x1b[31m\\x7f");
  REQUIRE(escape_controls(std::string_view("nul\0!", 5)) == "nul\\x00!");
  REQUIRE(escape_controls("Gr\xC3\xBC\xC3\x9F") == "Gr\xC3\xBC\xC3\x9F");
  REQUIRE(escape_controls("\xC2\x9B"
                          "31m") == "\\xc2\\x9b31m");  // a control sequence introducer in one code point
  REQUIRE(escape_controls("\xFF\xC3") == "\\xff\\xc3");
  const CapturedMessages captured;
  captured.messages.error(65, "a.b", "two\nlines", {"evil\nname", 1, 0, ""});
  REQUIRE(captured.text() == "prog:evil\\nname:1: two\\nlines [a.b]\n");
}

TEST_CASE("the JSON form is one compact object a line with all members") {
  CapturedMessages captured(MessageFormat::json);
  captured.messages.error(DataError("json.syntax", "say \"no\"\n", {"a\xFF.csv", 3, 7, ""}));
  captured.messages.warning("json.unknown_key", "what", {"m.json", 0, 0, "/a"});
  REQUIRE(
      captured.text() ==
      "{\"program\":\"prog\",\"severity\":\"error\",\"id\":\"json.syntax\",\"file\":\"a\xEF\xBF\xBD.csv\",\"line\":3,"
      "\"column\":7,\"pointer\":null,\"text\":\"say \\\"no\\\"\\n\",\"status\":65}\n"
      "{\"program\":\"prog\",\"severity\":\"warning\",\"id\":\"json.unknown_key\",\"file\":\"m.json\",\"line\":null,"
      "\"column\":null,\"pointer\":\"/a\",\"text\":\"what\",\"status\":null}\n");
}

TEST_CASE("a standard error that is closed does no harm") {
  Messages messages("prog", MessageFormat::text, false, -1);
  messages.error(65, "a.b", "lost");
  messages.warning("a.b", "lost");
  REQUIRE(messages.warnings() == 1);
}

TEST_CASE("UTF-8 is what RFC 3629 says") {
  for (const char* good : {"", "plain", "\xC2\x80", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80", "\xF0\x90\x80\x80",
                           "\xF4\x8F\xBF\xBF"}) {
    REQUIRE(is_utf8(good));
  }
  for (const char* bad : {"\x80", "\xC0\x80", "\xC1\xBF", "\xC3", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
                          "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFE", "\xE2\x82"}) {
    REQUIRE_FALSE(is_utf8(bad));
  }
}
