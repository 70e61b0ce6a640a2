// Fitting: standardised columns, starts by k-means, EM with re-seeding, choice of K.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "lfdtools/em.hpp"
#include "lfdtools/em_run.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/gmm.hpp"
#include "lfdtools/kmeans.hpp"
#include "lfdtools/parallel.hpp"
#include "lfdtools/random.hpp"

namespace lfd {
namespace {

using Eigen::Index;

constexpr int start_iterations = 10;      // Lloyd's iterations of a start: EM does the rest
constexpr int first_round = 20;           // EM iterations before half of the starts are given up
constexpr double least_variance = 1e-12;  // regularisation of a constant column
constexpr Index many_samples = 65536;     // from here on the threads share an E step instead of the starts

/// The samples in lexicographic order with each column centred and scaled.
struct Standardised {
  Matrix samples;         // N x D by column
  Vector center, scale;   // D, file units
  Vector regularization;  // D, standardised units
};

Standardised standardise(const Samples& samples, double relative) {
  const Index N = samples.rows();
  const Index D = samples.cols();
  if (D == 0) throw DataError("gmm.shape", "no columns to fit");
  if (!samples.allFinite()) throw DataError("gmm.not_finite", "a sample is not a finite number");
  // Sorted, so that the starts, which draw samples by number, do not depend on the order of the file.
  std::vector<Index> order(static_cast<std::size_t>(N));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const double* x = samples.data() + a * D;
    const double* y = samples.data() + b * D;
    return std::lexicographical_compare(x, x + D, y, y + D);
  });
  Standardised result;
  result.samples.resize(N, D);
  for (Index i = 0; i < N; ++i) result.samples.row(i) = samples.row(order[static_cast<std::size_t>(i)]);
  result.center.resize(D);
  result.scale.resize(D);
  result.regularization.resize(D);
  for (Index j = 0; j < D; ++j) {
    auto x = result.samples.col(j);
    const double first = x[0];
    x.array() -= first;  // exact zeros for a constant column, and less rounding in the mean of others
    const double mean = x.mean();
    x.array() -= mean;
    const double variance = x.squaredNorm() / static_cast<double>(N);
    if (!std::isfinite(variance)) {
      throw DataError("gmm.out_of_range", "the variance of column " + std::to_string(j + 1) + " overflows");
    }
    const bool constant = variance < std::numeric_limits<double>::min();
    result.center[j] = first + mean;
    result.scale[j] = constant ? 1.0 : std::sqrt(variance);
    result.regularization[j] = constant ? std::max(relative, least_variance) : relative;
    if (constant) {
      x.setZero();
    } else {
      x /= result.scale[j];
    }
  }
  return result;
}

Gmm start(const Standardised& data, Index K, CovarianceType type, Random& random) {
  const KMeans clusters = kmeans(data.samples, K, random, start_iterations);
  const Index N = data.samples.rows();
  const Index D = data.samples.cols();
  Gmm gmm{Vector::Zero(K), clusters.centers, std::vector<Matrix>(static_cast<std::size_t>(K), Matrix::Zero(D, D))};
  gmm.means.setZero();
  for (Index i = 0; i < N; ++i) {
    const int k = clusters.labels[static_cast<std::size_t>(i)];
    gmm.priors[k] += 1.0;
    gmm.means.row(k) += data.samples.row(i);
  }
  for (Index k = 0; k < K; ++k) {
    if (gmm.priors[k] > 0.0) {
      gmm.means.row(k) /= gmm.priors[k];
    } else {
      gmm.means.row(k) = clusters.centers.row(k);
    }
  }
  Vector e(D);
  for (Index i = 0; i < N; ++i) {
    const int k = clusters.labels[static_cast<std::size_t>(i)];
    e = (data.samples.row(i) - gmm.means.row(k)).transpose();
    gmm.covariances[static_cast<std::size_t>(k)].noalias() += e * e.transpose();
  }
  const Vector varies = varying_columns(data.samples);
  Matrix within = Matrix::Zero(D, D);
  for (const Matrix& S : gmm.covariances) within += S / static_cast<double>(N);
  for (Index k = 0; k < K; ++k) {
    Matrix& S = gmm.covariances[static_cast<std::size_t>(k)];
    // Too few samples for a covariance of their own, or a shared one: that within all clusters.
    const bool own = type != CovarianceType::tied && gmm.priors[k] >= static_cast<double>(2 * (D + 1));
    S = own ? Matrix(S / gmm.priors[k]) : within;
    // The regularisation, or what keeps a start positive definite where none is wanted.
    S.diagonal() += data.regularization.cwiseMax(1e-6);
    S = constrained(S, type, varies);
  }
  gmm.priors /= static_cast<double>(N);
  return gmm;
}

EmRun best_run(const Standardised& data, const EmOptions& options, unsigned jobs, int& winner) {
  const bool many = data.samples.rows() >= many_samples;
  const unsigned outer = many ? 1U : jobs;
  const unsigned inner = many ? jobs : 1U;
  const auto K = options.components;
  const Random random = Random(options.seed).split(static_cast<std::uint64_t>(K));
  std::vector<EmRun> runs(K == 1 ? 1 : static_cast<std::size_t>(options.restarts));  // K = 1 has one solution
  std::vector<int> left(runs.size());
  std::iota(left.begin(), left.end(), 0);
  parallel_for(runs.size(), outer, [&](std::size_t r) {
    Random mine = random.split(r);
    runs[r].gmm = start(data, K, options.covariance_type, mine);
  });
  for (int until = first_round; left.size() > 1; until *= 2) {
    parallel_for(left.size(), outer, [&](std::size_t i) {
      advance(data.samples, data.regularization, options, std::min(until, options.max_iterations), inner,
              runs[static_cast<std::size_t>(left[i])]);
    });
    // A likelihood earned by a component that has shrunk onto a few values says nothing: those runs come last.
    std::stable_sort(left.begin(), left.end(), [&](int a, int b) {
      const EmRun& first = runs[static_cast<std::size_t>(a)];
      const EmRun& second = runs[static_cast<std::size_t>(b)];
      if (first.thin != second.thin) return first.thin < second.thin;
      return first.objective() > second.objective();
    });
    left.resize((left.size() + 1) / 2);
  }
  winner = left.front();
  EmRun& best = runs[static_cast<std::size_t>(winner)];
  if (!best.converged) advance(data.samples, data.regularization, options, options.max_iterations, inner, best);
  return best;
}

/// Fills in the criteria. @return the one that chooses
double judge(GmmFit& fit, const CriterionOptions& options) {
  const Criteria all = criteria(fit.log_likelihood, fit.entropy, fit.parameters, fit.samples, options);
  fit.bic = all.bic;
  fit.aic = all.aic;
  fit.icl = all.icl;
  return all.of(options.criterion);
}

GmmFit fit(const Samples& samples, const Standardised& data, const EmOptions& options, unsigned jobs) {
  const Index N = samples.rows();
  GmmFit result;
  EmRun run = best_run(data, options, jobs, result.restart);
  if (run.failed) {
    throw DataError("gmm.singular", "every start ended with a singular covariance; a larger regularisation is needed");
  }
  result.gmm = std::move(run.gmm);
  result.gmm.priors /= result.gmm.priors.sum();
  for (Index k = 0; k < result.gmm.components(); ++k) {
    result.gmm.means.row(k) = (result.gmm.means.row(k).transpose().cwiseProduct(data.scale) + data.center).transpose();
    Matrix& Sigma = result.gmm.covariances[static_cast<std::size_t>(k)];
    Sigma = data.scale.asDiagonal() * Sigma * data.scale.asDiagonal();
    Sigma = 0.5 * (Sigma + Sigma.transpose()).eval();
  }
  result.samples = N;
  result.log_likelihood = log_likelihood(result.gmm, samples);
  result.entropy = responsibility_entropy(result.gmm, samples);
  result.parameters = free_parameters(result.gmm.components(), samples.cols(), options.covariance_type);
  judge(result, {});
  result.iterations = run.iterations;
  result.converged = run.converged;
  result.regularization = data.regularization.cwiseProduct(data.scale.cwiseAbs2());
  const double log_volume = static_cast<double>(N) * data.scale.array().log().sum();
  for (double& objective : run.history) objective -= log_volume;
  result.history = std::move(run.history);
  result.collapses = std::move(run.collapses);
  return result;
}

void check(const Samples& samples, Index K, const EmOptions& options) {
  const bool good = K >= 1 && options.restarts >= 1 && options.max_iterations >= 1 && options.tolerance >= 0.0 &&
                    std::isfinite(options.tolerance) && options.regularization >= 0.0 &&
                    std::isfinite(options.regularization);
  if (!good) {
    throw UsageError("gmm.option",
                     "components, restarts and iterations must be at least 1, tolerance and regularisation at least 0");
  }
  if (samples.rows() < K) {
    throw DataError("gmm.too_few_samples",
                    std::to_string(K) + " components for " + std::to_string(samples.rows()) + " samples");
  }
}

}  // namespace

GmmFit fit_gmm(const Samples& samples, const EmOptions& options) {
  check(samples, options.components, options);
  return fit(samples, standardise(samples, options.regularization), options, options.jobs);
}

ComponentSelection select_components(const Samples& samples, Index k_from, Index k_to,
                                     const CriterionOptions& criterion, const EmOptions& options) {
  const double bic_n = criterion.bic_n;
  if (k_from < 1 || k_to < k_from || bic_n < 0.0 || !std::isfinite(bic_n) || (bic_n > 0.0 && bic_n <= 1.0)) {
    throw UsageError("gmm.option",
                     "the numbers of components must rise from at least 1, and the n of the BIC exceed 1");
  }
  check(samples, k_to, options);
  const Standardised data = standardise(samples, options.regularization);
  const auto count = static_cast<std::size_t>(k_to - k_from + 1);
  const bool many = samples.rows() >= many_samples;
  std::vector<GmmFit> fits(count);
  parallel_for(count, many ? 1U : options.jobs, [&](std::size_t i) {
    EmOptions mine = options;
    mine.components = k_to - static_cast<Index>(i);  // the longest first
    fits[count - 1 - i] = fit(samples, data, mine, many ? options.jobs : 1U);
  });
  ComponentSelection result;
  result.bic_n = bic_n > 0.0 ? bic_n : static_cast<double>(samples.rows());
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    GmmFit& one = fits[i];
    const double value = judge(one, criterion);
    result.table.push_back(
        {one.gmm.components(), one.log_likelihood, one.bic, one.aic, one.icl, one.parameters, one.entropy});
    if (value < least) {
      least = value;
      best = i;
    }
  }
  result.fit = std::move(fits[best]);
  const Index k = result.fit.gmm.components();
  result.at_edge = k_to > k_from && (k == k_to || (k == k_from && k > 1));
  return result;
}

}  // namespace lfd
