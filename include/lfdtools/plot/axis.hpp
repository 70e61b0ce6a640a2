// Axes: ranges of values, round ticks, and where a value stands on the page.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/linalg.hpp"

namespace lfd::plot {

/// What an axis spans; empty until a value is included.
struct Range {
  double low = 0;
  double high = 0;
  bool empty = true;

  void include(double value);
  void include(const Eigen::Ref<const Vector>& values);
  void include(const Range& other);
  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return low + (high - low) / 2; }
  /// The same middle with another length.
  [[nodiscard]] Range widened_to(double length) const;
  /// Wider by a share of its length at both ends. A range without length, of a constant signal, gets a twentieth of its
  /// value, at least `least`, on both sides; an empty one is 0 to 1.
  /// @throws DataError [plot.out_of_range] if the values are too large to be drawn, over 1e150
  [[nodiscard]] Range padded(double share = 0.05, double least = 0.01) const;
};

struct Tick {
  double value = 0;
  std::string text;  ///< with U+2212 for minus
};

/// The power of ten, a multiple of 3, by which the values of an axis are divided for its texts: 0 unless all are small,
/// under 0.002, or some large, from 10^6 on.
[[nodiscard]] int exponent_of(const Range& range);

/// Ticks inside the range at multiples of 1, 2 or 5 times a power of ten, at most `most` (at least 2) of them; all with
/// the same number of decimals.
[[nodiscard]] std::vector<Tick> nice_ticks(const Range& range, int most);

/// A range laid along the page.
struct Axis {
  Range range;
  double from = 0;    ///< place of range.low [px]
  double to = 1;      ///< place of range.high [px]
  std::string label;  ///< with its unit

  [[nodiscard]] double at(double value) const { return from + (value - range.low) / range.length() * (to - from); }
};

/// "x [m]"; without a unit the name alone.
[[nodiscard]] std::string with_unit(const std::string& name, const std::string& unit);
/// Unit of a signal or a time by its name: m for x, y, z; rad for q1..q6; s for t; nothing for others.
[[nodiscard]] std::string unit_of(const std::string& signal);

}  // namespace lfd::plot
