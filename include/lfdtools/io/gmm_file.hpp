// Mixture models as files, format lfdtools.gmm.
#pragma once

#include <array>
#include <vector>

#include "lfdtools/gmm.hpp"
#include "lfdtools/io/provenance.hpp"

namespace lfd {

/// A mixture over (t, signals), how it was fitted, and what else regression needs. All in the units of the data.
struct GmmFile {
  FileHeader header;  ///< columns: t, then D signals
  CovarianceType covariance_type = CovarianceType::full;
  Gmm gmm;                                      ///< over D + 1 dimensions
  Vector regularization;                        ///< D + 1, variance added to each diagonal in every M step
  double log_likelihood = 0;                    ///< sum over the samples [nats]
  Criterion criterion = Criterion::bic;         ///< what chose K
  Likelihood likelihood = Likelihood::samples;  ///< what bic, aic and icl take the samples for
  double bic = 0;                               ///< with bic_n
  double aic = 0;
  double icl = 0;               ///< with bic_n
  Eigen::Index parameters = 0;  ///< q
  double entropy = 0;           ///< of the responsibilities [nats]
  Eigen::Index samples = 0;     ///< N
  double bic_n = 0;             ///< the n used in BIC and ICL
  Eigen::Index iterations = 0;  ///< of EM
  bool converged = false;
  std::array<double, 2> time_range{};  ///< first and last time of the data [s]
  Vector start;                        ///< D, mean of the measured starts
  Vector goal;                         ///< D, mean of the measured ends
  std::vector<Selection> selection;    ///< all K tried
};

/// At most 10 000 components and 1000 columns. What regression does not need (covariance_type, regularization, and all
/// about the likelihood and the choice of K) may be missing.
/// @throws as JsonView, with the pointer; [gmm.priors] (negative, or a sum off 1 by more than 1e-9),
/// [gmm.not_symmetric],
///         [gmm.not_positive_definite], [gmm.covariance_type] for covariances that are none of the type
[[nodiscard]] GmmFile read_gmm(const JsonDocument& document);

/// What a fit says of itself; header, time_range, start and goal are left for those who know the data.
[[nodiscard]] GmmFile gmm_file(ComponentSelection selection, const CriterionOptions& criterion, CovarianceType type);

/// One line.
void write_gmm(const GmmFile& file, Output& out);

}  // namespace lfd
