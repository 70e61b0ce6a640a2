// Expectation maximisation from one start to convergence, with re-seeding of components that collapse.
#pragma once

#include <limits>
#include <vector>

#include "lfdtools/gmm.hpp"

namespace lfd {

/// EM from one start, which may be continued. Set `gmm` to the start.
struct EmRun {
  Gmm gmm;
  std::vector<double> history;      ///< objective before each iteration and at the end: see GmmFit::history
  std::vector<Collapse> collapses;  ///< re-seedings, at most K
  int iterations = 0;
  bool converged = false;
  int thin = 0;         ///< components that the last iteration left thin, all re-seedings being spent
  bool failed = false;  ///< a singular covariance that re-seeding did not cure

  /// Of `gmm`; -inf when the run has failed or not begun.
  [[nodiscard]] double objective() const {
    return failed || history.empty() ? -std::numeric_limits<double>::infinity() : history.back();
  }
};

/// Goes on until an iteration gains less than options.tolerance a sample, or until `until` iterations have been done in
/// all. A component is re-seeded at a badly explained sample when it holds too few samples for a covariance (D+1, or 2
/// where it is diagonal or spherical), is hardly wider than the regularisation in a column that varies, or has a
/// singular covariance.
/// @param samples         N x D, by column, scaled so that a column that varies has a variance of 1
/// @param regularization  D, as em_step
void advance(const Matrix& samples, const Vector& regularization, const EmOptions& options, int until, unsigned jobs,
             EmRun& run);

}  // namespace lfd
