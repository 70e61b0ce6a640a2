#include "lfdtools/plot/material.hpp"

#include <algorithm>

#include "material_reader.hpp"

namespace lfd::plot {
namespace {

bool is_json(const Input& input) {
  char text[256];
  const std::size_t count = input.read_at(0, text, sizeof text);
  std::string_view start(text, count);
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && start[first] == '{';
}

bool has_all(const std::vector<std::string>& columns, const std::vector<std::string>& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  });
}

TableKind kind_of(const std::vector<std::string>& columns) {
  if (has_all(columns, {"signal", "basis", "mean", "sd"})) return TableKind::weights;
  if (has_all(columns, {"method", "nominal", "pointwise", "path", "width"})) return TableKind::reliability;
  if (has_all(columns, {"method", "rmse"})) return TableKind::errors;
  if (has_all(columns, {"t"})) {
    const bool with_goals = std::any_of(columns.begin(), columns.end(), [&](const std::string& name) {
      return name.starts_with("goal_") && has_all(columns, {name.substr(5)});
    });
    return with_goals                   ? TableKind::references
           : has_all(columns, {"demo"}) ? TableKind::demonstrations
                                        : TableKind::motions;
  }
  if (has_all(columns, {"x", "y", "z"})) return TableKind::goals;
  return TableKind::unknown;
}

}  // namespace

std::string series_name(const Labels& labels) {
  if (!labels.target) return labels.teacher.value_or("");
  return *labels.target + (labels.teacher ? " (" + *labels.teacher + ")" : "");
}

Material read_material(std::vector<Input> inputs, Messages& messages, const MaterialOptions& options) {
  std::vector<Table> tables;
  std::vector<Input> documents;
  for (Input& input : inputs) {
    if (is_json(input)) {
      documents.push_back(std::move(input));
      continue;
    }
    Table table;
    table.columns = csv_columns(input);
    std::sort(table.columns.begin(), table.columns.end());
    const auto same =
        std::find_if(tables.begin(), tables.end(), [&](const Table& other) { return other.columns == table.columns; });
    if (same != tables.end()) {
      same->inputs.push_back(std::move(input));
      continue;
    }
    table.kind = kind_of(table.columns);
    table.inputs.push_back(std::move(input));
    tables.push_back(std::move(table));
  }
  MaterialReader reader(messages, options);
  for (Table& table : tables) {
    if (table.kind == TableKind::demonstrations || table.kind == TableKind::references ||
        table.kind == TableKind::motions) {
      reader.read_curves(std::move(table));
    }
  }
  for (Input& input : documents) reader.read_documents(std::move(input));
  // Goals have the signals of the curves, whatever these are called.
  for (Table& table : tables) {
    if (table.inputs.empty()) continue;
    const std::vector<std::string>& signals = reader.material().signals;
    if (table.kind == TableKind::unknown && !signals.empty() && has_all(table.columns, signals)) {
      table.kind = TableKind::goals;
    }
    reader.read_table(std::move(table));
  }
  return reader.take();
}

}  // namespace lfd::plot
