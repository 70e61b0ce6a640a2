// Minimum of a smooth function inside a box.
#pragma once

#include <functional>

#include "lfdtools/linalg.hpp"

namespace lfd {

struct BoxMinimumOptions {
  int max_iterations = 200;
  double gradient_tolerance = 5e-4;  ///< length of the gradient, projected onto the box, that is left
};

struct BoxMinimum {
  Vector x;
  double value = 0;
  int evaluations = 0;     ///< beside that of the start
  bool converged = false;  ///< false: out of iterations, or no step lowers the value any more
};

/// Value and gradient (same size as x). A value that is not finite means: outside the domain, take a shorter step.
using Objective = std::function<double(const Vector& x, Vector& gradient)>;

/// L-BFGS-B (Byrd, Lu, Nocedal and Zhu 1995) by LBFGS++. The result is the lowest point seen, never above the start.
/// @param x             start, clamped into the box
/// @param lower, upper  bounds, lower <= upper
/// @throws DataError [minimum.bad_start] if the function is not finite at the start
[[nodiscard]] BoxMinimum minimize_in_box(const Objective& function, Vector x, const Vector& lower, const Vector& upper,
                                         const BoxMinimumOptions& options = {});

}  // namespace lfd
