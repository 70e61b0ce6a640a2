// Makes the demonstrations of an experiment, or the intention behind them.
#include <fmt/format.h>

#include <utility>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/experiment_file.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/synthesis.hpp"

using namespace lfd;

namespace {

enum class Wanted { demonstrations, new_demonstrations, intentions, new_intentions, holes, new_holes };

/// Noise-free motions to every hole, demonstrated and new, 201 samples over the mean duration.
void write_intentions(const Experiment& experiment, Output& out) {
  LabelledTable table(out, joined({"t"}, experiment.columns));
  for (const auto* holes : {&experiment.holes, &experiment.new_holes}) {
    for (const auto& hole : *holes) {
      const Vector phases = linspace(0, 1, 201);
      table.write({.target = hole.target, .teacher = {}, .demo = {}, .sample = {}},
                  beside(phases * experiment.duration_mean, intention(experiment, hole.position, phases)));
    }
  }
}

void write_holes(const std::vector<Hole>& holes, const std::vector<std::string>& columns, Output& out) {
  LabelledTable table(out, columns);
  for (const auto& hole : holes) {
    table.write({.target = hole.target, .teacher = {}, .demo = {}, .sample = {}}, hole.position.transpose());
  }
}

}  // namespace

int main(int argc, char** argv) {
  Wanted wanted = Wanted::demonstrations;
  std::string target;
  bool no_obstacle = false;
  std::optional<std::int64_t> repetitions;
  std::optional<std::int64_t> seed;
  cli::Program program("demo-synth", "Make the demonstrations that an experiment file describes.");
  program.reads("experiment JSON");
  program.integer("--seed", seed, {0, 9'000'000'000'000'000'000}, "seed of the noise (default: the file's)");
  program.choice(
      "--write", wanted,
      {{"demonstrations", Wanted::demonstrations},
       {"new-demonstrations", Wanted::new_demonstrations},
       {"intentions", Wanted::intentions},
       {"new-intentions", Wanted::new_intentions},
       {"holes", Wanted::holes},
       {"new-holes", Wanted::new_holes}},
      "what to write: noisy demonstrations, noise-free motions to all holes, or goals CSV; new-: of new holes alone");
  program.flag("--no-obstacle", no_obstacle, "as if the obstacle were not there: what the teacher would do without it");
  program.text("--target", target, "this target alone");
  program.integer("--repetitions", repetitions, {1, 1'000'000}, "demonstrations a target (default: the file's)");
  program.example("demo-synth A.json -o demos.csv", "ten demonstrations to each of nine holes");
  program.example("demo-synth A.json --write new-holes -o goals.csv", "holes that nobody demonstrated");
  return program.run(argc, argv, [&](cli::Run& run) {
    JsonStream stream(run.open(), run.messages(), run.json_options());
    Experiment experiment = read_experiment(*stream.next());
    if (stream.next()) throw DataError("json.one_document", "an experiment is one document");
    if (seed) experiment.seed = static_cast<std::uint64_t>(*seed);
    if (no_obstacle) experiment.obstacle.reset();
    if (repetitions) experiment.repetitions = *repetitions;
    if (wanted == Wanted::new_demonstrations || wanted == Wanted::new_intentions || wanted == Wanted::new_holes) {
      experiment.holes = std::exchange(experiment.new_holes, {});
    }
    if (!target.empty()) {
      std::erase_if(experiment.holes, [&](const Hole& hole) { return hole.target != target; });
      if (experiment.holes.empty()) throw UsageError("synth.no_target", fmt::format("there is no hole '{}'", target));
    }
    switch (wanted) {
      case Wanted::intentions:
      case Wanted::new_intentions:
        return write_intentions(experiment, run.output());
      case Wanted::holes:
      case Wanted::new_holes:
        return write_holes(experiment.holes, experiment.columns, run.output());
      case Wanted::demonstrations:
      case Wanted::new_demonstrations:
        break;
    }
    LabelledTable table(run.output(), joined({"t"}, experiment.columns));
    for (const auto& demonstration : synthesize(experiment).demonstrations) {
      table.write(demonstration.labels, beside(demonstration.trajectory.times, demonstration.trajectory.positions));
    }
  });
}
