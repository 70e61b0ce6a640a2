// Leave-one-target-out: how far a skill is from targets that it has not seen, beside simple opponents.
#include <fmt/format.h>

#include <map>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/validation.hpp"

using namespace lfd;

namespace {

void write_scores(const Validation& validation, Output& out) {
  LabelledTable table(out, {"method", "rmse", "end_error", "dtw", "outside", "coverage95", "path95"});
  for (const auto& score : validation.scores) {
    CsvWriter& row = table.begin(score.labels);
    row.labels(score.labels);
    row.text(score.method);
    for (const double value : {score.rmse, score.end_error, score.dtw, score.outside}) row.number(value);
    for (const auto& value : {score.coverage95, score.path95}) value ? row.number(*value) : row.text("");
    row.end_row();
  }
}

/// Methods down, targets across, rmse in millimetres.
void write_table(const Validation& validation, Output& out) {
  std::vector<std::string> targets;
  std::vector<std::string> methods;
  std::map<std::pair<std::string, std::string>, double> rmse;
  for (const auto& score : validation.scores) {
    const std::string target = describe(score.labels).substr(score.labels.teacher ? 0 : 7);
    if (targets.empty() || targets.back() != target) targets.push_back(target);
    if (targets.size() == 1) methods.push_back(score.method);
    rmse[{score.method, target}] = 1e3 * score.rmse;
  }
  std::string line = fmt::format("{:<16}{:>8}", "rmse [mm]", "mean");
  for (const auto& target : targets) line += fmt::format("{:>8}", target);
  out.write(line + "\n");
  for (const auto& method : methods) {
    double sum = 0;
    std::string cells;
    for (const auto& target : targets) {
      sum += rmse[{method, target}];
      cells += fmt::format("{:>8.1f}", rmse[{method, target}]);
    }
    out.write(fmt::format("{:<16}{:>8.1f}{}\n", method, sum / static_cast<double>(targets.size()), cells));
  }
}

}  // namespace

int main(int argc, char** argv) {
  ValidationOptions options;
  std::int64_t bases = options.bases;
  std::pair<std::int64_t, std::int64_t> components{options.k_from, options.k_to};
  bool table = false;
  cli::Program program("skill-validate", "Leave each target out once and generate it from the others.");
  program.reads("demonstrations CSV").uses_jobs().uses_seed().uses_columns();
  program.words("--methods", options.methods, "methods to compare (default: all)");
  program.choice("--road", options.road, {{"demonstrations", Road::demonstrations}, {"references", Road::references}},
                 "rows of the default skill: every demonstration, or one GMM-GMR reference a target");
  program.number_or_default("--trim", options.alignment.trim, default_trim, {0, 1, true},
                            "cut idle ends first, as demo-align does");
  program.integer("-n,--basis", bases, {2, 10'000}, "basis functions");
  program.integer_range("-k,--components", components, {1, 10'000}, "components of the references, chosen by BIC");
  program.flag("--table", table, "a readable table of rmse in millimetres instead of CSV");
  std::vector<std::pair<std::string, std::string>> methods;
  for (const auto& method : validation_methods()) methods.emplace_back(method.name, method.meaning);
  program.topic("Methods", methods);
  program.example("skill-validate demos.csv --table", "every method on every target");
  return program.run(argc, argv, [&](cli::Run& run) {
    DemonstrationSource source(CsvTable(run.open(), run.messages(), {.renumber = run.options().renumber}),
                               run.messages(), {.columns = run.options().columns});
    std::vector<TargetDemonstrations> targets(source.pools());
    for (std::size_t i = 0; i < targets.size(); ++i) {
      Pool pool = source.pool(i);
      targets[i].labels = pool.labels;
      for (auto& recording : pool.recordings)
        targets[i].demonstrations.push_back(std::move(recording.demonstration.trajectory));
    }
    options.bases = bases;
    options.k_from = components.first;
    options.k_to = components.second;
    options.seed = run.seed();
    options.jobs = run.jobs();
    const Validation validation = leave_one_target_out(targets, options);
    if (validation.lifted_gates > 0) {
      run.messages().note("validate.lifted_gate",
                          fmt::format("the gate goal_change of --scaling goal would have refused {} "
                                      "training rows of --paper",
                                      validation.lifted_gates));
    }
    table ? write_table(validation, run.output()) : write_scores(validation, run.output());
  });
}
