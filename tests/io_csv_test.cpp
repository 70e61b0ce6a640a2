#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "io_fixture.hpp"
#include "lfdtools/io/csv.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

CsvTable table_of(const std::vector<std::string>& texts, Messages& messages, const CsvOptions& options = {}) {
  return {inputs_of(texts), messages, options};
}

/// Reads everything as t,x and says how that was refused.
Refusal refusal_for(const std::string& text, const std::vector<std::string>& columns = {"t", "x"}) {
  CapturedMessages captured;
  return refusal_of([&] {
    const CsvTable table = table_of({text}, captured.messages);
    for (std::size_t i = 0; i < table.groups().size(); ++i) (void)table.read_group(i, columns);
  });
}

void require_refused(const std::string& text, const std::string& id, std::size_t line, std::size_t column) {
  INFO(text);
  const Refusal refusal = refusal_for(text);
  REQUIRE(refusal.id == id);
  REQUIRE(refusal.fault == Fault::data);
  REQUIRE(refusal.place.file == "a.csv");
  REQUIRE(refusal.place.line == line);
  REQUIRE(refusal.place.column == column);
}

Samples read(const std::string& text, const std::vector<std::string>& columns = {"t", "x"}) {
  CapturedMessages captured;
  return table_of({text}, captured.messages).read_group(0, columns).values;
}

std::string labels_of(const CsvTable& table) {
  std::string out;
  for (const CsvGroup& group : table.groups()) {
    for (const auto& label : {group.labels.target, group.labels.teacher, group.labels.demo, group.labels.sample}) {
      if (label) out += *label + "/";
    }
    out += ":" + std::to_string(group.file) + "@" + std::to_string(group.first_line) + "x" +
           std::to_string(group.rows) + " ";
  }
  return out;
}

const Samples expected = (Samples(2, 2) << 0, 1.5, 0.1, -2).finished();

}  // namespace

TEST_CASE("LF, CRLF, BOM, quotes, a plus and a missing last newline are accepted") {
  REQUIRE(read("t,x\n0,1.5\n0.1,-2\n") == expected);
  REQUIRE(read("t,x\r\n0,1.5\r\n0.1,-2\r\n") == expected);
  REQUIRE(read("\xEF\xBB\xBFt,x\n0,1.5\n0.1,-2\n") == expected);
  REQUIRE(read("\"t\",\"x\"\n\"0\",1.5\n0.1,\"-2\"\n") == expected);
  REQUIRE(read("t,x\n0,+1.5\n0.1,-2") == expected);
  REQUIRE(read("t,x\r\n0,1.5\r\n0.1,-2") == expected);
  REQUIRE(read("\xEF\xBB\xBF\"t\",x\r\n0,1.5\r\n\"0.1\",-2") == expected);
}

TEST_CASE("columns are found by name in any order, others are passed over") {
  REQUIRE(read("x,note,t\n1.5,\"a,\"\"b\"\"\",0\n-2,c,0.1\n") == expected);
  REQUIRE(read("t,x\n0,1.5\n0.1,-2\n", {"x"}) == expected.col(1));
  CapturedMessages captured;
  const CsvTable table = table_of({"x,note,t\n1.5,\"a,\"\"b\"\"\",0\n-2,c,0.1\n"}, captured.messages);
  REQUIRE(table.columns() == std::vector<std::string>{"x", "note", "t"});
  REQUIRE(table.is_numeric("x"));
  REQUIRE_FALSE(table.is_numeric("note"));
  REQUIRE(table.read_text(0, "note") == std::vector<std::string>{"a,\"b\"", "c"});
}

TEST_CASE("1e-400 is read as zero, with one warning") {
  CapturedMessages captured;
  const CsvTable table = table_of({"t,x\n0,1e-400\n1,-1e-400\n"}, captured.messages);
  REQUIRE(table.read_group(0, {"x"}).values.isZero(0));
  REQUIRE(captured.messages.warnings() == 1);
  REQUIRE(captured.text() ==
          "prog:a.csv:2:3: warning: '1e-400' in column x is too small for a double: read as 0 [csv.underflow]\n");
}

TEST_CASE("each way in which a table can be bad is refused with its place") {
  require_refused("", "csv.empty", 0, 0);
  REQUIRE(refusal_for("").text.find("is the previous command's output empty?") != std::string::npos);
  require_refused("\xEF\xBB\xBF", "csv.empty", 0, 0);
  require_refused("t,x\n", "csv.header_only", 1, 0);
  require_refused("t,x", "csv.header_only", 1, 0);
  require_refused("t,x\n0,1\n1,2,3\n2,3\n", "csv.ragged", 3, 5);
  require_refused("t,x\n0,1\n1\n2,3\n", "csv.ragged", 3, 1);
  require_refused("t,x\n0,1\n\n2,3\n", "csv.ragged", 3, 1);
  require_refused("t,x\n0,1\n1,2,\n", "csv.ragged", 3, 5);
  require_refused("t,x\n0,1\n1", "csv.truncated", 3, 1);
  require_refused("t,x\n0,1\n1\n", "csv.truncated", 3, 1);
  require_refused("t,x\n0,1\n1,", "csv.not_finite", 3, 3);
  require_refused("t,x\n0,1\n10,up\n", "csv.not_a_number", 3, 4);
  require_refused("t,x\n0,1\n1,nan\n", "csv.not_finite", 3, 3);
  require_refused("t,x\n0,1\n1,-inf\n", "csv.not_finite", 3, 3);
  require_refused("t,x\n0,1\n1,NA\n", "csv.not_finite", 3, 3);
  require_refused("t,x\n0,1\n,1\n", "csv.not_finite", 3, 1);
  require_refused("t,x\n0,1\n1,1e400\n", "csv.out_of_range", 3, 3);
  require_refused("t,x\n0,1\n1,\"1,5\"\n", "csv.decimal_comma", 3, 3);
  require_refused("t,x\n0,00,1,5\n0,01,1,6\n", "csv.decimal_comma", 2, 1);
  require_refused("t,x\n0,1.5abc\n", "csv.not_a_number", 2, 3);
  require_refused("t,x\n0,0x1p3\n", "csv.not_a_number", 2, 3);
  require_refused("t,x\n0, 1\n", "csv.not_a_number", 2, 3);
  require_refused(std::string("\xFF\xFEt\0,\0x\0\n\0", 10), "csv.utf16", 1, 1);
  require_refused(std::string("\xFE\xFF\0t\0,\0x\0\n", 10), "csv.utf16", 1, 1);
  require_refused("t,x\r0,1\r", "csv.lone_cr", 1, 4);
  require_refused("t,x\n0,1\r1,2\n", "csv.lone_cr", 2, 4);
  require_refused(std::string("t,x\n0,1\n1,\0002\n", 13), "csv.nul", 3, 3);
  require_refused("t,\xC3\x28\n0,1\n", "csv.header_not_utf8", 1, 3);
  require_refused("\xEF\xBB\xBFt,\xFF\n0,1\n", "csv.header_not_utf8", 1, 6);
  require_refused("t,x,t\n0,1,2\n", "csv.duplicate_column", 1, 5);
  require_refused("t,,x\n0,1,2\n", "csv.unnamed_column", 1, 3);
  require_refused("\n0,1\n", "csv.unnamed_column", 1, 1);
  require_refused("t,x\n0,\"1\n1,2\n", "csv.unclosed_quote", 2, 3);
  require_refused("t,\"x\n0,1\n", "csv.unclosed_quote", 1, 3);
  require_refused("t,x\n0,\"1\"2\n", "csv.bad_quote", 2, 6);
  require_refused("0,1\n1,2\n", "csv.no_header", 1, 1);
  require_refused("t;x\n0,5;1\n", "csv.semicolon", 1, 2);
  require_refused("{\"format\":\"lfdtools.gmm\"}\n", "csv.json", 1, 1);
  require_refused("target,t,x\n1,0,1\n,1,2\n", "csv.empty_label", 3, 1);
  require_refused("target,t,x\n\xFF,0,1\n", "csv.label_not_utf8", 2, 1);
}

TEST_CASE("a fault in a column that nobody asked for is found if it breaks the row") {
  require_refused("k,t,x\n1,0,1\n\"2,1,2\n", "csv.unclosed_quote", 3, 1);
  require_refused("t,x,k\n0,1,9\n1,2\n2,3,4\n", "csv.ragged", 3, 3);
  require_refused(std::string("t,x,k\n0,1,\0\n", 12), "csv.nul", 2, 5);
}

TEST_CASE("a missing column is refused with those that are there") {
  const Refusal refusal = refusal_for("t,y\n0,1\n");
  REQUIRE(refusal.id == "csv.missing_column");
  REQUIRE(refusal.text == "there is no column 'x'; there are: t, y");
}

TEST_CASE("lines may be as long as the limit and no longer") {
  const std::string cell(100'000, '1');
  CapturedMessages captured;
  CsvOptions options;
  options.line_limit = 100'002;
  const CsvTable table = table_of({"t,note\n0," + cell + "\n"}, captured.messages, options);
  REQUIRE(table.read_text(0, "note") == std::vector<std::string>{cell});
  options.line_limit = 100'001;
  const Refusal refusal = refusal_of([&] { (void)table_of({"t,note\n0," + cell + "\n"}, captured.messages, options); });
  REQUIRE(refusal.id == "csv.line_too_long");
  REQUIRE(refusal.place.line == 2);
  const Refusal header = refusal_of([&] { (void)table_of({std::string(3'000'000, 'h')}, captured.messages); });
  REQUIRE(header.id == "csv.line_too_long");
  REQUIRE(header.place.line == 1);
}

TEST_CASE("groups are found over several files, in order of first appearance") {
  CapturedMessages captured;
  const CsvTable table = table_of({"target,demo,t,x\n1,1,0,1\n1,1,1,2\n1,2,0,3\nhole,1,0,4\n",
                                   "x,t,demo,target\n5,0,01,1\n6,1,01,1\n7,0,\"a,b\",1\n"},
                                  captured.messages);
  REQUIRE(labels_of(table) == "1/1/:0@2x2 1/2/:0@4x1 hole/1/:0@5x1 1/01/:1@2x2 1/a,b/:1@4x1 ");
  REQUIRE(table.read_group(0, {"x", "t"}).values == (Samples(2, 2) << 1, 0, 2, 1).finished());
  REQUIRE(table.read_group(3, {"x", "t"}).values == (Samples(2, 2) << 5, 0, 6, 1).finished());
  REQUIRE(table.read_group(4, {"x"}).values(0, 0) == 7);
  const NumericBlock block = table.read_group(3, {"x"});
  REQUIRE(block.file == "b.csv");
  REQUIRE(block.place(1).line == 3);
  REQUIRE(table.sha256() == sha256(inputs_of({"target,demo,t,x\n1,1,0,1\n1,1,1,2\n1,2,0,3\nhole,1,0,4\n"
                                              "x,t,demo,target\n5,0,01,1\n6,1,01,1\n7,0,\"a,b\",1\n"})));
}

TEST_CASE("labels that are not in front, or begin alike, are told apart") {
  CapturedMessages captured;
  REQUIRE(labels_of(table_of({"t,x,target\n0,1,1\n1,2,1\n0,3,11\n1,4,11\n"}, captured.messages)) ==
          "1/:0@2x2 11/:0@4x2 ");
  REQUIRE(labels_of(table_of({"target,t\n1,0\n11,0\n1.0,0\n\"1,\",0\n"}, captured.messages)) ==
          "1/:0@2x1 11/:0@3x1 1.0/:0@4x1 1,/:0@5x1 ");
  REQUIRE(labels_of(table_of({"t,target\n0,a\n1,a\r\n0,b"}, captured.messages)) == "a/:0@2x2 b/:0@4x1 ");
  REQUIRE(labels_of(table_of({"target\n1\n1\n12\n"}, captured.messages)) == "1/:0@2x2 12/:0@4x1 ");
  REQUIRE(labels_of(table_of({"sample,teacher,t\n1,ann,0\n1,ann,1\n2,ann,0\n"}, captured.messages)) ==
          "ann/1/:0@2x2 ann/2/:0@4x1 ");
}

TEST_CASE("a group that reappears is refused, in the same file and in another") {
  require_refused("target,t,x\n1,0,1\n2,0,1\n1,1,1\n", "csv.group_reappears", 4, 0);
  CapturedMessages captured;
  const Refusal refusal = refusal_of([&] {
    (void)table_of({"target,demo,t\n1,1,0\n", "target,demo,t\n1,2,0\n1,1,0\n"}, captured.messages);
  });
  REQUIRE(refusal.id == "csv.group_reappears");
  REQUIRE(refusal.place.file == "b.csv");
  REQUIRE(refusal.place.line == 3);
  REQUIRE(refusal_of([&] { (void)table_of({"t\n0\n", "t\n0\n"}, captured.messages); }).id == "csv.group_reappears");
}

TEST_CASE("later files get new demo numbers on request") {
  CapturedMessages captured;
  CsvOptions options;
  options.renumber = true;
  const std::string file = "target,demo,t\n1,1,0\n1,2,0\n2,1,0\n";
  REQUIRE(labels_of(table_of({file, file, "target,demo,t\n1,5,0\n1,2,0\n3,7,0\n"}, captured.messages, options)) ==
          "1/1/:0@2x1 1/2/:0@3x1 2/1/:0@4x1 1/3/:1@2x1 1/4/:1@3x1 2/2/:1@4x1 1/5/:2@2x1 1/6/:2@3x1 3/7/:2@4x1 ");
  REQUIRE(labels_of(table_of({"t\n0\n", "t\n0\n"}, captured.messages, options)) == "1/:0@2x1 2/:1@2x1 ");
  REQUIRE(labels_of(table_of({"target,t\na,0\nb,0\n", "target,t\na,0\n"}, captured.messages, options)) ==
          "a/1/:0@2x1 b/1/:0@3x1 a/2/:1@2x1 ");
  // What reappears within one file stays an error.
  REQUIRE(refusal_of([&] {
            (void)table_of({file, "target,demo,t\n1,1,0\n1,2,0\n1,1,1\n"}, captured.messages, options);
          }).id == "csv.group_reappears");
}

TEST_CASE("files with other columns are refused") {
  CapturedMessages captured;
  for (const char* other : {"t,y\n0,1\n", "t,x,y\n0,1,2\n", "t\n0\n"}) {
    const Refusal refusal = refusal_of([&] { (void)table_of({"t,x\n0,1\n", other}, captured.messages); });
    REQUIRE(refusal.id == "csv.columns_differ");
    REQUIRE(refusal.place.file == "b.csv");
  }
}

TEST_CASE("without grouping a file is one block and labels are text") {
  CapturedMessages captured;
  CsvOptions options;
  options.grouped = false;
  const CsvTable table = table_of({"target,x\n1,0.5\n2,0.25\n1,0.5\n"}, captured.messages, options);
  REQUIRE(table.groups().size() == 1);
  REQUIRE(table.read_text(0, "target") == std::vector<std::string>{"1", "2", "1"});
}

TEST_CASE("blocks of the reader do not show: a large table is read back as it was written") {
  const ScratchFolder folder;
  const std::string name = folder.file("large.csv");
  Random random(3);
  Samples values(60'000, 3);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    double value = 0;
    do value = std::bit_cast<double>(random.bits());
    while (!std::isfinite(value));
    values.data()[i] = value;
  }
  const Eigen::Index third = values.rows() / 3;
  {
    Output out(name);
    CsvWriter writer(out, {"target", "demo", "x", "y", "z"});
    for (int i = 0; i < 3; ++i) writer.rows({std::to_string(i), {}, "d", {}}, values.middleRows(i * third, third));
    out.finish();
  }
  CapturedMessages captured;
  std::vector<Input> inputs;
  inputs.emplace_back(name);
  const CsvTable table(std::move(inputs), captured.messages);
  REQUIRE(table.groups().size() == 3);
  for (int i = 0; i < 3; ++i) {
    REQUIRE(table.groups()[static_cast<std::size_t>(i)].labels.target == std::to_string(i));
    const Samples back = table.read_group(static_cast<std::size_t>(i), {"x", "y", "z"}).values;
    REQUIRE(std::memcmp(back.data(), values.data() + i * third * 3, static_cast<std::size_t>(third) * 24) == 0);
  }
}

TEST_CASE("a table is written with quotes where they are needed, and read back") {
  const ScratchFolder folder;
  const std::string name = folder.file("out.csv");
  {
    Output out(name);
    CsvWriter writer(out, {"target", "no,te", "x"});
    writer.text("a \"b\"");
    writer.text("");
    writer.number(-0.0);
    writer.end_row();
    writer.text("c,d");
    writer.integer(-7);
    writer.number(1e300);
    writer.end_row();
    out.finish();
  }
  REQUIRE(content(name) == "target,\"no,te\",x\n\"a \"\"b\"\"\",,0\n\"c,d\",-7,1e+300\n");
  CapturedMessages captured;
  const CsvTable table = table_of({content(name)}, captured.messages);
  REQUIRE(table.groups()[0].labels.target == "a \"b\"");
  REQUIRE(table.groups()[1].labels.target == "c,d");
  REQUIRE(table.read_text(0, "no,te") == std::vector<std::string>{""});
}

TEST_CASE("the writer refuses what is no result") {
  Output out("/dev/null");
  CsvWriter writer(out, {"x", "y"});
  REQUIRE(refusal_of([&] { writer.number(std::nan("")); }).id == "csv.write_not_finite");
  REQUIRE(refusal_of([&] { writer.number(HUGE_VAL); }).fault == Fault::internal);
  writer.number(1);
  REQUIRE(refusal_of([&] { writer.end_row(); }).id == "csv.write_ragged");
}
