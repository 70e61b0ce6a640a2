// Fits a Gaussian mixture to the aligned demonstrations of each target (paper eq. (1)-(3), BIC [39]).
#include <fmt/format.h>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/cli/values.hpp"
#include "lfdtools/gmm.hpp"
#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/io/gmm_file.hpp"
#include "lfdtools/io/labelled_table.hpp"

using namespace lfd;

namespace {

/// Joint samples (t, signals) of a pool, and the means of the measured ends.
Samples pool_samples(const Pool& pool, Eigen::Index D, GmmFile& file) {
  Eigen::Index rows = 0;
  for (const auto& recording : pool.recordings) rows += recording.demonstration.trajectory.samples();
  Samples pooled(rows, 1 + D);
  file.start = Vector::Zero(D);
  file.goal = Vector::Zero(D);
  Eigen::Index row = 0;
  for (const auto& recording : pool.recordings) {
    const Trajectory& trajectory = recording.demonstration.trajectory;
    pooled.middleRows(row, trajectory.samples()) << trajectory.times, trajectory.positions;
    row += trajectory.samples();
    file.start += trajectory.start() / static_cast<double>(pool.recordings.size());
    file.goal += trajectory.goal() / static_cast<double>(pool.recordings.size());
  }
  file.time_range = {pooled.col(0).minCoeff(), pooled.col(0).maxCoeff()};
  return pooled;
}

std::string name(Criterion criterion) {
  return criterion == Criterion::bic ? "BIC" : criterion == Criterion::aic ? "AIC" : "ICL";
}

/// Says what there is to know about a fit.
void report(const ComponentSelection& selection, Criterion criterion, const std::string& who, cli::Run& run) {
  const Eigen::Index K = selection.fit.gmm.components();
  for (const Selection& row : selection.table) {
    run.detail("gmm.selection",
               fmt::format("{}: {} components: logL {:.1f}, q {}, entropy {:.1f}, BIC {:.1f}, AIC {:.1f}, ICL {:.1f}{}",
                           who, row.k, row.log_likelihood, row.parameters, row.entropy, row.bic, row.aic, row.icl,
                           row.k == K ? ", chosen by " + name(criterion) : ""));
  }
  if (selection.at_edge) {
    run.messages().warning(
        "gmm.edge", fmt::format("{}: {} chose {} components, at the edge of the range", who, name(criterion), K));
  }
  if (!selection.fit.converged) {
    run.messages().warning("gmm.not_converged",
                           fmt::format("{}: EM stopped after {} iterations", who, selection.fit.iterations));
  }
  for (const auto& collapse : selection.fit.collapses) {
    run.messages().note("gmm.collapse",
                        fmt::format("{}: component {} had collapsed and was started again (iteration {})", who,
                                    collapse.component + 1, collapse.iteration));
  }
}

}  // namespace

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
      GmmFile file;
      const Samples pooled = pool_samples(pool, static_cast<Eigen::Index>(source.columns().size()), file);
      ComponentSelection selection = select_components(pooled, components.first, components.second, criterion, options);
      report(selection, criterion.criterion, describe(pool.labels), run);
      if (criterion.likelihood == Likelihood::effective && selection.bic_n > static_cast<double>(pooled.rows())) {
        run.messages().warning("gmm.bic_n", fmt::format("{}: {} effective samples of {}", describe(pool.labels),
                                                        selection.bic_n, pooled.rows()));
      }
      run.figure("most_components", static_cast<double>(selection.fit.gmm.components()));
      file.header = {joined({"t"}, source.columns()), pool.labels, {entry}};
      file.gmm = std::move(selection.fit.gmm);
      file.regularization = selection.fit.regularization;
      file.log_likelihood = selection.fit.log_likelihood;
      file.covariance_type = options.covariance_type;
      file.criterion = criterion.criterion;
      file.likelihood = criterion.likelihood;
      file.bic = selection.fit.bic;
      file.aic = selection.fit.aic;
      file.icl = selection.fit.icl;
      file.parameters = selection.fit.parameters;
      file.entropy = selection.fit.entropy;
      file.samples = selection.fit.samples;
      file.bic_n = selection.bic_n;
      file.iterations = selection.fit.iterations;
      file.converged = selection.fit.converged;
      file.selection = std::move(selection.table);
      write_gmm(file, run.output());
    }
  });
}
