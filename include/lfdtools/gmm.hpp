// Gaussian mixture models: encoding the demonstrations of a target, paper eq. (1)-(3).
#pragma once

#include <cstdint>
#include <vector>

#include "lfdtools/criteria.hpp"
#include "lfdtools/linalg.hpp"

namespace lfd {

/// A mixture of K Gaussians in D dimensions, paper eq. (1)-(3). For regression the first dimension is the time [s].
struct Gmm {
  Vector priors;                    ///< pi_k, K, not negative, sum 1
  Samples means;                    ///< mu_k, K x D
  std::vector<Matrix> covariances;  ///< Sigma_k, K of D x D, symmetric positive definite

  [[nodiscard]] Eigen::Index components() const { return priors.size(); }
  [[nodiscard]] Eigen::Index dimensions() const { return means.cols(); }
};

/// @throws DataError [gmm.shape] if the parts disagree in size or are empty, [gmm.not_finite], [gmm.priors] if a prior
/// is
///         negative or the sum is off 1 by more than 1e-6, [gmm.not_symmetric] (beyond rounding),
///         [gmm.not_positive_definite]; the place is the JSON pointer of the fault
void check(const Gmm& gmm);

/// ln p(x_i) = ln sum_k pi_k N(x_i; mu_k, Sigma_k) of each sample, paper eq. (1)-(2), by log-sum-exp.
/// @param samples  N x D   @return N
/// @throws DataError as check(gmm), [gmm.shape], [gmm.not_finite]
[[nodiscard]] Vector log_densities(const Gmm& gmm, const Samples& samples);

/// Sum over the samples of ln p(x_i) [nats], in the units of the samples. Errors as log_densities.
[[nodiscard]] double log_likelihood(const Gmm& gmm, const Samples& samples);

/// p(k | x_i), N x K; the rows sum to 1. Errors as log_densities.
[[nodiscard]] Samples responsibilities(const Gmm& gmm, const Samples& samples);

/// Entropy of the responsibilities, -sum_i sum_k p(k | x_i) ln p(k | x_i) [nats], between 0 (every sample belongs to
/// one component) and N ln K. Errors as log_densities; [gmm.out_of_range] for a sample too far from the mixture.
[[nodiscard]] double responsibility_entropy(const Gmm& gmm, const Samples& samples);

struct EmOptions {
  Eigen::Index components = 4;                            ///< K
  CovarianceType covariance_type = CovarianceType::full;  ///< which covariances are allowed
  int restarts = 5;              ///< starts tried; all run a few iterations, the best runs to convergence
  std::uint64_t seed = 1;        ///< of the starts
  double regularization = 1e-6;  ///< variance added to each diagonal, as a share of the column's variance; 0 is allowed
  int max_iterations = 1000;     ///< EM iterations of the winner
  double tolerance = 1e-6;       ///< converged when an iteration gains less than this [nats a sample]
  unsigned jobs = 1;             ///< threads; 0: one a processor; the result does not depend on it
};

/// A component that held fewer than D+1 samples (diagonal, spherical: 2), had shrunk to the regularisation in a column
/// that varies, or was singular: it was started again at a sample that the mixture explained badly. At most K times in
/// a run; a start that ends without such components is preferred to one that has them, whatever the likelihood.
struct Collapse {
  int iteration = 0;           ///< EM iteration, from 1, after which it was re-seeded
  Eigen::Index component = 0;  ///< from 0
  double samples = 0;          ///< what it held: sum of its responsibilities
};

/// A fitted mixture. The status stands beside the model: EM that has not converged is no error.
struct GmmFit {
  Gmm gmm;                      ///< in the units of the samples
  double log_likelihood = 0;    ///< of `gmm`, sum over the samples [nats]
  double entropy = 0;           ///< of the responsibilities [nats]
  Eigen::Index parameters = 0;  ///< q
  double bic = 0;               ///< of n = N, or as select_components was asked; so aic and icl
  double aic = 0;
  double icl = 0;
  Eigen::Index samples = 0;  ///< N
  int iterations = 0;        ///< EM iterations of the winner
  bool converged = false;    ///< the last gain was under the tolerance
  int restart = 0;           ///< the start that won, from 0
  Vector regularization;     ///< D, variance added to each diagonal in every M step, units of the samples squared
  /// Objective before each iteration and at the end (iterations + 1 values): the log-likelihood with each component's
  /// density multiplied by exp(-1/2 tr(Sigma_k^-1 R)), R the diagonal of `regularization`. Adding R in the M step
  /// maximises exactly this, so it never falls, but at a re-seeding (`collapses`). Without R it is the log-likelihood.
  std::vector<double> history;
  std::vector<Collapse> collapses;  ///< re-seedings of the winner, in order
};

/// Fits a mixture by k-means++, Lloyd's iterations and EM on standardised columns. The result does not depend on the
/// order of the samples, nor, but for rounding, on the units of the columns. A column that is constant keeps its unit
/// as scale, and a variance of at least 1e-12 is added to it.
/// @param samples  N x D
/// @throws UsageError [gmm.option] for an option out of its range
/// @throws DataError [gmm.too_few_samples] if N < K, [gmm.shape] without columns, [gmm.not_finite],
///         [gmm.too_many_columns] above 64, [gmm.out_of_range] if a column's variance overflows, [gmm.singular] if no
///         start ends with positive definite covariances (possible only with a regularisation of nearly 0)
[[nodiscard]] GmmFit fit_gmm(const Samples& samples, const EmOptions& options);

/// One row of the table from which K was chosen.
struct Selection {
  Eigen::Index k = 0;
  double log_likelihood = 0;
  double bic = 0;  ///< as select_components was asked; so aic and icl
  double aic = 0;
  double icl = 0;
  Eigen::Index parameters = 0;  ///< q
  double entropy = 0;           ///< of the responsibilities [nats]
};

struct ComponentSelection {
  GmmFit fit;                    ///< of the K that the criterion chooses; its bic, aic, icl are the table's
  std::vector<Selection> table;  ///< k_from .. k_to
  double bic_n = 0;              ///< the n used in BIC and ICL
  bool at_edge = false;          ///< K is an end of the range (other than 1), so a wider range could choose another
};

/// Fits every K in [k_from, k_to] and takes the K of the least criterion. Samples of a smooth motion are far from
/// independent, so that a likelihood of all of them keeps asking for more components as the sampling rate grows:
/// Likelihood::effective with a bic_n of one's own does not.
/// @throws as fit_gmm; UsageError [gmm.option] also for an empty range or a bad bic_n
[[nodiscard]] ComponentSelection select_components(const Samples& samples, Eigen::Index k_from, Eigen::Index k_to,
                                                   const CriterionOptions& criterion, const EmOptions& options);

}  // namespace lfd
