#include "lfdtools/cli/mixture_report.hpp"

#include <fmt/format.h>

namespace lfd::cli {
namespace {

const char* name(Criterion criterion) {
  return criterion == Criterion::bic ? "BIC" : criterion == Criterion::aic ? "AIC" : "ICL";
}

}  // namespace

void report(const ComponentSelection& selection, const CriterionOptions& criterion, const std::string& who, Run& run) {
  const GmmFit& fit = selection.fit;
  const Eigen::Index K = fit.gmm.components();
  const char* chooser = name(criterion.criterion);
  for (const Selection& row : selection.table) {
    run.detail("gmm.selection",
               fmt::format("{}: {} components: logL {:.1f}, q {}, entropy {:.1f}, BIC {:.1f}, AIC {:.1f}, ICL {:.1f}{}",
                           who, row.k, row.log_likelihood, row.parameters, row.entropy, row.bic, row.aic, row.icl,
                           row.k == K ? fmt::format(", chosen by {}", chooser) : ""));
  }
  if (selection.at_edge) {
    run.messages().warning("gmm.edge",
                           fmt::format("{}: {} chose {} components, at the edge of the range", who, chooser, K));
  }
  if (!fit.converged) {
    run.messages().warning("gmm.not_converged", fmt::format("{}: EM stopped after {} iterations", who, fit.iterations));
  }
  for (const auto& collapse : fit.collapses) {
    run.messages().note("gmm.collapse",
                        fmt::format("{}: component {} had collapsed and was started again (iteration {})", who,
                                    collapse.component + 1, collapse.iteration));
  }
  if (criterion.likelihood == Likelihood::effective && selection.bic_n > static_cast<double>(fit.samples)) {
    run.messages().warning("gmm.bic_n",
                           fmt::format("{}: {} effective samples of {}", who, selection.bic_n, fit.samples));
  }
  run.figure("most_components", static_cast<double>(K));
}

}  // namespace lfd::cli
