#include "lfdtools/io/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace lfd {
namespace {

TargetDemonstrations taken(Pool pool, bool noise_free) {
  TargetDemonstrations target{pool.labels, {}, noise_free};
  for (auto& recording : pool.recordings) {
    target.demonstration_labels.push_back(recording.demonstration.labels);
    target.demonstrations.push_back(std::move(recording.demonstration.trajectory));
  }
  return target;
}

}  // namespace

std::vector<TargetDemonstrations> read_targets(const DemonstrationSource& source) {
  std::vector<TargetDemonstrations> targets;
  for (std::size_t i = 0; i < source.pools(); ++i) targets.push_back(taken(source.pool(i), false));
  return targets;
}

std::vector<TargetDemonstrations> read_test_targets(const std::string& name, const std::vector<std::string>& columns,
                                                    const std::vector<TargetDemonstrations>& known, bool noise_free,
                                                    Messages& messages) {
  std::vector<Input> inputs;
  inputs.emplace_back(name);
  const DemonstrationSource source(CsvTable(std::move(inputs), messages), messages, {.columns = columns});
  std::vector<TargetDemonstrations> targets;
  int learnt = 0;
  std::optional<Place> first_learnt;
  for (std::size_t i = 0; i < source.pools(); ++i) {
    Pool pool = source.pool(i);
    if (noise_free && pool.recordings.size() > 1) {
      throw DataError(
          "validation.noise_free",
          fmt::format("without noise one path says all, and {} has {}", describe(pool.labels), pool.recordings.size()),
          pool.recordings[1].place(0));
    }
    if (std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.labels == pool.labels; })) {
      ++learnt;
      if (!first_learnt) first_learnt = pool.recordings[0].place(0);
    }
    targets.push_back(taken(std::move(pool), noise_free));
  }
  if (first_learnt) {
    messages.note("validation.target_known",
                  fmt::format("{} of {} targets to be judged on are learnt from too", learnt, targets.size()),
                  *first_learnt);
  }
  return targets;
}

}  // namespace lfd
