#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/goals.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "material_reader.hpp"

namespace lfd::plot {
namespace {

bool has_all(const CsvTable& table, const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) { return table.has(name); });
}

}  // namespace

void MaterialReader::found(const std::string& what, const std::string& file) {
  material_.found.push_back(what + " (" + file + ")");
}

void MaterialReader::adopt(const std::vector<std::string>& signals, const std::string& file) {
  if (material_.signals.empty()) material_.signals = signals;
  if (material_.signals != signals) {
    throw DataError("plot.columns_differ",
                    fmt::format("the signals are {}, those of the other files {}: --columns names what to draw",
                                fmt::join(signals, ", "), fmt::join(material_.signals, ", ")),
                    {file, 1, 0, ""});
  }
}

std::vector<std::string> MaterialReader::curve_signals(const CsvTable& table) const {
  if (!options_.columns.empty()) return options_.columns;
  // Of a joints table the joints; speeds and diagnostics on request.
  if (!has_all(table, {"x", "y", "z"}) && has_all(table, joint_columns())) return joint_columns();
  return {};
}

void MaterialReader::read_curves(Table pending) {
  const std::string file = pending.inputs[0].name();
  CsvTable table(std::move(pending.inputs), messages_, {.renumber = options_.renumber});
  const Role role = pending.kind == TableKind::demonstrations ? Role::demonstration
                    : pending.kind == TableKind::references   ? Role::reference
                                                              : Role::motion;
  DemonstrationOptions how;
  how.columns = curve_signals(table);
  how.min_samples = 1;
  std::vector<std::string> signals = how.columns;
  if (signals.empty()) signals = signal_columns(table);
  const bool with_sd = has_all(table, prefixed("sd_", signals));
  const bool with_goal = has_all(table, prefixed("goal_", signals));
  const bool with_start = has_all(table, prefixed("start_", signals));
  if (with_sd) how.extras = prefixed("sd_", signals);
  if (with_goal) how.extras = joined(how.extras, prefixed("goal_", signals));
  if (with_start) how.extras = joined(how.extras, prefixed("start_", signals));  // known, though not drawn
  const DemonstrationSource source(std::move(table), messages_, how);
  adopt(source.columns(), file);
  const auto D = static_cast<Eigen::Index>(signals.size());
  for (std::size_t i = 0; i < source.recordings(); ++i) {
    Recording recording = source.recording(i);
    Curve curve;
    curve.role = role;
    curve.labels = recording.demonstration.labels;
    curve.trajectory = std::move(recording.demonstration.trajectory);
    if (with_sd) curve.sd = recording.extras.leftCols(D);
    if (with_goal) curve.goal = recording.extras.row(0).segment(with_sd ? D : 0, D).transpose();
    material_.curves.push_back(std::move(curve));
  }
  found(role == Role::demonstration ? "demonstrations" : role == Role::reference ? "references" : "motions", file);
}

void MaterialReader::read_table(Table table) {
  switch (table.kind) {
    case TableKind::goals:
      return read_goals(std::move(table));
    case TableKind::weights:
      return read_weights(std::move(table));
    case TableKind::errors:
      return read_errors(std::move(table));
    case TableKind::reliability:
      return read_reliability(std::move(table));
    default: {
      const std::vector<std::string> names = csv_columns(table.inputs[0]);
      throw DataError("plot.unknown_content",
                      fmt::format("nothing here that can be drawn: the columns are {}; {}", fmt::join(names, ", "),
                                  drawable_content),
                      {table.inputs[0].name(), 1, 0, ""});
    }
  }
}

void MaterialReader::read_goals(Table table) {
  const std::string file = table.inputs[0].name();
  if (material_.signals.empty()) {
    adopt(options_.columns.empty() ? std::vector<std::string>{"x", "y", "z"} : options_.columns, file);
  }
  for (Input& input : table.inputs) {
    for (Goal& goal : lfd::read_goals(std::move(input), material_.signals, messages_)) {
      material_.goals.push_back(std::move(goal));
    }
  }
  found("goals", file);
}

void MaterialReader::read_weights(Table pending) {
  const std::string file = pending.inputs[0].name();
  const CsvTable table(std::move(pending.inputs), messages_);
  for (std::size_t i = 0; i < table.groups().size(); ++i) {
    const NumericBlock block = table.read_group(i, {"basis", "mean", "sd"});
    const std::vector<std::string> signals = table.read_text(i, "signal");
    for (Eigen::Index row = 0, rows = 0; row < block.values.rows(); row += rows) {
      const std::string& signal = signals[static_cast<std::size_t>(row)];
      rows = 1;
      while (row + rows < block.values.rows() && signals[static_cast<std::size_t>(row + rows)] == signal) ++rows;
      const auto part = block.values.middleRows(row, rows);
      if ((part.col(2).array() < 0).any()) {
        throw DataError("plot.negative_sd", "a standard deviation is negative", block.place(row));
      }
      material_.predicted.push_back({block.labels, signal, part.col(0), part.col(1), part.col(2)});
    }
  }
  found("weights", file);
}

void MaterialReader::read_errors(Table pending) {
  const std::string file = pending.inputs[0].name();
  const CsvTable table(std::move(pending.inputs), messages_, {.grouped = false});
  material_.measures = options_.columns.empty() ? std::vector<std::string>{"rmse"} : options_.columns;
  for (std::size_t i = 0; i < table.groups().size(); ++i) {
    const NumericBlock block = table.read_group(i, material_.measures);
    const std::vector<std::string> methods = table.read_text(i, "method");
    const std::vector<std::string> targets =
        table.has("target") ? table.read_text(i, "target") : std::vector<std::string>(methods.size());
    for (std::size_t row = 0; row < methods.size(); ++row) {
      material_.errors.push_back(
          {methods[row], targets[row], block.values.row(static_cast<Eigen::Index>(row)).transpose()});
    }
  }
  found("leave-one-target-out errors", file);
}

void MaterialReader::read_reliability(Table pending) {
  const std::string file = pending.inputs[0].name();
  const CsvTable table(std::move(pending.inputs), messages_, {.grouped = false});
  for (std::size_t i = 0; i < table.groups().size(); ++i) {
    const NumericBlock block = table.read_group(i, {"nominal", "pointwise", "path", "width"});
    const std::vector<std::string> methods = table.read_text(i, "method");
    for (Eigen::Index row = 0; row < block.values.rows(); ++row) {
      const auto shares = block.values.row(row).head(3);
      if (shares.minCoeff() < 0 || shares.maxCoeff() > 1) {
        throw DataError("plot.share", "a level or a share lies outside 0 to 1", block.place(row));
      }
      material_.reliability.push_back(
          {methods[static_cast<std::size_t>(row)], shares[0], shares[1], shares[2], block.values(row, 3)});
    }
  }
  found("reliability", file);
}

Material MaterialReader::take() {
  std::stable_sort(material_.curves.begin(), material_.curves.end(),
                   [](const Curve& a, const Curve& b) { return a.role < b.role; });
  if (material_.signals.empty() && !material_.obstacles.empty()) material_.signals = {"x", "y", "z"};
  return std::move(material_);
}

}  // namespace lfd::plot
