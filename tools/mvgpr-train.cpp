// Learns a skill: weights as a function of goal - start (paper eq. (15)-(27)).
#include "lfdtools/cli/program.hpp"
#include "lfdtools/cli/training.hpp"
#include "lfdtools/io/skill_file.hpp"
#include "lfdtools/io/training_rows.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  cli::TrainingRequest request;
  SkillOptions& options = request.options;
  std::int64_t starts = options.starts;
  cli::Program program("mvgpr-train", "Learn a skill: movement primitives whose weights follow the target.");
  program.reads("DMP JSON of several targets").uses_jobs().uses_seed();
  program.flag("--paper", options.paper,
               "the published process: a model an axis, zero mean, se-ard, plain weights (see --model for Table 1)");
  program.choice("--model", options.structure,
                 {{"auto", SkillStructure::automatic},
                  {"axis", SkillStructure::axis},
                  {"full", SkillStructure::full},
                  {"joint", SkillStructure::joint}},
                 "what speaks for what: each axis for itself, all for each axis (Table 1), all for all");
  program.choice("--inputs", options.inputs,
                 {{"auto", SkillInputs::automatic},
                  {"change", SkillInputs::change},
                  {"change+start", SkillInputs::change_and_start}},
                 "goal - start alone, or the start as well; auto: as well where starts differ by over 20 mm, but not "
                 "with --paper");
  program.choice("--kernel", options.kernel,
                 {{"auto", SkillKernel::automatic},
                  {"sum", SkillKernel::sum},
                  {"additive", SkillKernel::additive},
                  {"se-ard", SkillKernel::se_ard},
                  {"matern32", SkillKernel::matern32},
                  {"matern52", SkillKernel::matern52}},
                 "covariance function; sum: constant + linear + matern32 an input + se-ard "
                 "over goal - start; additive: without the last; auto: of these the one with the smaller error on "
                 "targets left out, but se-ard with --paper");
  program.choice("--mean", options.mean,
                 {{"auto", SkillMean::automatic},
                  {"zero", SkillMean::zero},
                  {"constant", SkillMean::constant},
                  {"linear", SkillMean::linear},
                  {"line", SkillMean::line}},
                 "mean function; line (auto, but zero with --paper): the straight minimum-jerk motion");
  program.choice(
      "--tempo", options.tempo,
      {{"auto", SkillTempo::automatic}, {"own", SkillTempo::own}, {"shared", SkillTempo::shared}},
      "draw how early or late each target's rows are towards all targets' (shared: auto, but own with --paper "
      "and scaling goal), or take them as they are");
  program.choice(
      "--teachers", options.teachers,
      {{"auto", SkillTeachers::automatic}, {"together", SkillTeachers::together}, {"apart", SkillTeachers::apart}},
      "what all teachers share and each one's own part on top (auto: where two or more are named), or as if "
      "one had demonstrated all");
  program.choice("--omega", options.omega, {{"integrated", OmegaRule::integrated}, {"ml", OmegaRule::ml}},
                 "covariance between weights: integrated out, or free (needs more rows than weights)");
  program.choice("--process", options.process,
                 {{"gaussian", ProcessType::gaussian}, {"student-t", ProcessType::student_t}},
                 "multivariate Gaussian process, or Student-t: degrees of freedom found with the others");
  program.check([&] {
    if (options.process == ProcessType::student_t && options.omega == OmegaRule::ml) {
      throw UsageError("usage.exclusive", "--process student-t has its Omega integrated; without --omega ml");
    }
    if (options.paper && request.way) throw UsageError("usage.exclusive", "--paper looks for no ways round");
  });
  program.choice("--calibration", request.calibrated, {{"targets", true}, {"none", false}},
                 "scale the bands by what is missed on targets left out in turn, or trust the process");
  program.flag("--leave-out-outliers", request.leave_out_outliers,
               "leave out rows that are far from what other targets say of them");
  program.integer("--way", request.way, {1, 2}, "learn one of two ways round alone: 1 is that of the first primitive");
  program.gate("two_ways", "demonstrations of a target that go two ways round: their mean goes neither");
  program.integer("--starts", starts, {1, 1000}, "starts of the hyperparameter search");
  program.example("dmp-fit demos.csv | mvgpr-train -o skill.json", "every recording a row, in its own clock");
  program.example("dmp-fit reference.csv | mvgpr-train -o skill.json", "one row a target");
  program.example("dmp-fit --paper reference.csv | mvgpr-train --paper --model full",
                  "Table 1 of the paper, literally");
  return program.run(argc, argv, [&](cli::Run& run) {
    options.starts = static_cast<int>(starts);
    options.seed = run.seed();
    options.jobs = run.jobs();
    JsonStream stream(run.open(), run.messages(), run.json_options());
    TrainingRows training = read_training_rows(stream);
    SkillFile file{training.header, cli::learn(training.header.columns, training.rows, request, run)};
    file.header.provenance = append(file.header.provenance, run.provenance(stream.sha256()));
    double evidence = 0;
    for (const auto& model : file.skill.models) evidence += model.process.log_marginal_likelihood;
    run.figure("rows", static_cast<double>(file.skill.rows.size()));
    run.figure("log_marginal_likelihood", evidence);
    write_skill(file, run.output());
  });
}
