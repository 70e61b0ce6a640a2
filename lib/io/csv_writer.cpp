#include <cmath>

#include "lfdtools/io/csv.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd {

std::vector<std::string> label_columns(const Labels& labels) {
  std::vector<std::string> names;
  if (labels.target) names.emplace_back("target");
  if (labels.teacher) names.emplace_back("teacher");
  if (labels.demo) names.emplace_back("demo");
  if (labels.sample) names.emplace_back("sample");
  return names;
}

CsvWriter::CsvWriter(Output& out, const std::vector<std::string>& columns) : out_(out), columns_(columns.size()) {
  for (const std::string& column : columns) text(column);
  end_row();
}

void CsvWriter::separate() {
  if (cells_++ > 0) out_.write(",");
}

void CsvWriter::finite(double value) {
  char* const begin = out_.room(number_room + 1);
  char* at = begin;
  if (cells_++ > 0) *at++ = ',';
  at = format_number(value, at);
  out_.filled(static_cast<std::size_t>(at - begin));
}

void CsvWriter::number(double value) {
  if (!std::isfinite(value)) {
    throw Error(Fault::internal, "csv.write_not_finite", "a result is no finite number", {out_.name(), 0, 0, ""});
  }
  finite(value);
}

void CsvWriter::integer(long long value) {
  separate();
  out_.write(std::to_string(value));
}

void CsvWriter::text(std::string_view value) {
  separate();
  // A cell on its own line must not look like an empty line.
  if (value.find_first_of(",\"\r\n") == std::string_view::npos && !(value.empty() && columns_ == 1)) {
    out_.write(value);
    return;
  }
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  out_.write(quoted += '"');
}

void CsvWriter::labels(const Labels& labels) {
  for (const auto* label : {&labels.target, &labels.teacher, &labels.demo, &labels.sample}) {
    if (*label) text(**label);
  }
}

void CsvWriter::end_row() {
  if (cells_ != columns_) {
    throw Error(Fault::internal, "csv.write_ragged",
                "a row has " + std::to_string(cells_) + " cells instead of " + std::to_string(columns_),
                {out_.name(), 0, 0, ""});
  }
  out_.write("\n");
  cells_ = 0;
}

void CsvWriter::rows(const Labels& group, const Samples& values) {
  if (!values.allFinite()) {
    throw Error(Fault::internal, "csv.write_not_finite", "a result is no finite number", {out_.name(), 0, 0, ""});
  }
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    labels(group);
    for (Eigen::Index i = 0; i < values.cols(); ++i) finite(values(row, i));
    end_row();
  }
}

}  // namespace lfd
