#include "lfdtools/io/labelled_table.hpp"

#include "lfdtools/error.hpp"

namespace lfd {

CsvWriter& LabelledTable::begin(const Labels& labels) {
  const auto names = label_columns(labels);
  if (!writer_) {
    label_columns_ = names;
    writer_.emplace(out_, joined(names, columns_));
  } else if (names != label_columns_) {
    throw DataError("csv.labels_differ", "some groups have labels (target, teacher, demo) that others lack");
  }
  if (!(labels == last_) || seen_.empty()) {
    if (!seen_.insert(describe(labels)).second) {
      throw DataError("csv.group_reappears", describe(labels) + " appears again after other groups");
    }
    last_ = labels;
  }
  return *writer_;
}

void LabelledTable::write(const Labels& labels, const Samples& values) {
  begin(labels).rows(labels, values);
}

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<std::string> prefixed(const std::string& prefix, const std::vector<std::string>& names) {
  std::vector<std::string> result;
  for (const auto& name : names) result.push_back(prefix + name);
  return result;
}

Samples beside(const Samples& a, const Samples& b) {
  Samples both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

}  // namespace lfd
