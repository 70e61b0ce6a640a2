// Figures of motions beside reference motions of the same targets.
#include <fmt/format.h>

#include <map>
#include <numbers>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/metrics.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  std::string reference_file;
  std::optional<double> duration;
  std::int64_t samples = 200;
  cli::Program program("motion-compare", "Compare motions with reference motions of the same targets.");
  program.reads("trajectory or demonstrations CSV").uses_columns();
  program.path("--reference", reference_file, "trajectory CSV, one motion a target");
  program.number("--duration", duration, cli::positive, "score this much of each motion [s] (default: the whole)");
  program.integer("-n,--samples", samples, {10, 1'000'000}, "phases at which motions are compared");
  program.check([&] {
    if (reference_file.empty()) throw UsageError("usage.missing", "--reference FILE is needed");
  });
  program.example("motion-compare motions.csv --reference intentions.csv --duration 3", "error, arrival, smoothness");
  return program.run(argc, argv, [&](cli::Run& run) {
    std::vector<Input> reference_inputs;
    reference_inputs.emplace_back(reference_file);
    DemonstrationSource references(CsvTable(std::move(reference_inputs), run.messages()), run.messages(),
                                   {.columns = run.options().columns});
    std::map<std::string, Samples> paths;
    for (std::size_t i = 0; i < references.recordings(); ++i) {
      const Demonstration reference = references.recording(i).demonstration;
      const std::string target = reference.labels.target.value_or("");
      if (!paths.emplace(target, at_phases(reference.trajectory, samples)).second) {
        throw DataError("compare.repeated", fmt::format("target {} has more than one reference motion", target));
      }
    }
    DemonstrationSource motions(CsvTable(run.open(), run.messages(), {.renumber = run.options().renumber}),
                                run.messages(), {.columns = run.options().columns});
    if (motions.columns() != references.columns()) {
      throw DataError("compare.columns_differ", "motions and references have different signals");
    }
    LabelledTable table(run.output(), joined({"rmse", "end_error", "error_at_duration", "overshoot", "arrival_angle",
                                              "lateral", "jerk", "path_length", "duration"},
                                             prefixed("arrival_", motions.columns())));
    const auto D = static_cast<Eigen::Index>(motions.columns().size());
    for (std::size_t i = 0; i < motions.recordings(); ++i) {
      const Demonstration motion = motions.recording(i).demonstration;
      const auto found = paths.find(motion.labels.target.value_or(""));
      if (found == paths.end()) {
        throw DataError("compare.no_reference", fmt::format("{} has no reference motion", describe(motion.labels)));
      }
      const Samples& reference = found->second;
      const Samples scored = at_phases(motion.trajectory, samples, duration.value_or(0));
      const Arrival line = arrival(reference);
      const double seconds = duration.value_or(motion.trajectory.duration());
      // Arrival and end look at the whole motion: it may settle after its duration.
      const Samples& whole = motion.trajectory.positions;
      const Arrival own = arrival(whole);
      Samples row(1, 9 + D);
      row << rms_distance(scored, reference), (motion.trajectory.goal() - line.end).norm(),
          (scored.row(samples - 1).transpose() - line.end).norm(), overshoot(whole, line),
          angle_between(own.direction, line.direction) * 180 / std::numbers::pi, lateral_deviation(whole, line),
          rms_jerk(scored, seconds), path_length(whole), motion.trajectory.duration(), own.direction.transpose();
      table.write(motion.labels, row);
    }
  });
}
