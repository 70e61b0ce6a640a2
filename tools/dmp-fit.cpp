// Fits a movement primitive to each trajectory (paper eq. (8)-(14)).
#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/labelled_table.hpp"

using namespace lfd;

namespace {

/// The columns prefix_signal, if the table has all of them.
std::vector<std::string> present(const CsvTable& table, const std::string& prefix,
                                 const std::vector<std::string>& signals) {
  const auto names = prefixed(prefix, signals);
  const bool all = std::all_of(names.begin(), names.end(), [&](const auto& name) { return table.has(name); });
  return all ? names : std::vector<std::string>();
}

/// Refuses (or warns of) axes that hardly move from start to goal, where the paper's scaling divides by almost nothing.
void gate_small_changes(const Recording& recording, const std::vector<std::string>& signals,
                        const DmpFitOptions& options, cli::Run& run) {
  const Trajectory& path = recording.demonstration.trajectory;
  const auto small = small_goal_change(path, options.start.value_or(path.start()), options.goal.value_or(path.goal()));
  for (std::size_t j = 0; j < small.size(); ++j) {
    if (!small[j]) continue;
    run.refuse("goal_change",
               fmt::format("{}{}: |goal - start| is under 1 % of the excursion, too little to scale by",
                           recording.demonstration.labels.target ? describe(recording.demonstration.labels) + ", " : "",
                           signals[j]),
               recording.place(0));
  }
}

}  // namespace

int main(int argc, char** argv) {
  DmpFitOptions options;
  bool paper = false;
  std::int64_t bases = options.bases;
  cli::Program program("dmp-fit", "Fit a dynamic movement primitive to each reference or demonstration.");
  program.reads("reference, trajectory or demonstrations CSV").uses_columns();
  program.flag("--paper", paper, "the published fit: --fit lwr --scaling goal");
  program.integer("-n,--basis", bases, {2, 10'000}, "basis functions");
  program.number("--alpha-z", options.alpha_z, cli::positive, "damping");
  program.number("--beta-z", options.beta_z, cli::positive, "stiffness over damping (default: alpha-z / 4)");
  program.number("--alpha-x", options.alpha_x, cli::positive, "decay of the phase");
  program.choice("--scaling", options.scaling, {{"none", DmpScaling::none}, {"goal", DmpScaling::goal}},
                 "scale of the forcing term: 1, or goal - start (paper eq. (12))");
  program.choice("--fit", options.fit,
                 {{"trajectory", DmpFitMethod::trajectory}, {"ls", DmpFitMethod::ls}, {"lwr", DmpFitMethod::lwr}},
                 "least squares on positions, on the forcing term, or locally weighted regression");
  program.gate("goal_change", "--scaling goal on an axis where the goal is near the start");
  program.example("gmr-regress gmm.json | dmp-fit -o dmp.json", "one primitive a target, from its reference");
  program.example("demo-align demos.csv | dmp-fit -n 20", "one primitive a demonstration");
  return program.run(argc, argv, [&](cli::Run& run) {
    options.bases = bases;
    if (paper) {
      if (!program.given("--fit")) options.fit = DmpFitMethod::lwr;
      if (!program.given("--scaling")) options.scaling = DmpScaling::goal;
    }
    options.allow_small_scale = true;  // the gate has decided
    CsvTable table(run.open(), run.messages(), {.renumber = run.options().renumber});
    const auto signals = run.options().columns.empty() ? signal_columns(table) : run.options().columns;
    const auto starts = present(table, "start_", signals);
    const auto goals = present(table, "goal_", signals);
    const auto sds = present(table, "sd_", signals);
    const auto D = static_cast<Eigen::Index>(signals.size());
    DemonstrationSource source(std::move(table), run.messages(),
                               {.columns = signals, .extras = joined(joined(starts, goals), sds)});
    const Provenance entry = run.provenance(source.table().sha256());
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
      Eigen::Index next = 0;
      const auto take = [&](const auto& names) { return names.empty() ? -1 : std::exchange(next, next + D); };
      const Eigen::Index start = take(starts);
      const Eigen::Index goal = take(goals);
      const Eigen::Index sd = take(sds);
      if (start >= 0) options.start = recording.extras.row(0).segment(start, D).transpose();
      if (goal >= 0) options.goal = recording.extras.row(0).segment(goal, D).transpose();
      if (sd >= 0) options.sd = recording.extras.middleCols(sd, D);
      if (options.scaling == DmpScaling::goal) gate_small_changes(recording, signals, options, run);
      const Dmp dmp = fit_dmp(recording.demonstration.trajectory, options);
      run.figure("largest_rmse", std::sqrt(dmp.rmse.squaredNorm()));
      write_dmp({{signals, recording.demonstration.labels, {entry}}, dmp}, run.output());
    }
  });
}
