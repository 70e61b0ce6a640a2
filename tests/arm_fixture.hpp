// Random joints to try an arm with.
#pragma once

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

}  // namespace lfd
