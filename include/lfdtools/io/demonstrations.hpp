// Demonstrations and references from a table: which columns are signals, and what must hold for time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/io/csv.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// What to read.
struct DemonstrationOptions {
  std::vector<std::string> columns;  ///< signals (`--columns`); empty: by the rule of signal_columns
  std::vector<std::string> extras;   ///< further numeric columns to read beside the signals, such as start_x or qw
  Eigen::Index min_samples = 3;      ///< fewer in a group are refused
  bool gaps = true;                  ///< warn of them; not where samples need not be evenly in time
  bool rising = true;                ///< times must rise; false: every row stands for itself, as solutions of a pose do
};

/// The signals of a table: `x,y,z` if all three are there, else every other numeric column, never labels, t, qw..qz,
/// and never a column start_s, goal_s, sd_s, cov_s_r, d_s, v_s, a_s that belongs to another column s.
/// @throws DataError [demo.no_signal]
[[nodiscard]] std::vector<std::string> signal_columns(const CsvTable& table);

/// q1 to q6, the columns of an arm's joints.
[[nodiscard]] const std::vector<std::string>& joint_columns();

/// One group of a table.
struct Recording {
  Demonstration demonstration;     ///< labels, times and signals
  Samples extras;                  ///< T x number of extras asked for
  std::string file;                ///< name of the input
  std::vector<std::size_t> lines;  ///< T, the line of each sample

  /// Where a sample stands in the input. @param k  sample, from 0
  [[nodiscard]] Place place(Eigen::Index k) const { return {file, lines[static_cast<std::size_t>(k)], 0, ""}; }
};

/// The recordings of one target and teacher.
struct Pool {
  Labels labels;  ///< target and teacher
  std::vector<Recording> recordings;

  /// The demonstrations alone, under the given signal names. Leaves the pool without them.
  [[nodiscard]] DemonstrationSet take(const std::vector<std::string>& columns);
};

/// Reads demonstrations (or any table with a column t) one group or one pool at a time.
///
/// Refused, DataError with the line: time that goes back [demo.time_falls], equal times with different data
/// [demo.time_repeats], a constant time [demo.time_constant], too few samples [demo.too_few_samples].
/// Warned: identical rows, which are collapsed [demo.identical_rows]; a gap of over ten times the median period
/// [demo.gap]; a median period of over one second, as of times in ms, us or ns [demo.period]; once, x,y,z over 20 m, as
/// of positions in mm [demo.unit]; starts of a pool that lie over 0.02 (20 mm) apart [demo.starts_differ]. Columns
/// without a use are named in a note [csv.ignored_columns].
class DemonstrationSource {
 public:
  /// @throws DataError [csv.missing_column], [demo.no_signal]; UsageError [demo.bad_column] for a signal that is a
  /// label
  ///         or t, or is named twice
  DemonstrationSource(CsvTable table, Messages& messages, const DemonstrationOptions& options = {});

  /// Signal names.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] const CsvTable& table() const { return table_; }

  /// Recordings one by one, in order of first appearance.
  [[nodiscard]] std::size_t recordings() const { return table_.groups().size(); }
  [[nodiscard]] Recording recording(std::size_t i) const;

  /// Recordings by target and teacher, in order of first appearance.
  [[nodiscard]] std::size_t pools() const { return pools_.size(); }
  [[nodiscard]] Pool pool(std::size_t i) const;

 private:
  CsvTable table_;
  Messages& messages_;
  DemonstrationOptions options_;
  std::vector<std::string> columns_;
  std::vector<std::string> read_;                // t, signals, extras
  std::vector<std::vector<std::size_t>> pools_;  // groups of each pool
  mutable bool warned_of_unit_ = false;
};

}  // namespace lfd
