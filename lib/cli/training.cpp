#include "lfdtools/cli/training.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "lfdtools/calibration.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/row_check.hpp"
#include "lfdtools/ways.hpp"

namespace lfd::cli {
namespace {

/// Words for a row: its labels, else its place in the input.
std::string name_of(const std::vector<SkillRow>& rows, std::size_t i) {
  const std::string labels = describe(rows[i].labels);
  return labels.empty() ? fmt::format("primitive {}", i + 1) : labels;
}

std::vector<SkillRow> without_repeated(const std::vector<SkillRow>& rows, Messages& messages) {
  const auto repeated = repeated_rows(rows);
  for (const std::size_t i : repeated) {
    messages.warning("skill.repeated_row",
                     name_of(rows, i) + " is left out: number for number it is an earlier one of its target");
  }
  return without(rows, repeated);
}

/// Names the outliers. @return their positions
std::vector<std::size_t> warn_of_outliers(const Skill& skill, const std::vector<SkillRow>& rows, bool left_out,
                                          Messages& messages) {
  std::vector<std::size_t> positions;
  for (const auto& outlier : outlying_rows(skill, rows)) {
    messages.warning(
        "skill.outlier",
        fmt::format("{} {}{}", name_of(rows, outlier.row),
                    outlier.ends
                        ? "starts or ends far from the others of its target"
                        : fmt::format("is {:.1f} times as far as the usual row from what other targets say of it",
                                      outlier.ratio),
                    left_out ? ": left out" : "; --leave-out-outliers leaves it out"));
    positions.push_back(outlier.row);
  }
  return positions;
}

std::string describe(const Ways& ways) {
  const auto second = std::count(ways.of_row.begin(), ways.of_row.end(), 1);
  return fmt::format(
      "the demonstrations go two ways round, {} one way and {} the other, {:.0f} mm and {:.1f} standard deviations "
      "apart",
      static_cast<std::ptrdiff_t>(ways.of_row.size()) - second, second, 1000 * ways.distance, ways.separation);
}

void warn_of_coinciding(const std::vector<SkillRow>& rows, Messages& messages) {
  const auto pairs = coinciding_targets(rows);
  if (pairs.empty()) return;
  const auto groups = target_groups(labels_of(rows));
  const auto name = [&](std::size_t group) { return name_of(rows, groups[group].front()); };
  messages.warning("skill.targets_coincide",
                   fmt::format("{} and {} have the same goal - start{}: left out in turn, the one tells of the other, "
                               "so bands come out too narrow",
                               name(pairs.front().first), name(pairs.front().second),
                               pairs.size() > 1 ? fmt::format(" (the first of {} such pairs)", pairs.size()) : ""));
}

}  // namespace

Skill learn(const std::vector<std::string>& columns, std::vector<SkillRow>& rows, TrainingRequest request, Run& run) {
  rows = without_repeated(rows, run.messages());
  const auto train = [&] {
    SkillOptions options = request.options;
    options.kernel = choose_kernel(columns, rows, options);
    return std::pair(train_skill(columns, rows, options), options);
  };
  auto [skill, options] = train();
  bool way_sought = !request.options.paper;
  for (;;) {
    // Before outliers, for the fewer of two ways may look like some; and after, for some may hide them.
    const auto ways = way_sought ? two_ways(skill, rows) : std::optional<Ways>();
    if (ways) way_sought = false;
    if (ways && request.way) {
      rows = rows_of_way(rows, *ways, static_cast<int>(*request.way) - 1);
      std::tie(skill, options) = train();
    } else if (ways && request.two_ways_refused) {
      run.refuse("two_ways", describe(*ways) + "; --way 1 or 2 learns one of them");
    } else if (ways) {
      run.messages().warning("skill.two_ways", describe(*ways) + ": what follows is of both together");
    }
    const auto outliers = warn_of_outliers(skill, rows, request.leave_out_outliers, run.messages());
    if (!request.leave_out_outliers || outliers.empty()) break;
    rows = without(rows, outliers);
    std::tie(skill, options) = train();
  }
  if (request.way && (way_sought || request.options.paper)) {
    throw DataError("skill.one_way", "the demonstrations go one way alone");
  }
  warn_of_coinciding(rows, run.messages());
  if (request.calibrated) {
    skill.calibration = calibrate(skill, rows, options);
    if (!skill.calibration) {
      run.messages().note("skill.not_calibrated",
                          "fewer than three targets can be left out in turn: bands are what the process says");
    }
  }
  return skill;
}

}  // namespace lfd::cli
