#include "lfdtools/io/demonstrations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "lfdtools/io/number.hpp"

namespace lfd {
namespace {

constexpr double long_gap = 10;                      // median periods
constexpr double slow_period = 1;                    // [s]: no hand is recorded more slowly
constexpr double far_start = 0.02;                   // [m]
constexpr double far_away = 20;                      // [m]: no hand reaches so far
constexpr double far_turned = 6 * std::numbers::pi;  // [rad]: no joint turns so far
const std::vector<std::string> position_columns{"x", "y", "z"};

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_label(std::string_view column) {
  return contains(label_columns(), column);
}

/// start_x beside x, cov_x_y beside x and y: columns that say something about a signal.
bool belongs_to_another(const CsvTable& table, std::string_view column) {
  for (const std::string_view prefix : {"start_", "goal_", "sd_", "d_", "v_", "a_"}) {
    if (column.starts_with(prefix) && table.has(column.substr(prefix.size()))) return true;
  }
  if (!column.starts_with("cov_")) return false;
  const std::string_view pair = column.substr(4);
  for (std::size_t i = pair.find('_'); i != std::string_view::npos; i = pair.find('_', i + 1)) {
    if (table.has(pair.substr(0, i)) && table.has(pair.substr(i + 1))) return true;
  }
  return false;
}

void require_column(const CsvTable& table, const std::string& column) {
  if (!table.has(column)) (void)table.read_group(0, {column});  // refuses, and names the columns that are there
}

/// To a tenth of a millimetre, for messages.
double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

double median_period(const Vector& times) {
  std::vector<double> periods;
  for (Eigen::Index k = 1; k < times.size(); ++k) periods.push_back(times[k] - times[k - 1]);
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

void warn_of_sampling(const Recording& recording, bool gaps, Messages& messages) {
  const Vector& times = recording.demonstration.trajectory.times;
  if (times.size() < 2) return;
  const double period = median_period(times);
  if (period > slow_period) {
    messages.warning("demo.period",
                     "the median sampling period is " + number_text(period) +
                         " s: are the times in milliseconds or nanoseconds? seconds are needed",
                     recording.place(0));
  }
  Eigen::Index first = 0;
  Eigen::Index count = 0;
  for (Eigen::Index k = 1; gaps && k < times.size(); ++k) {
    if (times[k] - times[k - 1] > long_gap * period && count++ == 0) first = k;
  }
  if (count > 0) {
    messages.warning("demo.gap",
                     "a gap of " + number_text(times[first] - times[first - 1]) + " s, over ten sampling periods" +
                         (count > 1 ? ", the first of " + std::to_string(count) : ""),
                     recording.place(first));
  }
}

/// Positions that no hand reaches in metres, joints that do not turn so far in radians. @return whether there were any
bool warn_of_unit(const Recording& recording, const std::vector<std::string>& columns, Messages& messages) {
  const bool joints = columns == joint_columns();
  if (columns != position_columns && !joints) return false;
  Eigen::Index row = 0, column = 0;
  const double largest = recording.demonstration.trajectory.positions.cwiseAbs().maxCoeff(&row, &column);
  if (largest <= (joints ? far_turned : far_away)) return false;
  if (joints) {
    messages.warning("joints.degrees",
                     columns[static_cast<std::size_t>(column)] + " reaches " + number_text(rounded(largest)) +
                         ", over three turns: are the joints in degrees? radians are needed",
                     recording.place(row));
    return true;
  }
  messages.warning("demo.unit",
                   columns[static_cast<std::size_t>(column)] + " reaches " + number_text(rounded(largest)) +
                       ": are the positions in millimetres? metres are needed",
                   recording.place(row));
  return true;
}

void warn_of_starts(const Pool& pool, Messages& messages) {
  double widest = 0;
  const Recording* far = nullptr;
  for (const Recording& a : pool.recordings) {
    for (const Recording& b : pool.recordings) {
      if (&b == &a) break;
      const double distance = (a.demonstration.trajectory.start() - b.demonstration.trajectory.start()).norm();
      if (distance > widest) {
        widest = distance;
        far = &a;
      }
    }
  }
  if (widest > far_start) {
    const std::string words = describe(pool.labels);
    messages.warning("demo.starts_differ",
                     "the starts of the demonstrations" + (words.empty() ? "" : " of " + words) + " lie up to " +
                         number_text(rounded(widest)) + " apart, over " + number_text(far_start),
                     far->place(0));
  }
}

}  // namespace

const std::vector<std::string>& joint_columns() {
  static const std::vector<std::string> names{"q1", "q2", "q3", "q4", "q5", "q6"};
  return names;
}

std::vector<std::string> signal_columns(const CsvTable& table) {
  const auto& position = position_columns;
  if (std::all_of(position.begin(), position.end(), [&](const std::string& name) { return table.has(name); })) {
    return position;
  }
  const std::vector<std::string> never{"t", "qw", "qx", "qy", "qz"};
  std::vector<std::string> signals;
  for (const std::string& column : table.columns()) {
    if (!is_label(column) && !contains(never, column) && !belongs_to_another(table, column) &&
        table.is_numeric(column)) {
      signals.push_back(column);
    }
  }
  if (signals.empty()) {
    throw DataError("demo.no_signal", "there is no numeric column beside labels and time",
                    {table.inputs()[0].name(), 1, 0, ""});
  }
  return signals;
}

DemonstrationSet Pool::take(const std::vector<std::string>& columns) {
  DemonstrationSet set{columns, {}};
  for (Recording& recording : recordings) set.demonstrations.push_back(std::move(recording.demonstration));
  recordings.clear();
  return set;
}

DemonstrationSource::DemonstrationSource(CsvTable table, Messages& messages, const DemonstrationOptions& options)
    : table_(std::move(table)), messages_(messages), options_(options) {
  require_column(table_, "t");
  for (std::size_t i = 0; i < options_.columns.size(); ++i) {
    const std::string& column = options_.columns[i];
    if (is_label(column) || column == "t") {
      throw UsageError("demo.bad_column", "column " + column + " is no signal: it is a label or the time");
    }
    if (std::find(options_.columns.begin(), options_.columns.begin() + static_cast<std::ptrdiff_t>(i), column) !=
        options_.columns.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw UsageError("demo.bad_column", "column " + column + " is named twice");
    }
    require_column(table_, column);
  }
  columns_ = options_.columns.empty() ? signal_columns(table_) : options_.columns;
  read_.emplace_back("t");
  read_.insert(read_.end(), columns_.begin(), columns_.end());
  for (const std::string& column : options_.extras) {
    require_column(table_, column);
    read_.push_back(column);
  }
  std::string ignored;
  for (const std::string& column : table_.columns()) {
    if (!is_label(column) && !contains(read_, column)) ignored += (ignored.empty() ? "" : ", ") + column;
  }
  if (!ignored.empty()) {
    messages_.note("csv.ignored_columns", "columns without a use here: " + ignored,
                   {table_.inputs()[0].name(), 1, 0, ""});
  }
  std::map<std::pair<std::string, std::string>, std::size_t> pool_of;
  for (std::size_t i = 0; i < table_.groups().size(); ++i) {
    const Labels& labels = table_.groups()[i].labels;
    const auto [found, is_new] =
        pool_of.try_emplace({labels.target.value_or(""), labels.teacher.value_or("")}, pools_.size());
    if (is_new) pools_.emplace_back();
    pools_[found->second].push_back(i);
  }
}

Recording DemonstrationSource::recording(std::size_t i) const {
  const NumericBlock block = table_.read_group(i, read_);
  const Samples& values = block.values;
  const Eigen::Index rows = values.rows();
  const auto t = values.col(0);
  if (options_.rising && rows > 1 && (t.array() == t[0]).all() &&
      (values.rowwise() - values.row(0)).cwiseAbs().maxCoeff() > 0) {
    throw DataError("demo.time_constant", "the time never changes", block.place(0));
  }

  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (options_.rising && !kept.empty()) {
      const Eigen::Index before = kept.back();
      const std::string times = number_text(t[before]) + " to " + number_text(t[k]);
      if (t[k] < t[before]) throw DataError("demo.time_falls", "the time goes back from " + times, block.place(k));
      if (t[k] == t[before]) {
        if (values.row(k) == values.row(before)) continue;
        throw DataError("demo.time_repeats", "two rows at the time " + number_text(t[k]) + " differ", block.place(k));
      }
    }
    kept.push_back(k);
  }
  if (const std::size_t dropped = static_cast<std::size_t>(rows) - kept.size(); dropped > 0) {
    messages_.warning("demo.identical_rows", std::to_string(dropped) + " rows that repeat the row before are left out",
                      block.place(0));
  }
  const auto samples = static_cast<Eigen::Index>(kept.size());
  if (samples < options_.min_samples) {
    const std::string words = describe(block.labels);
    throw DataError("demo.too_few_samples",
                    (words.empty() ? "a recording" : words) + " needs at least " +
                        std::to_string(options_.min_samples) + " samples, and has " + std::to_string(samples),
                    block.place(0));
  }

  const auto D = static_cast<Eigen::Index>(columns_.size());
  Recording recording;
  recording.demonstration.labels = block.labels;
  recording.demonstration.trajectory.times = t(kept);
  recording.demonstration.trajectory.positions = values(kept, Eigen::seqN(1, D));
  recording.extras = values(kept, Eigen::seqN(1 + D, values.cols() - 1 - D));
  recording.file = block.file;
  for (const Eigen::Index k : kept) recording.lines.push_back(block.first_line + static_cast<std::size_t>(k));
  if (options_.rising) warn_of_sampling(recording, options_.gaps, messages_);
  if (!warned_of_unit_) warned_of_unit_ = warn_of_unit(recording, columns_, messages_);
  return recording;
}

Pool DemonstrationSource::pool(std::size_t i) const {
  Pool pool;
  for (const std::size_t group : pools_[i]) pool.recordings.push_back(recording(group));
  pool.labels = pool.recordings[0].demonstration.labels;
  pool.labels.demo.reset();
  pool.labels.sample.reset();
  warn_of_starts(pool, messages_);
  return pool;
}

}  // namespace lfd
