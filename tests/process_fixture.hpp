// Smooth random functions to train processes with.
#pragma once

#include "lfdtools/linalg.hpp"
#include "random_matrix.hpp"

namespace lfd {

struct Rows {
  Matrix X, Y;
};

/// Smooth outputs: random sinusoids of the inputs, the last `idle` inputs without effect.
inline Rows smooth_rows(int n, int p, int d, double noise, std::uint64_t seed, int idle = 0) {
  Rows rows{0.3 * random_matrix(n, p, seed), Matrix::Zero(n, d)};
  const Matrix slopes = 2.5 * random_matrix(p - idle, 6, seed + 1);
  const Matrix amplitudes = random_matrix(6, d, seed + 2);
  const Matrix phases = 3.0 * random_matrix(1, 6, seed + 3);
  const Matrix waves = (rows.X.leftCols(p - idle) * slopes).rowwise() + phases.row(0);
  rows.Y = waves.array().sin().matrix() * amplitudes + noise * random_matrix(n, d, seed + 4);
  return rows;
}

}  // namespace lfd
