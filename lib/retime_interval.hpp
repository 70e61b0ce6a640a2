// One interval of the grid of retime.cpp: what the acceleration limits leave of the speeds at its two ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lfdtools/dh.hpp"

namespace lfd::retiming {

/// First and second derivative of the path at a grid point, and the largest (ds/dt)^2 that the speed limits allow.
struct Slope {
  Joints first, second;
  double most = std::numeric_limits<double>::infinity();
};

/// a x + b y <= c
struct HalfPlane {
  double a, b, c;
};

/// One grid interval of length `step`: x = (ds/dt)^2 where it begins, y where it ends, (y - x) / (2 step) the
/// acceleration of s along it.
class Interval {
 public:
  Interval(const Slope& begin, const Slope& end, const Joints& acceleration, double step) {
    for (int j = 0; j < 6; ++j) {
      const double limit = acceleration[j];
      const double p = begin.first[j] / (2.0 * step), r = end.first[j] / (2.0 * step);
      add(begin.second[j] - p, p, limit);
      add(-r, r + end.second[j], limit);
    }
  }

  /// The largest x <= most_x from which some y in [0, most_y] can be reached. The feasible y are those from the highest
  /// of some lines up to the lowest of others, a gap concave in x and not negative at 0: Newton steps from above end at
  /// the edge after a few lines.
  [[nodiscard]] double largest_begin(double most_x, double most_y) const {
    double x = most_x;
    for (const HalfPlane& h : planes_) {
      if (h.b == 0.0 && h.a > 0.0) x = std::min(x, h.c / h.a);
    }
    for (int iteration = 0; iteration < 100; ++iteration) {
      const auto [low, high] = ends(x, most_y);
      if (low.value <= high.value) return x;
      const double next = x - (low.value - high.value) / (low.slope - high.slope);
      if (!(next < x)) break;
      x = std::max(0.0, next);
    }
    return x;
  }

  /// The largest y <= most_y that can be reached from x.
  [[nodiscard]] double largest_end(double x, double most_y) const {
    return std::max(0.0, ends(x, most_y).second.value);
  }

 private:
  struct Edge {
    double value, slope;
  };

  void add(double a, double b, double limit) {
    // What is too small to matter on the scale of the other would only give steep lines.
    if (std::abs(b) < 1e-13 * std::abs(a)) b = 0.0;
    planes_[count_++] = {a, b, limit};
    planes_[count_++] = {-a, -b, limit};
  }

  [[nodiscard]] std::pair<Edge, Edge> ends(double x, double most_y) const {
    Edge low{0.0, 0.0}, high{most_y, 0.0};
    for (const HalfPlane& h : planes_) {
      if (h.b == 0.0) continue;
      const Edge edge{(h.c - h.a * x) / h.b, -h.a / h.b};
      if (h.b > 0.0 && edge.value < high.value) high = edge;
      if (h.b < 0.0 && edge.value > low.value) low = edge;
    }
    return {low, high};
  }

  std::array<HalfPlane, 24> planes_{};
  std::size_t count_ = 0;
};

}  // namespace lfd::retiming
