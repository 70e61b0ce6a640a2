// Gaussian mixture regression: one reference path a target (paper eq. (4)-(7)).
#include <set>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/gmr.hpp"
#include "lfdtools/io/gmm_file.hpp"
#include "lfdtools/io/labelled_table.hpp"

using namespace lfd;

namespace {

/// Names of the upper triangle of a covariance over the signals.
std::vector<std::string> covariance_names(const std::vector<std::string>& signals) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (std::size_t j = i; j < signals.size(); ++j) names.push_back("cov_" + signals[i] + "_" + signals[j]);
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  std::int64_t samples = 200;
  bool sd = false;
  bool covariance = false;
  bool derivatives = false;
  cli::Program program("gmr-regress", "Regress one reference path from each Gaussian mixture.");
  program.reads("GMM JSON");
  program.integer("-n,--samples", samples, {2, 10'000'000}, "samples of a reference");
  program.flag("--sd", sd, "add columns sd_: standard deviation of each signal");
  program.flag("--covariance", covariance, "add columns cov_: upper triangle of the covariance");
  program.flag("--derivatives", derivatives, "add columns d_: time derivative of the mean, in closed form");
  program.example("gmm-fit aligned.csv | gmr-regress --sd -o reference.csv", "references with their spread");
  return program.run(argc, argv, [&](cli::Run& run) {
    JsonStream stream(run.open(), run.messages(), run.json_options());
    std::optional<LabelledTable> table;
    std::vector<std::string> first_signals;
    std::set<std::string> seen;
    while (auto document = stream.next()) {
      const GmmFile file = read_gmm(*document);
      const std::vector<std::string> signals(file.header.columns.begin() + 1, file.header.columns.end());
      if (!table) {
        first_signals = signals;
        auto columns = joined(joined(joined({"t"}, signals), prefixed("start_", signals)), prefixed("goal_", signals));
        if (sd) columns = joined(columns, prefixed("sd_", signals));
        if (covariance) columns = joined(columns, covariance_names(signals));
        if (derivatives) columns = joined(columns, prefixed("d_", signals));
        table.emplace(run.output(), columns);
      } else if (signals != first_signals) {
        document->root().at("columns").fail("gmr.columns_differ", "the mixtures are over different signals");
      }
      if (!seen.insert(describe(file.header.labels)).second) {
        document->root().fail("json.group_reappears", "a second mixture of the same target and teacher");
      }
      const Vector times = linspace(file.time_range[0], file.time_range[1], samples);
      const GmrPath path = gmr(file.gmm, times, {sd || covariance, derivatives});
      const auto D = static_cast<Eigen::Index>(signals.size());
      Samples rows = beside(times, path.mean);
      rows = beside(rows, file.start.transpose().replicate(samples, 1));
      rows = beside(rows, file.goal.transpose().replicate(samples, 1));
      if (sd) {
        Samples spread(samples, D);
        for (Eigen::Index i = 0; i < samples; ++i)
          spread.row(i) = path.covariance[i].diagonal().cwiseSqrt().transpose();
        rows = beside(rows, spread);
      }
      if (covariance) {
        Samples upper(samples, D * (D + 1) / 2);
        for (Eigen::Index i = 0; i < samples; ++i) {
          for (Eigen::Index a = 0, k = 0; a < D; ++a) {
            for (Eigen::Index b = a; b < D; ++b) upper(i, k++) = path.covariance[i](a, b);
          }
        }
        rows = beside(rows, upper);
      }
      if (derivatives) rows = beside(rows, path.derivative);
      table->write(file.header.labels, rows);
    }
  });
}
