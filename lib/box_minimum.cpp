#include "lfdtools/box_minimum.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "lfdtools/error.hpp"

namespace lfd {

namespace {

/// Variables that may move: not on a bound that the descent pushes against.
std::vector<Eigen::Index> free_variables(const Vector& x, const Vector& g, const Vector& lower, const Vector& upper) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const bool held = (x(i) <= lower(i) && g(i) >= 0) || (x(i) >= upper(i) && g(i) <= 0);
    if (!held) free.push_back(i);
  }
  return free;
}

/// -B_FF^-1 g_F, zero elsewhere. A variable on a bound that this direction would cross is taken out as well, and the
/// rest solved again, for otherwise the projection may turn the direction uphill.
Vector quasi_newton_direction(const Matrix& B, const Vector& x, const Vector& g, const Vector& lower,
                              const Vector& upper, std::vector<Eigen::Index> free) {
  Vector direction;
  for (bool settled = false; !settled;) {
    const Vector step = Matrix(B(free, free)).llt().solve(-g(free));
    direction.setZero(x.size());
    std::vector<Eigen::Index> inside;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::Index i = free[k];
      const double d = step(static_cast<Eigen::Index>(k));
      direction(i) = d;
      if (!((x(i) <= lower(i) && d < 0) || (x(i) >= upper(i) && d > 0))) inside.push_back(i);
    }
    settled = inside.size() == free.size() || inside.empty();
    free = inside;
  }
  return direction;
}

/// BFGS update of B with Powell's damping: y is drawn towards B s until the curvature along s is at least 0.2 s^T B s.
void update(Matrix& B, const Vector& s, Vector y) {
  const Vector Bs = B * s;
  const double sBs = s.dot(Bs);
  const double sy = s.dot(y);
  if (!(sBs > 0)) return;
  if (sy < 0.2 * sBs) {
    const double theta = 0.8 * sBs / (sBs - sy);
    y = theta * y + (1 - theta) * Bs;
  }
  B += y * y.transpose() / s.dot(y) - Bs * Bs.transpose() / sBs;
}

}  // namespace

BoxMinimum minimize_in_box(const Objective& function, Vector x, const Vector& lower, const Vector& upper,
                           const BoxMinimumOptions& options, const Matrix& hessian) {
  const Eigen::Index size = x.size();
  const auto clamp = [&](const Vector& v) -> Vector { return v.cwiseMax(lower).cwiseMin(upper); };
  BoxMinimum best;
  x = clamp(x);
  Vector g = Vector::Zero(size);
  double f = function(x, g);
  best.evaluations = 1;
  if (!std::isfinite(f) || !g.allFinite()) {
    throw DataError("minimum.bad_start", "the function is not finite at the start of its minimisation");
  }

  const auto gentle = [&]() -> Matrix {  // a first step of length one at most
    return Matrix::Identity(size, size) * std::max(g.lpNorm<Eigen::Infinity>(), 1e-8);
  };
  Matrix B = hessian.size() > 0 ? hessian : gentle();
  bool fresh = hessian.size() == 0;  // nothing learned about the curvature yet

  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const auto free = free_variables(x, g, lower, upper);
    double slope = 0;
    double excess = 0;  // over the tolerance
    for (const auto i : free) {
      slope = std::max(slope, std::abs(g(i)));
      excess = std::max(excess, std::abs(g(i)) / std::max(1.0, std::sqrt(B(i, i))));
    }
    if (excess <= options.gradient_tolerance) {
      best.converged = true;
      break;
    }
    Vector direction = quasi_newton_direction(B, x, g, lower, upper, free);
    const double length = direction.lpNorm<Eigen::Infinity>();
    if (length > options.max_step) direction *= options.max_step / length;

    bool moved = false;
    double t = 1;
    Vector s, g_new = Vector::Zero(size);
    double f_new = f;
    for (int trial = 0; trial < 25 && !moved; ++trial) {
      s = clamp(x + t * direction) - x;
      double descent = g.dot(s);
      if (descent >= 0 && trial == 0) {  // the projection spoiled the direction: the projected gradient always descends
        direction = -g * (std::min(1.0, options.max_step / slope));
        s = clamp(x + direction) - x;
        descent = g.dot(s);
      }
      if (descent >= 0) break;
      f_new = function(x + s, g_new);
      ++best.evaluations;
      const bool finite = std::isfinite(f_new) && g_new.allFinite();
      moved = finite && f_new < f && f_new <= f + 1e-4 * descent;
      if (!moved) {
        // Minimum of the parabola through f, its slope and f_new, kept within a tenth to a half of the step.
        const double curvature = f_new - f - descent;
        t *= finite && curvature > 0 ? std::clamp(-0.5 * descent / curvature, 0.1, 0.5) : 0.25;
      }
    }
    if (!moved) {
      if (fresh) break;  // even the plain gradient finds nothing lower: the limit of the arithmetic
      B = gentle();
      fresh = true;
      continue;
    }
    const Vector y = g_new - g;
    if (fresh && s.dot(y) > 0) B = Matrix::Identity(size, size) * (y.squaredNorm() / s.dot(y));
    fresh = false;
    update(B, s, y);
    x = clamp(x + s);
    f = f_new;
    g = g_new;
  }
  best.x = x;
  best.value = f;
  best.hessian = B;
  return best;
}

}  // namespace lfd
