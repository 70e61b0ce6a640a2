#include "lfdtools/io/training_rows.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace lfd {
namespace {

/// The first setting in which two primitives differ, as a key of the file; empty if they agree.
std::string differing_setting(const DmpFile& a, const DmpFile& b) {
  const DmpSettings& p = a.dmp.settings;
  const DmpSettings& q = b.dmp.settings;
  if (a.header.columns != b.header.columns) return "columns";
  if (p.scaling != q.scaling) return "scaling";
  if (p.alpha_z != q.alpha_z) return "alpha_z";
  if (p.beta_z != q.beta_z) return "beta_z";
  if (p.alpha_x != q.alpha_x) return "alpha_x";
  if (p.centers.size() != q.centers.size() || p.centers != q.centers) return "centers";
  if (p.widths.size() != q.widths.size() || p.widths != q.widths) return "widths";
  return {};
}

}  // namespace

TrainingRows read_training_rows(JsonStream& stream) {
  TrainingRows result;
  DmpFile first;
  std::set<std::string> seen;
  while (auto document = stream.next()) {
    DmpFile row = read_dmp(*document);
    const std::string name = describe(row.header.labels);
    if (result.rows.empty()) {
      first = row;
      result.header.columns = row.header.columns;
      result.header.provenance = row.header.provenance;
    } else if (const auto setting = differing_setting(first, row); !setting.empty()) {
      document->root().at(setting).fail(
          "skill.mixed_settings",
          fmt::format("{} differs from {} in {}: such primitives make no skill together",
                      name.empty() ? fmt::format("document {}", result.rows.size() + 1) : name,
                      result.rows.front().labels == Labels{} ? "the first" : describe(result.rows.front().labels),
                      setting));
    }
    if (!name.empty() && !seen.insert(name).second) {
      document->root().fail("json.group_reappears", name + " appears twice");
    }
    result.rows.push_back({row.header.labels, std::move(row.dmp)});
  }
  return result;
}

}  // namespace lfd
