// Demonstrations for the tests of Gaussian mixtures.
#pragma once

#include <cmath>
#include <cstdint>

#include "lfdtools/linalg.hpp"
#include "lfdtools/random.hpp"

namespace lfd {

/// Noisy repetitions of a curve, time first.
inline Samples demonstrations(int repetitions, std::uint64_t seed) {
  Random random(seed);
  Samples x(repetitions * 100, 4);
  for (int m = 0; m < repetitions; ++m) {
    const double shift = 0.02 * random.normal();
    for (int i = 0; i < 100; ++i) {
      const double t = i / 99.0;
      x.row(m * 100 + i) << 3.0 * t, t * t + shift + 0.002 * random.normal(),
          std::sin(4.0 * t) + shift + 0.002 * random.normal(), 0.1 * std::cos(7.0 * t) + 0.002 * random.normal();
    }
  }
  return x;
}

}  // namespace lfd
