#include "lfdtools/gmr.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/lanes.hpp"

namespace lfd {
namespace {

using Eigen::Index;

constexpr int gmr_max_signals = 63;

/// What does not depend on the query, for each component in a row: ln(pi_k / sqrt(2 pi Sigma_k^t)), mu_k^t,
/// 1 / sqrt(Sigma_k^t), mu_k^s (D), slope Sigma_k^st / Sigma_k^t (D), lower triangle of Sigma^_k of (6) row by row.
struct GmrModel {
  int components = 0;
  int signals = 0;  // D
  std::vector<double> parameters;

  [[nodiscard]] int stride() const { return 3 + 2 * signals + signals * (signals + 1) / 2; }
};

/// Where the results go, row by row; null: not asked for.
struct GmrOutput {
  double* mean = nullptr;        // T x D
  double* covariance = nullptr;  // T x D x D
  double* derivative = nullptr;  // T x D
};

#define LFD_KERNEL "gmr_kernel.inc"
#include "widths.inc"

void regress(int width, const GmrModel& model, const Vector& times, const GmrOutput& out) {
#ifdef LFD_X86_WIDTHS
  if (width == 8) return width8::regress(model, times.data(), times.size(), out);
  if (width == 4) return width4::regress(model, times.data(), times.size(), out);
#endif
  width2::regress(model, times.data(), times.size(), out);
}

GmrModel prepare(const Gmm& gmm) {
  const Index D = gmm.dimensions() - 1;
  GmrModel model;
  model.components = static_cast<int>(gmm.components());
  model.signals = static_cast<int>(D);
  auto& p = model.parameters;
  for (Index k = 0; k < gmm.components(); ++k) {
    const Matrix& Sigma = gmm.covariances[static_cast<std::size_t>(k)];
    const double Sigma_t = Sigma(0, 0);
    // A prior of 0 takes no part; the least double keeps its logarithm finite.
    const double pi_k = std::max(gmm.priors[k], std::numeric_limits<double>::min());
    p.push_back(std::log(pi_k) - 0.5 * (log_2pi + std::log(Sigma_t)));
    p.push_back(gmm.means(k, 0));
    p.push_back(1.0 / std::sqrt(Sigma_t));
    for (Index a = 1; a <= D; ++a) p.push_back(gmm.means(k, a));
    for (Index a = 1; a <= D; ++a) p.push_back(Sigma(a, 0) / Sigma_t);
    for (Index a = 1; a <= D; ++a) {
      for (Index b = 1; b <= a; ++b) p.push_back(Sigma(a, b) - Sigma(a, 0) * (Sigma(b, 0) / Sigma_t));
    }
  }
  return model;
}

void check(const Gmm& gmm, const Vector& times) {
  check(gmm);
  if (gmm.dimensions() < 2 || gmm.dimensions() > gmr_max_signals + 1) {
    throw DataError("gmr.shape", "regression needs the time and 1 to " + std::to_string(gmr_max_signals) +
                                     " signals, the mixture has " + std::to_string(gmm.dimensions()) + " dimensions");
  }
  if (!times.allFinite()) throw DataError("gmr.not_finite", "a query time is not a finite number");
  for (Index k = 0; k < gmm.components() && times.size() > 0; ++k) {
    const double sd = std::sqrt(gmm.covariances[static_cast<std::size_t>(k)](0, 0));
    const double mu = gmm.means(k, 0);
    const double u = std::max(times.maxCoeff() - mu, mu - times.minCoeff()) / sd;
    if (!std::isfinite(u * u / sd)) {
      throw DataError("gmr.out_of_range", "a query time is too far from the mixture");
    }
  }
}

}  // namespace

GmrPath gmr(const Gmm& gmm, const Vector& times, const GmrOptions& options) {
  const auto widths = vector_widths();
  const int width = options.vector_width == 0 ? widths.back() : options.vector_width;
  if (std::find(widths.begin(), widths.end(), width) == widths.end()) {
    throw UsageError("gmr.vector_width", "this processor has no vectors of that width");
  }
  check(gmm, times);
  const Index T = times.size();
  const Index D = gmm.dimensions() - 1;
  GmrPath path;
  path.times = times;
  path.mean.resize(T, D);
  if (options.covariance) path.covariance = CovarianceList(T, D);
  if (options.derivative) path.derivative.resize(T, D);
  if (T == 0) return path;
  regress(width, prepare(gmm), times,
          {path.mean.data(), options.covariance ? path.covariance[0].data() : nullptr,
           options.derivative ? path.derivative.data() : nullptr});
  const bool finite =
      path.mean.allFinite() && path.derivative.allFinite() &&
      (!options.covariance || Eigen::Map<const Vector>(path.covariance[0].data(), T * D * D).allFinite());
  if (!finite) throw DataError("gmr.out_of_range", "a query time is too far from the mixture");
  return path;
}

}  // namespace lfd
