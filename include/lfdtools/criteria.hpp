// Information criteria for the number of components of a mixture: BIC [39], AIC, ICL.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

/// Which covariances a fit may choose. After each, mclust's name.
enum class CovarianceType {
  full,      ///< each component its own (VVV)
  tied,      ///< one shared by all (EEE)
  diagonal,  ///< each its own, without correlations (VVI)
  spherical  ///< each one variance for all standardised columns (VII of those): diagonal in the units of the samples
};

/// Number of free parameters q of a mixture: K-1 priors, K D means and the covariances, which are K D (D+1) / 2 (full),
/// D (D+1) / 2 (tied), K D (diagonal) or K (spherical).
/// @param components  K   @param dimensions  D, the time among them
[[nodiscard]] Eigen::Index free_parameters(Eigen::Index components, Eigen::Index dimensions,
                                           CovarianceType type = CovarianceType::full);

/// -2 logL + q ln n. Smaller is better.
[[nodiscard]] double bic(double log_likelihood, Eigen::Index q, double n);

/// -2 logL + 2 q. Smaller is better.
[[nodiscard]] double aic(double log_likelihood, Eigen::Index q);

/// BIC + 2 E, E the entropy of the responsibilities (gmm.hpp): the BIC of the samples together with the component that
/// each came from, so that components which share samples are paid for. Biernacki, Celeux, Govaert, IEEE Trans. PAMI 22
/// (2000) 719-725, there with each sample given to its likeliest component; with the responsibilities themselves, as
/// here, McLachlan and Peel, Finite Mixture Models (2000). Smaller is better.
[[nodiscard]] double icl(double log_likelihood, Eigen::Index q, double n, double entropy);

enum class Criterion { bic, aic, icl };

/// How much the criteria take the samples for.
enum class Likelihood {
  samples,   ///< the likelihood of all samples, as if they were independent: only the penalty of BIC and ICL has n
  effective  ///< of n samples that say as much as these do on average: logL and E are multiplied by n / N
};

struct CriterionOptions {
  Criterion criterion = Criterion::bic;         ///< chooses K
  double bic_n = 0;                             ///< n, above 1; 0: N, the number of samples
  Likelihood likelihood = Likelihood::samples;  ///< effective needs bic_n to differ from samples
};

/// What the criteria say of one mixture.
struct Criteria {
  double bic = 0;
  double aic = 0;
  double icl = 0;

  [[nodiscard]] double of(Criterion criterion) const;
};

/// @param log_likelihood  sum over the samples [nats]   @param entropy  E [nats]
/// @param q        free_parameters
/// @param samples  N
[[nodiscard]] Criteria criteria(double log_likelihood, double entropy, Eigen::Index q, Eigen::Index samples,
                                const CriterionOptions& options = {});

}  // namespace lfd
