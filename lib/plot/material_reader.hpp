// Reads one table or document after the other into a material.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/io/csv.hpp"
#include "lfdtools/plot/material.hpp"

namespace lfd::plot {

/// For refusals: what there are pictures of.
inline constexpr const char* drawable_content =
    "there are pictures of tables with a time t (demonstrations, references, motions, joints), goals, weights, "
    "leave-one-target-out errors and reliability, and of lfdtools.dmp, skill, gmm, scene and experiment";

enum class TableKind { demonstrations, references, motions, goals, weights, errors, reliability, unknown };

/// Files with the same columns.
struct Table {
  TableKind kind = TableKind::unknown;
  std::vector<std::string> columns;  ///< sorted
  std::vector<Input> inputs;
};

class MaterialReader {
 public:
  MaterialReader(Messages& messages, const MaterialOptions& options) : messages_(messages), options_(options) {}

  /// Demonstrations, references or motions.
  void read_curves(Table table);
  /// Goals, weights, errors or reliability; refuses an unknown one.
  void read_table(Table table);
  /// Every document of an input.
  void read_documents(Input input);

  [[nodiscard]] const Material& material() const { return material_; }
  /// The material, its curves in the order in which they are drawn.
  [[nodiscard]] Material take();

 private:
  [[nodiscard]] std::vector<std::string> curve_signals(const CsvTable& table) const;
  void adopt(const std::vector<std::string>& signals, const std::string& file);
  void found(const std::string& what, const std::string& file);
  void read_goals(Table table);
  void read_weights(Table table);
  void read_errors(Table table);
  void read_reliability(Table table);
  void read_document(const JsonDocument& document, const std::string& file);

  Messages& messages_;
  const MaterialOptions& options_;
  Material material_;
};

}  // namespace lfd::plot
