// Normal numbers for tests.
#pragma once

#include <cstdint>

#include "lfdtools/linalg.hpp"
#include "lfdtools/random.hpp"

namespace lfd {

inline Matrix random_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return Matrix::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

}  // namespace lfd
