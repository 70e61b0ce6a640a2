// How far a skill is from targets that it has not seen, beside opponents: leave-one-target-out, or test targets.
#include <fmt/format.h>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/cli/suggestion_request.hpp"
#include "lfdtools/cli/validation_report.hpp"
#include "lfdtools/io/folds.hpp"
#include "lfdtools/io/targets.hpp"
#include "lfdtools/methods.hpp"

using namespace lfd;

namespace {

std::vector<int> folds_of(const std::string& file, const std::vector<TargetDemonstrations>& targets,
                          Messages& messages) {
  std::vector<Labels> labels;
  for (const auto& target : targets) labels.push_back(target.labels);
  return read_folds(file, labels, messages);
}

}  // namespace

int main(int argc, char** argv) {
  ValidationOptions options;
  PreparationOptions& rows = options.preparation;
  std::int64_t bases = rows.bases;
  std::pair<std::int64_t, std::int64_t> components{rows.k_from, rows.k_to};
  std::optional<std::int64_t> repetitions;
  std::optional<std::string> table;
  std::string folds;
  std::string test;
  bool noise_free = false;
  std::string reliability;
  std::optional<std::vector<double>> region;
  cli::Program program("skill-validate",
                       "Generate targets that were left out, or those of a test file, from the others.");
  program.reads("demonstrations CSV").uses_jobs().uses_seed().uses_columns();
  program.words("--methods", options.methods, "methods to compare (default: all)");
  program.choice(
      "--road", rows.road,
      {{"recordings", Road::recordings}, {"demonstrations", Road::demonstrations}, {"references", Road::references}},
      "training rows: every demonstration as recorded, or aligned, or one GMM-GMR reference a target");
  program.path("--folds", folds, "leave out together the targets of one fold: CSV target,fold");
  program.path("--test", test, "learn from all targets, and be judged on those of this demonstrations CSV");
  program.flag("--noise-free", noise_free, "the paths of --test are intentions: bands are about them");
  program.integer("--repetitions", repetitions, {1, 1'000'000}, "learn from so many demonstrations of a target, drawn");
  program.number_or_default("--trim", rows.alignment.trim, default_trim, {0, 1, true},
                            "cut idle ends first, as demo-align does");
  program.integer("-n,--basis", bases, {2, 10'000}, "basis functions");
  program.integer_range("-k,--components", components, {1, 10'000}, "components of the references, chosen by BIC");
  program.optional_written_path("--table", table,
                                "a readable table of rmse in mm, to this file, or instead of the CSV");
  program.written_path("--reliability", reliability, "write here how often bands of eleven levels hold");
  std::vector<std::pair<std::string, std::string>> known;
  for (const auto& method : methods()) known.emplace_back(method.name, method.meaning);
  program.topic("Methods", known);
  program.check([&] {
    (void)chosen_methods(options.methods);
    if (!folds.empty() && !test.empty()) throw UsageError("usage.exclusive", "--folds and --test exclude each other");
    if (test == "-") throw UsageError("usage.value", "--test takes a file, not standard input");
    if (noise_free && test.empty()) throw UsageError("usage.missing", "--noise-free speaks of the paths of --test");
  });
  program.numbers("--suggest", region, {}, "instead: the target in a box of goals that would teach most");
  program.check([&] {
    if (!region) return;
    (void)cli::goal_box(*region);
    for (const char* other :
         {"--methods", "--road", "--folds", "--test", "--repetitions", "--components", "--table", "--reliability"}) {
      if (program.given(other)) {
        throw UsageError("usage.exclusive", fmt::format("--suggest judges no methods, so it excludes {}", other));
      }
    }
  });
  program.example("skill-validate demos.csv --table", "every method on every target");
  program.example("skill-validate demos.csv --methods skill,affine -o scores.csv --table=table.txt", "CSV and table");
  program.example("skill-validate demos.csv --test truth.csv --noise-free --table", "against what the teacher meant");
  program.example("skill-validate demos.csv --suggest -0.2,0.3,0.8,0.8,0.1,0.5", "what to demonstrate next");
  return program.run(argc, argv, [&](cli::Run& run) {
    const DemonstrationSource source(CsvTable(run.open(), run.messages(), {.renumber = run.options().renumber}),
                                     run.messages(), {.columns = run.options().columns});
    const auto targets = read_targets(source);
    if (!folds.empty()) options.folds = folds_of(folds, targets, run.messages());
    rows.bases = bases;
    rows.k_from = components.first;
    rows.k_to = components.second;
    if (repetitions) rows.repetitions = static_cast<std::size_t>(*repetitions);
    rows.seed = run.seed();
    options.jobs = run.jobs();
    if (region) return cli::suggest_target(targets, source.columns(), cli::goal_box(*region), rows, run);
    const Validation validation =
        test.empty()
            ? leave_one_target_out(targets, options)
            : judge_on_test_targets(
                  targets, read_test_targets(test, source.columns(), targets, noise_free, run.messages()), options);
    cli::report(validation, run);
    if (table && !table->empty()) cli::write_table(validation, run.beside(*table));
    if (!reliability.empty()) cli::write_reliability(validation, run.beside(reliability));
    table && table->empty() ? cli::write_table(validation, run.output()) : cli::write_scores(validation, run.output());
  });
}
