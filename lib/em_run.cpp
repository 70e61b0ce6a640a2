#include "lfdtools/em_run.hpp"

#include <algorithm>
#include <numeric>

#include "lfdtools/em.hpp"

namespace lfd {
namespace {

using Eigen::Index;

constexpr double least_variance = 1e-12;  // less, along some direction, counts as singular

enum class Health { sound, thin, singular };

/// @param varies  D, zero for a constant column
Health health(const EmStep& step, Index k, const Vector& varies, const Vector& regularization, CovarianceType type) {
  const Matrix& Sigma = step.gmm.covariances[static_cast<std::size_t>(k)];
  if (regularization.minCoeff() < 1e-9) {  // more keeps every covariance positive definite in spite of rounding
    Matrix L;
    if (!try_cholesky(Sigma, L) || L.diagonal().cwiseAbs2().minCoeff() < 0.5 * least_variance) return Health::singular;
  }
  if (step.gmm.components() == 1) return Health::sound;
  const auto D = static_cast<double>(Sigma.rows());
  const double needed = type == CovarianceType::full ? D + 1.0 : type == CovarianceType::tied ? 1.0 : 2.0;
  if (step.counts[k] < needed) return Health::thin;
  for (Index j = 0; j < Sigma.rows(); ++j) {
    if (varies[j] != 0.0 && Sigma(j, j) <= 2.0 * regularization[j]) return Health::thin;
  }
  return Health::sound;
}

/// Starts component k again at a badly explained sample, as wide as the components are on average, or as it is where
/// all share a sound covariance.
void reseed(const Matrix& samples, const Gmm& before, Index k, std::size_t rank, bool shared, Gmm& gmm) {
  const Vector density = log_densities(before, samples);
  std::vector<Index> order(static_cast<std::size_t>(density.size()));
  std::iota(order.begin(), order.end(), Index{0});
  // One sample further up each time, so that a lone outlier does not catch every attempt.
  rank = std::min(rank, order.size() - 1);
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(rank), order.end(),
                   [&](Index a, Index b) { return density[a] != density[b] ? density[a] < density[b] : a < b; });
  const auto K = static_cast<double>(gmm.components());
  Matrix Sigma = Matrix::Zero(samples.cols(), samples.cols());
  for (Index other = 0; other < gmm.components(); ++other) {
    Sigma += before.priors[other] * before.covariances[static_cast<std::size_t>(other)];
  }
  gmm.means.row(k) = samples.row(order[rank]);
  if (!shared) gmm.covariances[static_cast<std::size_t>(k)] = Sigma;
  gmm.priors[k] = 0.0;
  gmm.priors *= (1.0 - 1.0 / K) / gmm.priors.sum();
  gmm.priors[k] = 1.0 / K;
}

}  // namespace

void advance(const Matrix& samples, const Vector& regularization, const EmOptions& options, int until, unsigned jobs,
             EmRun& run) {
  const double least_gain = options.tolerance * static_cast<double>(samples.rows());
  const Index K = run.gmm.components();
  const Vector varies = samples.colwise().squaredNorm().transpose();
  if (!run.history.empty()) run.history.pop_back();  // evaluated again below
  while (!run.failed && !run.converged) {
    EmStep step = em_step(run.gmm, samples, regularization, options.covariance_type, jobs);
    const bool reseeded = !run.collapses.empty() && run.collapses.back().iteration == run.iterations;
    run.converged = !run.history.empty() && !reseeded && step.objective - run.history.back() < least_gain;
    run.history.push_back(step.objective);
    if (run.converged || run.iterations >= until) return;
    ++run.iterations;
    run.thin = 0;
    for (Index k = 0; k < K; ++k) {
      const Health state = health(step, k, varies, regularization, options.covariance_type);
      if (state == Health::sound) continue;
      if (K > 1 && static_cast<Index>(run.collapses.size()) < K) {
        const bool shared = options.covariance_type == CovarianceType::tied && state == Health::thin;
        reseed(samples, run.gmm, k, run.collapses.size(), shared, step.gmm);
        run.collapses.push_back({run.iterations, k, step.counts[k]});
      } else if (state == Health::singular) {
        run.failed = true;
      } else {
        ++run.thin;
      }
    }
    run.gmm = step.gmm;
  }
}

}  // namespace lfd
