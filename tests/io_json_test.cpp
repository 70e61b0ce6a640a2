#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "io_fixture.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/io/json_writer.hpp"
#include "lfdtools/io/provenance.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

Messages silent("prog", MessageFormat::text, true);

JsonDocument document(const std::string& text, const JsonOptions& options = {}) {
  return {text, "m.json", silent, options};
}

Refusal refusal_for(const std::string& text, const JsonOptions& options = {}) {
  return refusal_of([&] {
    JsonStream stream(inputs_of({text}), silent, options);
    while (stream.next()) {
    }
  });
}

void require_refused(const std::string& text, const std::string& id, std::size_t line, std::size_t column,
                     const std::string& pointer = "") {
  INFO(text.substr(0, 200));
  const Refusal refusal = refusal_for(text);
  INFO(refusal.text);
  REQUIRE(refusal.id == id);
  REQUIRE(refusal.fault == Fault::data);
  REQUIRE(refusal.place.file == "a.csv");
  REQUIRE(refusal.place.line == line);
  REQUIRE(refusal.place.column == column);
  REQUIRE(refusal.place.pointer == pointer);
}

template <class Get>
void require_wrong(const JsonDocument& doc, Get get, const std::string& id, const std::string& pointer) {
  const Refusal refusal = refusal_of([&] { (void)get(doc.root()); });
  INFO(refusal.text);
  REQUIRE(refusal.id == id);
  REQUIRE(refusal.place.pointer == pointer);
  REQUIRE(refusal.place.file == "m.json");
}

std::string repeated(const std::string& piece, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += piece;
  return out;
}

}  // namespace

TEST_CASE("documents are separated by any white space, over several inputs") {
  JsonStream stream(inputs_of({"\xEF\xBB\xBF {\"a\":1}{\"a\":2}\n\t{\"a\":\n3}\r\n\n", "{\"a\":4}"}), silent);
  for (long long i = 1; i <= 4; ++i) {
    const std::optional<JsonDocument> doc = stream.next();
    REQUIRE(doc);
    REQUIRE(doc->root().at("a").integer(0, 9) == i);
  }
  REQUIRE_FALSE(stream.next());
  REQUIRE_FALSE(stream.next());
}

TEST_CASE("brackets, quotes and escapes in strings do not end a document") {
  const std::string text = R"({"a":"}]{[\"}\\","b":"\\\"","c":"\u00e9\n"})";
  JsonStream stream(inputs_of({text + text}), silent);
  for (int i = 0; i < 2; ++i) {
    const std::optional<JsonDocument> doc = stream.next();
    REQUIRE(doc->root().at("a").string() == "}]{[\"}\\");
    REQUIRE(doc->root().at("b").string() == "\\\"");
    REQUIRE(doc->root().at("c").string() == "\xC3\xA9\n");
  }
  REQUIRE_FALSE(stream.next());
}

TEST_CASE("documents that are longer than the reader's blocks arrive whole") {
  JsonWriter json;
  json.begin_object().member("v", Vector(Vector::LinSpaced(50'000, 0, 1))).end_object();
  JsonStream stream(inputs_of({json.text() + "\n" + json.text()}), silent);
  REQUIRE(stream.next()->root().at("v").vector(50'000) == Vector::LinSpaced(50'000, 0, 1));
  REQUIRE(stream.next()->root().at("v").size() == 50'000);
}

TEST_CASE("each way in which a stream can be bad is refused with its place") {
  require_refused("", "json.empty", 0, 0);
  require_refused(" \n ", "json.empty", 0, 0);
  REQUIRE(refusal_for("").text.find("is the previous command's output empty?") != std::string::npos);
  require_refused("{\"a\":1", "json.truncated", 1, 7);
  require_refused("{\"a\":1}\n{\"a\":[1,2", "json.truncated", 2, 10);
  require_refused("{\"a\":\"x", "json.truncated", 1, 8);
  require_refused("{} x", "json.syntax", 1, 4);
  require_refused("{}}", "json.syntax", 1, 3);
  require_refused("[1]", "json.syntax", 1, 1);
  require_refused("t,x\n0,1\n", "json.syntax", 1, 1);
  require_refused("{\"a\":1,}", "json.syntax", 1, 8);
  require_refused("{\n \"a\": nan}", "json.syntax", 2, 8);
  require_refused("{\"a\":01}", "json.syntax", 1, 7);
  require_refused("{\"a\":NaN}", "json.syntax", 1, 6);
  require_refused("{\"a\":+1}", "json.syntax", 1, 6);
  require_refused("{\"a\":1]", "json.syntax", 1, 7);
  require_refused("{'a':1}", "json.syntax", 1, 2);
  require_refused("{\"a\":\"\xFF\"}", "json.syntax", 1, 7);
  require_refused("{\"a\":\"\n\"}", "json.syntax", 1, 7);
  require_refused("{} // no comments", "json.syntax", 1, 4);
  require_refused(std::string("{\"a\":1}\0{", 9), "json.syntax", 1, 8);
  require_refused(std::string("{\"a\":\0 1}", 9), "json.syntax", 1, 6);
  require_refused(std::string("{\"a\":\"\0\"}", 9), "json.syntax", 1, 7);
  require_refused("{\"a\":1e400}", "json.out_of_range", 0, 0, "/a");
  require_refused("{\"a\":[0,-1e999]}", "json.out_of_range", 0, 0, "/a/1");
  require_refused("{\"a\":1,\"b\":2,\"a\":3}", "json.duplicate_key", 0, 0, "/a");
  require_refused("{\"a\":[0,{\"b\":1,\"c\":{},\"b\":3}]}", "json.duplicate_key", 0, 0, "/a/1/b");
  require_refused("{\"x/y~\":1,\"x/y~\":1}", "json.duplicate_key", 0, 0, "/x~1y~0");
}

TEST_CASE("nesting has a limit, however deep the input goes") {
  REQUIRE(refusal_for("{\"a\":" + repeated("[", 63) + repeated("]", 63) + "}").id.empty());
  require_refused("{\"a\":" + repeated("[", 64) + repeated("]", 64) + "}", "json.too_deep", 1, 69);
  REQUIRE(refusal_for("{\"a\":" + repeated("[", 200'000)).id == "json.too_deep");
  // The document by itself is checked too, without the stream in front.
  const Refusal refusal = refusal_of([] { (void)document("{\"a\":" + repeated("[", 64) + repeated("]", 64) + "}"); });
  REQUIRE(refusal.id == "json.too_deep");
}

TEST_CASE("sizes have limits") {
  JsonOptions options;
  options.array_limit = 3;
  REQUIRE(refusal_for("{\"a\":[1,2,3]}", options).id.empty());
  const Refusal refusal = refusal_for("{\"a\":[1,2,3,4]}", options);
  REQUIRE(refusal.id == "json.too_large");
  REQUIRE(refusal.place.pointer == "/a/3");
  options.document_limit = 20;
  REQUIRE(refusal_for("{\"a\":\"" + std::string(100, 'x') + "\"}", options).id == "json.too_large");
}

TEST_CASE("robots and scenes are refused with status 78") {
  JsonOptions options;
  options.fault = Fault::config;
  REQUIRE(refusal_for("{\"a\":1,\"a\":1}", options).fault == Fault::config);
  const JsonDocument doc = document("{\"a\":1}", options);
  REQUIRE(refusal_of([&] { (void)doc.root().at("a").string(); }).fault == Fault::config);
}

TEST_CASE("numbers are numbers, integers are integers within their range") {
  const JsonDocument doc = document(R"({"whole":7,"point":4.7,"minus":-1,"large":5000000000,"huge":18446744073709551615,
    "e":1e9,"true":true,"null":null,"word":"7","list":[7]})");
  const auto get = [](const char* key) {
    return [key](const JsonView& root) { return root.at(key).integer(0, 1000); };
  };
  REQUIRE(doc.root().at("whole").integer(0, 1000) == 7);
  REQUIRE(doc.root().at("whole").number() == 7.0);
  require_wrong(doc, get("point"), "json.not_an_integer", "/point");
  require_wrong(doc, get("e"), "json.not_an_integer", "/e");
  require_wrong(doc, get("true"), "json.not_an_integer", "/true");
  require_wrong(doc, get("word"), "json.not_an_integer", "/word");
  require_wrong(doc, get("minus"), "json.out_of_range", "/minus");
  require_wrong(doc, get("large"), "json.out_of_range", "/large");
  require_wrong(doc, get("huge"), "json.out_of_range", "/huge");
  require_wrong(doc, get("null"), "json.not_an_integer", "/null");
  REQUIRE(doc.root().at("huge").unsigned_integer() == 18446744073709551615ULL);
  REQUIRE(doc.root().at("large").integer(0, 10'000'000'000) == 5'000'000'000);
  for (const char* key : {"true", "word", "list"}) {
    require_wrong(
        doc, [&](const JsonView& root) { return root.at(key).number(); }, "json.not_a_number", std::string("/") + key);
  }
  require_wrong(
      doc, [](const JsonView& root) { return root.at("minus").unsigned_integer(); }, "json.out_of_range", "/minus");
  require_wrong(
      doc, [](const JsonView& root) { return root.at("minus").positive(); }, "json.out_of_range", "/minus");
  require_wrong(
      doc, [](const JsonView& root) { return root.at("point").number(0, 1); }, "json.out_of_range", "/point");
  require_wrong(
      doc, [](const JsonView& root) { return root.at("gone").number(); }, "json.missing_key", "");
  REQUIRE_FALSE(doc.root().find("gone"));
  REQUIRE(doc.root().find("null")->is_null());
}

TEST_CASE("arrays have the length, and their elements the type, that is asked for") {
  const JsonDocument doc = document(R"({"v":[1,2.5,-3],"bad":[1,"x"],"hole":[1,null],"m":[[1,2],[3,4],[5,6]],
    "ragged":[[1,2],[3]],"no":{},"empty":[],"s":["a","b"],"mixed":["a",1]})");
  const JsonView root = doc.root();
  REQUIRE(root.at("v").vector(3) == (Vector(3) << 1, 2.5, -3).finished());
  REQUIRE(root.at("m").matrix(3, 2) == (Matrix(3, 2) << 1, 2, 3, 4, 5, 6).finished());
  REQUIRE(root.at("m").matrix() == root.at("m").matrix(3, 2));
  REQUIRE(root.at("empty").vector().size() == 0);
  REQUIRE(root.at("empty").matrix(0, 2).cols() == 2);
  REQUIRE(root.at("s").strings() == std::vector<std::string>{"a", "b"});
  const auto vector = [](const char* key, Eigen::Index n) {
    return [=](const JsonView& view) { return view.at(key).vector(n); };
  };
  const auto matrix = [](const char* key, Eigen::Index m, Eigen::Index n) {
    return [=](const JsonView& view) { return view.at(key).matrix(m, n); };
  };
  require_wrong(doc, vector("v", 2), "json.wrong_length", "/v");
  require_wrong(doc, vector("bad", 2), "json.not_a_number", "/bad/1");
  require_wrong(doc, vector("hole", 2), "json.not_a_number", "/hole/1");
  require_wrong(doc, vector("no", -1), "json.wrong_type", "/no");
  require_wrong(doc, matrix("m", 2, 2), "json.wrong_length", "/m");
  require_wrong(doc, matrix("m", 3, 3), "json.wrong_length", "/m/0");
  require_wrong(doc, matrix("ragged", -1, -1), "json.wrong_length", "/ragged/1");
  require_wrong(doc, matrix("v", -1, -1), "json.wrong_type", "/v/0");
  require_wrong(
      doc, [](const JsonView& view) { return view.at("mixed").strings(); }, "json.wrong_type", "/mixed/1");
  require_wrong(
      doc, [](const JsonView& view) { return view.at("v").at(3); }, "json.wrong_length", "/v");
}

TEST_CASE("unknown keys are warned of, and refused when strict") {
  const std::string text = R"({"known":1,"odd":2})";
  CapturedMessages captured;
  const JsonDocument doc(text, "m.json", captured.messages);
  doc.root().only({"known"});
  REQUIRE(captured.text() == "prog:m.json:/odd: warning: the key is unknown and ignored [json.unknown_key]\n");
  JsonOptions strict;
  strict.strict = true;
  require_wrong(
      document(text, strict), [](const JsonView& root) { return root.only({"known"}), 0; }, "json.unknown_key", "/odd");
}

TEST_CASE("another format is refused with the program that reads it, a newer version too") {
  const auto expect = [](const std::string& text) {
    return refusal_of([&] { document(text).expect("lfdtools.dmp"); });
  };
  REQUIRE(expect(R"({"format":"lfdtools.dmp","version":1})").id.empty());
  const Refusal other = expect(R"({"format":"lfdtools.gmm","version":1})");
  REQUIRE(other.id == "json.wrong_format");
  REQUIRE(other.text.find("gmr-regress") != std::string::npos);
  REQUIRE(expect(R"({"format":"other","version":1})").id == "json.wrong_format");
  REQUIRE(expect(R"({"version":1})").id == "json.wrong_format");
  REQUIRE(expect(R"({"format":7,"version":1})").id == "json.wrong_type");
  REQUIRE(expect(R"({"format":"lfdtools.dmp"})").id == "json.missing_key");
  REQUIRE(expect(R"({"format":"lfdtools.dmp","version":2})").id == "json.newer_version");
  REQUIRE(expect(R"({"format":"lfdtools.dmp","version":0})").id == "json.out_of_range");
  REQUIRE(expect(R"({"format":"lfdtools.dmp","version":1.0})").id == "json.not_an_integer");
}

TEST_CASE("the writer is compact, keeps the order, escapes, and writes doubles that read back") {
  JsonWriter json;
  json.begin_object().member("z", 1).member("a", "q\"\\\n\x01").member("t", true).key("n").null();
  json.member("v", Vector((Vector(2) << 0.1, -0.0).finished()))
      .key("m")
      .matrix((Matrix(2, 2) << 1, 2, 3, 4).finished());
  json.key("o").begin_object().end_object().key("l").begin_array().begin_array().end_array().integer(-3).end_array();
  json.member("s", std::vector<std::string>{"x", "y"}).end_object();
  REQUIRE(json.text() == R"({"z":1,"a":"q\"\\\n\u0001","t":true,"n":null,"v":[0.1,0],"m":[[1,2],[3,4]],"o":{},)"
                         R"("l":[[],-3],"s":["x","y"]})");
  REQUIRE(refusal_of([&] { json.number(std::nan("")); }).id == "json.write_not_finite");
  REQUIRE(refusal_of([&] { json.number(-HUGE_VAL); }).fault == Fault::internal);

  Random random(11);
  Vector values(20'000);
  for (double& value : values) {
    do value = std::bit_cast<double>(random.bits());
    while (!std::isfinite(value) || value == 0);
  }
  JsonWriter many;
  many.begin_object().member("v", values).end_object();
  REQUIRE(document(many.text()).root().at("v").vector() == values);
}

TEST_CASE("header and provenance are read as they were written") {
  FileHeader header{{"x", "y"}, {"03", "ann", "2", {}}, {}};
  header.provenance = append({{"demo-align", "0.1.0", {"--window", "10"}, {}, std::string(64, 'a')}},
                             {"gmm-fit", "0.1.0", {}, 18446744073709551615ULL, ""});
  JsonWriter json;
  write_header(json, "lfdtools.dmp", header);
  write_provenance(json, header);
  REQUIRE(json.text() ==
          "{\"format\":\"lfdtools.dmp\",\"version\":1,\"columns\":[\"x\",\"y\"],\"target\":\"03\",\"demo\":2,"
          "\"teacher\":\"ann\",\"provenance\":[{\"program\":\"demo-align\",\"version\":\"0.1.0\","
          "\"arguments\":[\"--window\",\"10\"],\"input_sha256\":\"" +
              std::string(64, 'a') +
              "\"},{\"program\":\"gmm-fit\",\"version\":\"0.1.0\",\"arguments\":[],"
              "\"seed\":18446744073709551615}]}");
  const FileHeader back = read_header(document(json.text()), "lfdtools.dmp");
  REQUIRE(back.columns == header.columns);
  REQUIRE(back.labels == header.labels);
  REQUIRE(back.provenance == header.provenance);
}

TEST_CASE("labels keep their spelling") {
  for (const std::string label : {"0", "7", "-7", "007", "-0", "1.0", "9999999999999999999", "word", "a \"b\""}) {
    JsonWriter json;
    write_labels(json.begin_object(), {label, {}, {}, {}});
    REQUIRE(read_labels(document(json.end_object().text()).root()).target == label);
  }
  const auto target = [](const char* value) {
    return refusal_of([&] { (void)read_labels(document("{\"target\":" + std::string(value) + "}").root()); }).id;
  };
  REQUIRE(target("1.5") == "json.wrong_type");
  REQUIRE(target("\"\"") == "json.out_of_range");
  REQUIRE(target("\"a\\nb\"") == "json.out_of_range");
  REQUIRE(target("null") == "json.wrong_type");
}

TEST_CASE("a header without columns, or with one twice, is refused") {
  const auto columns = [](const char* value) {
    return refusal_of([&] {
      (void)read_header(document(R"({"format":"lfdtools.dmp","version":1,"columns":)" + std::string(value) + "}"),
                        "lfdtools.dmp");
    });
  };
  REQUIRE(columns("[]").id == "json.wrong_length");
  REQUIRE(columns("[\"x\",\"x\"]").place.pointer == "/columns/1");
  REQUIRE(columns("[\"\"]").id == "json.out_of_range");
  REQUIRE(columns("\"x\"").id == "json.wrong_type");
}

TEST_CASE("a file that should hold one document holds one") {
  const ScratchFolder folder;
  REQUIRE(read_json(folder.write("one", "{\"a\":1}\n"), silent).root().at("a").number() == 1);
  REQUIRE(refusal_of([&] { (void)read_json(folder.write("two", "{} {}"), silent); }).id == "json.one_document");
  REQUIRE(refusal_of([&] { (void)read_json(folder.file("none"), silent); }).fault == Fault::no_input);
}
