// Random joints to try an arm with, and errors of its hand.
#pragma once

#include <cmath>
#include <numbers>

#include "lfdtools/dh.hpp"
#include "lfdtools/random.hpp"

namespace lfd {

/// Each within half a turn of zero [rad].
inline Joints random_joints(Random& random) {
  Joints q;
  for (double& angle : q) angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  return q;
}

/// Covariance of one signal over time: smooth, of standard deviation sd and length scale l samples.
inline Matrix smooth(Eigen::Index T, double sd, double l) {
  Matrix A(T, T);
  for (Eigen::Index i = 0; i < T; ++i) {
    for (Eigen::Index j = 0; j < T; ++j) {
      A(i, j) = sd * sd * std::exp(-0.5 * std::pow(static_cast<double>(i - j) / l, 2));
    }
  }
  return A;
}

}  // namespace lfd
