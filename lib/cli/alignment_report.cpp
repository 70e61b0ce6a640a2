#include "lfdtools/cli/alignment_report.hpp"

#include <fmt/format.h>

namespace lfd::cli {

void report(const GroupAlignment& group, const Pool& pool, bool trimmed, Run& run) {
  for (std::size_t i = 0; i < pool.recordings.size(); ++i) {
    const std::string name = describe(pool.recordings[i].demonstration.labels);
    if (group.outliers[i]) {
      run.messages().warning("align.outlier", fmt::format("{} is far from the others of its target", name));
    }
    if (trimmed) {
      run.messages().note("align.trimmed", fmt::format("{}: cut {:.2f} s at the start, {:.2f} s at the end", name,
                                                       group.trimmed[i].start, group.trimmed[i].end));
    }
  }
  run.detail("align.reference",
             fmt::format("{} is the reference",
                         describe(pool.recordings[static_cast<std::size_t>(group.reference)].demonstration.labels)));
}

void write_costs(LabelledTable& table, const Pool& pool, const Matrix& costs) {
  for (Eigen::Index a = 0; a < costs.rows(); ++a) {
    for (Eigen::Index b = a + 1; b < costs.cols(); ++b) {
      CsvWriter& writer = table.begin(pool.labels);
      writer.labels(pool.labels);
      for (const Eigen::Index i : {a, b})
        writer.text(*pool.recordings[static_cast<std::size_t>(i)].demonstration.labels.demo);
      writer.number(costs(a, b));
      writer.end_row();
    }
  }
}

}  // namespace lfd::cli
