// What the tests of model files share: the text of a file, that text changed in one place, and what refuses it.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "io_fixture.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/io/output.hpp"

namespace lfd {

inline Messages silent("prog", MessageFormat::text, true);

/// What a writer makes of a file.
template <class File, class Writer>
std::string text_of(const File& file, Writer writer) {
  const ScratchFolder folder;
  Output out(folder.file("m.json"));
  writer(file, out);
  out.finish();
  return content(folder.file("m.json"));
}

inline JsonDocument document(const std::string& text, Fault fault = Fault::data) {
  JsonOptions options;
  options.fault = fault;
  options.strict = true;
  return {text, "m.json", silent, options};
}

/// The text with one piece put in place of another, the first there is; there must be one.
inline std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// That a reader refuses the text, with this id and place.
template <class Read>
void require_refused(const std::string& text, Read read, const std::string& id, const std::string& pointer,
                     Fault fault = Fault::data) {
  const Refusal refusal = refusal_of([&] { (void)read(document(text, fault)); });
  INFO(text);
  INFO(refusal.text);
  REQUIRE(refusal.id == id);
  REQUIRE(refusal.place.pointer == pointer);
  REQUIRE(refusal.place.file == "m.json");
  REQUIRE(refusal.fault == fault);
}

}  // namespace lfd
