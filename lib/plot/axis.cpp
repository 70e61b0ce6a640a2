#include "lfdtools/plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd::plot {
namespace {

constexpr double largest = 1e150;    // beyond it the arithmetic of pixels may overflow
constexpr double same_share = 1e-6;  // a shorter range is rounding of one value
constexpr int most_decimals = 9;     // of a tick in full; otherwise with an exponent
constexpr double longest_tick = 1e6;
constexpr double smallest_plain = 2e-3;

}  // namespace

void Range::include(double value) {
  low = empty ? value : std::min(low, value);
  high = empty ? value : std::max(high, value);
  empty = false;
}

void Range::include(const Eigen::Ref<const Vector>& values) {
  if (values.size() == 0) return;
  include(values.minCoeff());
  include(values.maxCoeff());
}

void Range::include(const Range& other) {
  if (other.empty) return;
  include(other.low);
  include(other.high);
}

Range Range::widened_to(double length) const {
  return {middle() - length / 2, middle() + length / 2, false};
}

Range Range::padded(double share, double least) const {
  if (empty) return {0, 1, false};
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(size <= largest)) {
    throw DataError("plot.out_of_range", fmt::format("a value of {:.3g} is too large to be drawn", size));
  }
  double pad = share * length();
  if (length() <= same_share * size || length() == 0) pad = std::max(size / 20, least);
  return {low - pad, high + pad, false};
}

int exponent_of(const Range& range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  if (size == 0 || (size >= smallest_plain && size < longest_tick)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(size) / 3));
}

std::vector<Tick> nice_ticks(const Range& range, int most) {
  const double slack = 1e-9 * range.length();  // a tick on the border stays one
  const double raw = range.length() / std::max(most, 2);
  const double power = std::floor(std::log10(raw));
  double step = 0;
  // The first step, going up, that gives few enough ticks.
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    step = factor * std::pow(10.0, power);
    if (std::floor((range.high + slack) / step) - std::ceil((range.low - slack) / step) + 1 <= std::max(most, 2)) break;
  }
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  const bool plain = decimals <= most_decimals && std::max(std::abs(range.low), std::abs(range.high)) < longest_tick;
  std::vector<Tick> ticks;
  for (double k = std::ceil((range.low - slack) / step); k * step <= range.high + slack; ++k) {
    std::string text = plain ? fmt::format("{:.{}f}", k * step, decimals) : fmt::format("{:.6g}", k * step);
    if (text.find_first_of("123456789") == std::string::npos && text[0] == '-') text.erase(0, 1);
    for (std::size_t i = text.find('-'); i != std::string::npos; i = text.find('-', i)) text.replace(i, 1, "\u2212");
    ticks.push_back({k * step, text});
    if (ticks.size() > 100) break;  // unreachable unless k does not move
  }
  return ticks;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string unit_of(const std::string& signal) {
  if (signal == "x" || signal == "y" || signal == "z") return "m";
  if (signal == "t") return "s";
  if (signal.size() == 2 && signal[0] == 'q' && signal[1] >= '1' && signal[1] <= '9') return "rad";
  return "";
}

}  // namespace lfd::plot
