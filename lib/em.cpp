#include "lfdtools/em.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/lanes.hpp"
#include "lfdtools/parallel.hpp"

namespace lfd {
namespace {

using Eigen::Index;

constexpr int em_block = 64;  // samples worked on together: what they need stays in the first-level cache
constexpr int em_lanes = 8;   // partial sums, whatever the vector width
constexpr int em_max_dimensions = 64;
constexpr Index em_chunk = 8192;  // samples summed by one task; fixed, so that threads do not change the sums

/// Sums a component needs: r, and row by row r z_a, r z_a z_b (b <= a).
constexpr int em_sums(int D) {
  return 1 + D + D * (D + 1) / 2;
}

/// The mixture in the form the E step wants.
struct EmModel {
  int components = 0;
  int dimensions = 0;
  std::vector<double> means;          // K x D
  std::vector<double> whitening;      // K lower triangles of L_k^-1, row by row
  std::vector<double> log_constants;  // K: everything in ln weight but -|z|^2 / 2
};

/// Work space of one run.
struct EmScratch {
  explicit EmScratch(const EmModel& model) {
    const auto K = static_cast<std::size_t>(model.components);
    const auto D = static_cast<std::size_t>(model.dimensions);
    z.resize(K * D * em_block);
    weights.resize(K * em_block);
    tail.resize(D * em_block);
    sums.assign(K * static_cast<std::size_t>(em_sums(model.dimensions)) * em_lanes, 0.0);
  }
  std::vector<double> z, weights, tail, sums;
  double largest[em_block];
  double total[em_block];
};

#define LFD_KERNEL "em_kernel.inc"
#include "widths.inc"

using Run = double (*)(const EmModel&, const double*, std::ptrdiff_t, std::ptrdiff_t, EmScratch&);

Run kernel(int width) {
#ifdef LFD_X86_WIDTHS
  if (width == 8) return width8::run;
  if (width == 4) return width4::run;
#endif
  return width == 2 ? width2::run : nullptr;
}

EmModel prepare(const Gmm& gmm, const Vector& regularization, std::vector<Matrix>& factors) {
  const Index K = gmm.components();
  const Index D = gmm.dimensions();
  EmModel model;
  model.components = static_cast<int>(K);
  model.dimensions = static_cast<int>(D);
  model.means.assign(gmm.means.data(), gmm.means.data() + K * D);
  for (Index k = 0; k < K; ++k) {
    const Matrix L = cholesky(gmm.covariances[static_cast<std::size_t>(k)]);
    const Matrix M = L.triangularView<Eigen::Lower>().solve(Matrix::Identity(D, D));
    double trace = 0.0;  // tr(Sigma^-1 R)
    for (Index a = 0; a < D; ++a) {
      for (Index b = 0; b <= a; ++b) {
        model.whitening.push_back(M(a, b));
        trace += M(a, b) * M(a, b) * regularization[b];
      }
    }
    // A prior of 0 takes no part; the least double keeps its logarithm finite.
    const double log_prior = std::log(std::max(gmm.priors[k], std::numeric_limits<double>::min()));
    model.log_constants.push_back(log_prior -
                                  0.5 * (static_cast<double>(D) * log_2pi + log_determinant_from_cholesky(L) + trace));
    factors.push_back(L);
  }
  return model;
}

/// Adds the 8 lanes of every sum in a fixed order.
void add_lanes(const std::vector<double>& lanes, std::vector<double>& sums) {
  for (std::size_t q = 0; q < sums.size(); ++q) {
    const double* s = lanes.data() + q * em_lanes;
    sums[q] += ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
  }
}

/// New parameters from the sums in whitened coordinates about the old mean: x = mu + L z.
void maximise(const std::vector<double>& sums, const std::vector<Matrix>& factors, const Vector& regularization,
              CovarianceType type, const Vector& varies, double N, EmStep& step) {
  const Index D = step.gmm.dimensions();
  Matrix shared = Matrix::Zero(D, D);
  Matrix C(D, D);
  Vector z(D);
  const double* s = sums.data();
  for (Index k = 0; k < step.gmm.components(); ++k) {
    const double count = *s++;
    step.counts[k] = count;
    step.gmm.priors[k] = count / N;
    for (Index a = 0; a < D; ++a) {
      z[a] = *s++;
      for (Index b = 0; b <= a; ++b) C(a, b) = C(b, a) = *s++;
    }
    auto& Sigma = step.gmm.covariances[static_cast<std::size_t>(k)];
    if (count < 1e-200) continue;
    const Matrix& L = factors[static_cast<std::size_t>(k)];
    z /= count;
    C = C / count - z * z.transpose();
    step.gmm.means.row(k) += (L * z).transpose();
    Matrix S = L * C * L.transpose();
    S = 0.5 * (S + S.transpose()).eval();
    if (type == CovarianceType::tied) {
      shared += step.gmm.priors[k] * S;
      continue;
    }
    S.diagonal() += regularization;
    Sigma = constrained(S, type, varies);
  }
  if (type != CovarianceType::tied) return;
  shared.diagonal() += regularization;
  for (Matrix& Sigma : step.gmm.covariances) Sigma = shared;
}

}  // namespace

Vector varying_columns(const Matrix& samples) {
  Vector varies(samples.cols());
  for (Index j = 0; j < samples.cols(); ++j) {
    const double* x = samples.data() + j * samples.rows();
    const bool varied = std::any_of(x, x + samples.rows(), [x](double value) { return value != *x; });
    varies[j] = varied ? 1.0 : 0.0;
  }
  return varies;
}

Matrix constrained(const Matrix& Sigma, CovarianceType type, const Vector& varies) {
  if (type == CovarianceType::full || type == CovarianceType::tied) return Sigma;
  Vector variances = Sigma.diagonal();
  const double varying = varies.sum();
  if (type == CovarianceType::spherical && varying > 0.0) {
    const double shared = variances.dot(varies) / varying;
    variances = (varies.array() > 0.0).select(shared, variances);
  }
  return variances.asDiagonal();
}

EmStep em_step(const Gmm& gmm, const Matrix& samples, const Vector& regularization, CovarianceType type, unsigned jobs,
               int vector_width) {
  if (gmm.dimensions() > em_max_dimensions) {
    throw DataError("gmm.too_many_columns", "a mixture takes at most " + std::to_string(em_max_dimensions) +
                                                " columns, this one has " + std::to_string(gmm.dimensions()));
  }
  const auto widths = vector_widths();
  if (vector_width == 0) vector_width = widths.back();
  const Run run =
      std::find(widths.begin(), widths.end(), vector_width) == widths.end() ? nullptr : kernel(vector_width);
  if (run == nullptr) throw UsageError("em.vector_width", "this processor has no vectors of that width");

  const Index N = samples.rows();
  std::vector<Matrix> factors;
  const EmModel model = prepare(gmm, regularization, factors);
  const auto chunks = static_cast<std::size_t>((N + em_chunk - 1) / em_chunk);
  const auto sums_size =
      static_cast<std::size_t>(model.components) * static_cast<std::size_t>(em_sums(model.dimensions));
  std::vector<std::vector<double>> partial(chunks, std::vector<double>(sums_size, 0.0));
  std::vector<double> objectives(chunks, 0.0);
  parallel_for(chunks, jobs, [&](std::size_t c) {
    const Index first = static_cast<Index>(c) * em_chunk;
    EmScratch scratch(model);
    objectives[c] = run(model, samples.data() + first, N, std::min(em_chunk, N - first), scratch);
    add_lanes(scratch.sums, partial[c]);
  });

  EmStep step{gmm, 0.0, Vector::Zero(gmm.components())};
  std::vector<double> sums(sums_size, 0.0);
  for (std::size_t c = 0; c < chunks; ++c) {
    step.objective += objectives[c];
    for (std::size_t q = 0; q < sums_size; ++q) sums[q] += partial[c][q];
  }
  const Vector varies = type == CovarianceType::spherical ? varying_columns(samples) : Vector();
  maximise(sums, factors, regularization, type, varies, static_cast<double>(N), step);
  return step;
}

}  // namespace lfd
