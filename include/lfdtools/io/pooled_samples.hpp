// The recordings of a target as a mixture sees them.
#pragma once

#include "lfdtools/io/demonstrations.hpp"

namespace lfd {

/// All samples of a pool, and the means of its measured ends.
struct PooledSamples {
  Samples joint;  ///< N x (1 + D): t [s], then the signals
  Vector start;   ///< D
  Vector goal;    ///< D

  explicit PooledSamples(const Pool& pool);
};

}  // namespace lfd
