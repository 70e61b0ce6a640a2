// One seeded generator whose numbers are the same on every machine and with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace lfd {

/// SplitMix64 (Steele, Lea and Flood 2014). Independent streams come from `split`.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, n), n >= 1.
  std::uint64_t below(std::uint64_t n) { return bits() % n; }  // bias under n / 2^64

  /// Standard normal (Box and Muller; one of the pair, so that the count of draws is fixed).
  double normal() {
    const double u = 1.0 - uniform();  // in (0, 1]
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

  /// A generator of its own for the given key; this one does not move.
  [[nodiscard]] Random split(std::uint64_t key) const {
    Random child(state_ ^ (0xD1B54A32D192ED03ULL * (key + 1)));
    child.bits();
    return child;
  }

 private:
  std::uint64_t state_;
};

}  // namespace lfd
