// Aligns the demonstrations of each target in time (paper Table 1, step 1).
#include <fmt/format.h>

#include "lfdtools/cli/alignment_report.hpp"
#include "lfdtools/cli/program.hpp"

using namespace lfd;

namespace {

/// Index of the demonstration that --reference names in this group.
Eigen::Index find_reference(const std::string& label, const Pool& pool) {
  for (std::size_t i = 0; i < pool.recordings.size(); ++i) {
    if (pool.recordings[i].demonstration.labels.demo == label) return static_cast<Eigen::Index>(i);
  }
  throw DataError("align.no_reference", fmt::format("there is no demonstration {} ({})", label, describe(pool.labels)));
}

}  // namespace

int main(int argc, char** argv) {
  AlignmentOptions options;
  std::string reference = "medoid";
  std::optional<std::int64_t> samples;
  bool costs = false;
  cli::Program program("demo-align", "Align the demonstrations of each target in time.");
  program.reads("demonstrations CSV").uses_jobs().uses_columns();
  program.text("--reference", reference, "medoid, longest, dba (barycentre), or the label of a demonstration");
  program.choice("--clock", options.clock, {{"mean", Clock::mean}, {"reference", Clock::reference}},
                 "whose timing the group gets: its mean, or the reference's");
  program.number("--window", options.window, {0, 1, true}, "Sakoe-Chiba half-width, a fraction of the longer series");
  program.number_or_default("--trim", options.trim, default_trim, {0, 1, true},
                            "cut idle ends, where the speed is under this fraction of its peak (0.05)");
  program.integer("--samples", samples, {2, 1'000'000},
                  "samples of each aligned demonstration (default: the reference's)");
  program.flag("--leave-out-outliers", options.leave_out_outliers, "leave out demonstrations far from the others");
  program.flag("--costs", costs, "write the pairwise DTW costs instead");
  program.example("demo-align demos.csv -o aligned.csv", "each target on the mean clock of its demonstrations");
  program.example("demo-align --trim --costs demos.csv", "how far apart demonstrations lie once idle ends are cut");
  return program.run(argc, argv, [&](cli::Run& run) {
    DemonstrationSource source(CsvTable(run.open(), run.messages(), {.renumber = run.options().renumber}),
                               run.messages(), {.columns = run.options().columns});
    options.jobs = run.jobs();
    if (samples) options.samples = *samples;
    if (reference == "longest") options.reference = Reference::longest;
    if (reference == "dba") options.reference = Reference::barycentre;
    const bool named = reference != "medoid" && reference != "longest" && reference != "dba";
    if (named) options.reference = Reference::chosen;
    LabelledTable table(run.output(),
                        costs ? std::vector<std::string>{"demo_a", "demo_b", "cost"} : joined({"t"}, source.columns()));
    for (std::size_t i = 0; i < source.pools(); ++i) {
      Pool pool = source.pool(i);
      std::vector<Trajectory> recorded;
      for (auto& recording : pool.recordings) {
        auto& demonstration = recording.demonstration;
        if (!demonstration.labels.demo) demonstration.labels.demo = fmt::format("{}", recorded.size() + 1);
        recorded.push_back(std::move(demonstration.trajectory));
      }
      if (named) options.chosen = find_reference(reference, pool);
      if (costs) {
        for (auto& trajectory : recorded) {
          if (options.trim) trajectory = trim(trajectory, *options.trim).trajectory;
        }
        cli::write_costs(table, pool, pairwise_costs(recorded, options.window, options.jobs));
        continue;
      }
      const GroupAlignment group = align(recorded, options);
      cli::report(group, pool, options.trim.has_value(), run);
      for (std::size_t k = 0; k < group.kept.size(); ++k) {
        const auto& labels = pool.recordings[static_cast<std::size_t>(group.kept[k])].demonstration.labels;
        table.write(labels, beside(group.aligned[k].times, group.aligned[k].positions));
      }
    }
  });
}
