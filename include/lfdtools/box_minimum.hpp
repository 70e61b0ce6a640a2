// Minimum of a smooth function of few variables inside a box.
#pragma once

#include <functional>

#include "lfdtools/linalg.hpp"

namespace lfd {

struct BoxMinimumOptions {
  int max_iterations = 200;
  /// Largest component i of the gradient that is left, times max(1, sqrt(B_ii)) with B the approximate Hessian: along a
  /// steep direction that is a decrease of half its square still to come, along a flat one that of a unit step.
  double gradient_tolerance = 5e-4;
  double max_step = 2;  ///< longest move of a variable in one iteration
};

struct BoxMinimum {
  Vector x;
  double value = 0;
  Matrix hessian;  ///< quasi-Newton approximation at x, positive definite; a start for a similar function
  int evaluations = 0;
  bool converged = false;  ///< false: out of iterations, or no step lowers the value any more
};

/// Value and gradient (same size as x). A value that is not finite means: outside the domain, take a shorter step.
using Objective = std::function<double(const Vector& x, Vector& gradient)>;

/// Quasi-Newton descent with a dense BFGS matrix (damped updates after Powell, so that it stays positive definite) on
/// the variables that no bound holds, and a projected backtracking search. The value never rises. Dense because the
/// functions meant here have some ten variables and cost far more than the algebra.
/// @param x        start, clamped into the box
/// @param lower, upper  bounds, lower <= upper
/// @param hessian  first approximation of the Hessian (symmetric positive definite), or empty
/// @throws DataError [minimum.bad_start] if the function is not finite at the start
[[nodiscard]] BoxMinimum minimize_in_box(const Objective& function, Vector x, const Vector& lower, const Vector& upper,
                                         const BoxMinimumOptions& options = {}, const Matrix& hessian = {});

}  // namespace lfd
