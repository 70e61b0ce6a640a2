// Fits a Gaussian mixture to the aligned demonstrations of each target (paper eq. (1)-(3), BIC [39]).
#include "lfdtools/cli/mixture_report.hpp"
#include "lfdtools/cli/program.hpp"
#include "lfdtools/cli/values.hpp"
#include "lfdtools/io/gmm_file.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/pooled_samples.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  EmOptions options;
  CriterionOptions criterion;
  std::pair<std::int64_t, std::int64_t> components{1, 12};
  std::int64_t restarts = options.restarts;
  std::string bic_n = "samples";
  cli::Program program("gmm-fit", "Fit a Gaussian mixture to the aligned demonstrations of each target.");
  program.reads("aligned demonstrations CSV").uses_jobs().uses_seed().uses_columns();
  program.integer_range("-k,--components", components, {1, 10'000},
                        "components, or the range that --select chooses from");
  program.choice("--covariance-type", options.covariance_type,
                 {{"full", CovarianceType::full},
                  {"tied", CovarianceType::tied},
                  {"diagonal", CovarianceType::diagonal},
                  {"spherical", CovarianceType::spherical}},
                 "each its own, one for all, no correlations, or one variance for all standardised columns");
  program.choice("--select", criterion.criterion,
                 {{"bic", Criterion::bic}, {"aic", Criterion::aic}, {"icl", Criterion::icl}},
                 "what chooses the number of components");
  program.text("--bic-n", bic_n, "n in BIC = -2 logL + q ln n: samples, or a number");
  program.choice("--bic-likelihood", criterion.likelihood,
                 {{"samples", Likelihood::samples}, {"effective", Likelihood::effective}},
                 "effective: logL too counts the samples as the n of --bic-n");
  program.integer("--restarts", restarts, {1, 10'000}, "starts tried for each number of components");
  program.example("demo-align demos.csv | gmm-fit -k 4 -o gmm.json", "four components, as in the paper's figure 3");
  program.example("gmm-fit --bic-n 200 --bic-likelihood effective aligned.csv",
                  "choose by BIC as if the samples were 200 independent ones, whatever their rate");
  program.check([&] {
    if (bic_n != "samples") criterion.bic_n = cli::positive_number("--bic-n", bic_n);
    if (criterion.likelihood == Likelihood::effective && criterion.bic_n == 0) {
      throw UsageError("usage.missing", "--bic-likelihood effective needs a number for --bic-n");
    }
  });
  return program.run(argc, argv, [&](cli::Run& run) {
    DemonstrationSource source(CsvTable(run.open(), run.messages(), {.renumber = run.options().renumber}),
                               run.messages(), {.columns = run.options().columns});
    options.restarts = static_cast<int>(restarts);
    options.seed = run.seed();
    options.jobs = run.jobs();
    const Provenance entry = run.provenance(source.table().sha256());
    for (std::size_t i = 0; i < source.pools(); ++i) {
      const Pool pool = source.pool(i);
      const PooledSamples pooled(pool);
      ComponentSelection selection =
          select_components(pooled.joint, components.first, components.second, criterion, options);
      cli::report(selection, criterion, describe(pool.labels), run);
      GmmFile file = gmm_file(std::move(selection), criterion, options.covariance_type);
      file.header = {joined({"t"}, source.columns()), pool.labels, {entry}};
      file.time_range = {pooled.joint.col(0).minCoeff(), pooled.joint.col(0).maxCoeff()};
      file.start = pooled.start;
      file.goal = pooled.goal;
      write_gmm(file, run.output());
    }
  });
}
