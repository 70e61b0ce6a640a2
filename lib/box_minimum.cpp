#include "lfdtools/box_minimum.hpp"

#include <LBFGSB.h>

#include <cmath>
#include <stdexcept>

#include "lfdtools/error.hpp"

namespace lfd {

BoxMinimum minimize_in_box(const Objective& function, Vector x, const Vector& lower, const Vector& upper,
                           const BoxMinimumOptions& options) {
  BoxMinimum best;
  x = x.cwiseMax(lower).cwiseMin(upper);
  Vector gradient = Vector::Zero(x.size());
  best.x = x;
  best.value = function(x, gradient);
  if (!std::isfinite(best.value) || !gradient.allFinite()) {
    throw DataError("minimum.bad_start", "the function is not finite at the start of its minimisation");
  }
  // LBFGS++ would go on with NaN; a huge flat value ends its line search instead, by an exception. The best point seen is
  // kept here, and from it the search goes on with shorter steps.
  constexpr double outside = 1e100;
  bool left_domain = false;
  const auto objective = [&](const Vector& at, Vector& slope) {
    const double value = function(at, slope);
    ++best.evaluations;
    if (!std::isfinite(value) || !slope.allFinite()) {
      slope.setZero(at.size());
      left_domain = true;
      return outside;
    }
    if (value < best.value) {
      best.value = value;
      best.x = at;
    }
    return value;
  };
  LBFGSpp::LBFGSBParam<double> parameters;
  parameters.m = 10;
  parameters.epsilon = options.gradient_tolerance;
  parameters.epsilon_rel = 0;
  parameters.max_iterations = options.max_iterations;
  parameters.max_linesearch = 40;
  for (double longest = 1e20; longest > 1e-6; longest = longest > 1 ? 0.1 : 0.1 * longest) {
    parameters.max_step = longest;
    left_domain = false;
    try {
      LBFGSpp::LBFGSBSolver<double> solver(parameters);
      double value = best.value;
      x = best.x;
      best.converged = solver.minimize(objective, x, value, lower, upper) < options.max_iterations;
    } catch (const std::runtime_error&) {
    } catch (const std::logic_error&) {
    }
    if (!left_domain) break;
  }
  return best;
}

}  // namespace lfd
