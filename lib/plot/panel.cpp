#include "lfdtools/plot/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lfdtools/plot/palette.hpp"

namespace lfd::plot {
namespace {

constexpr double tick_length = 4;
constexpr double tick_text = 10;
constexpr double label_text = 11.5;
constexpr double room_of_tick_up = 22;  // between two ticks of the vertical axis

/// Ticks whose texts are the values over the axis' power of ten.
std::vector<Tick> ticks_of(const Range& range, int most) {
  const double unit = std::pow(10.0, exponent_of(range));
  std::vector<Tick> ticks = nice_ticks({range.low / unit, range.high / unit, false}, most);
  for (Tick& tick : ticks) tick.value *= unit;
  return ticks;
}

/// The label with the power of ten, if there is one.
std::string scaled_label(const Axis& axis) {
  const int exponent = exponent_of(axis.range);
  if (exponent == 0 || axis.label.empty()) return axis.label;
  return fmt::format("{}  (\u00d7 10^{}{})", axis.label, exponent < 0 ? "\u2212" : "", std::abs(exponent));
}

}  // namespace

Panel::Panel(const Box& where, const Range& across, const Range& up, std::string label_across, std::string label_up)
    : box(where),
      x{across, where.left, where.right(), std::move(label_across)},
      y{up, where.bottom(), where.top, std::move(label_up)} {}

std::vector<Point> Panel::line(const Eigen::Ref<const Vector>& across, const Eigen::Ref<const Vector>& up) const {
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(across.size()));
  for (Eigen::Index k = 0; k < across.size(); ++k) points.push_back(at(across[k], up[k]));
  return points;
}

std::vector<Tick> Panel::ticks_across() const {
  // As many as their own texts leave room for.
  for (int most = integers ? 25 : 10; most > 2; --most) {
    std::vector<Tick> ticks = ticks_of(x.range, most);
    if (integers) std::erase_if(ticks, [](const Tick& tick) { return tick.value != std::round(tick.value); });
    double widest = 0;
    for (const Tick& tick : ticks) widest = std::max(widest, text_width(tick.text, tick_text));
    if (static_cast<double>(ticks.size()) * (widest + 9) <= box.width && ticks.size() > 1) return ticks;
  }
  // Too narrow for two texts at round steps: finer ticks, every second one with a text.
  std::vector<Tick> ticks = ticks_of(x.range, 5);
  if (ticks.size() < 2) return ticks;
  const double step = ticks[1].value - ticks[0].value;
  for (Tick& tick : ticks) {
    if (std::fmod(std::round(tick.value / step), 2) != 0) tick.text.clear();
  }
  return ticks;
}

std::vector<Tick> Panel::ticks_up() const {
  if (!values_up) return {};
  return ticks_of(y.range, std::clamp(static_cast<int>(box.height / room_of_tick_up), 2, 8));
}

void Panel::draw_ground(Svg& svg) const {
  for (const Tick& tick : ticks_across()) {
    svg.line({x.at(tick.value), box.top}, {x.at(tick.value), box.bottom()}, {grid_grey, 0.7, "", 1});
  }
  for (const Tick& tick : ticks_up()) {
    svg.line({box.left, y.at(tick.value)}, {box.right(), y.at(tick.value)}, {grid_grey, 0.7, "", 1});
  }
}

void Panel::draw_frame(Svg& svg) const {
  const Stroke ink{black, 0.8, "", 1};
  svg.rectangle(box, "none", 1, ink);
  for (const Tick& tick : ticks_across()) {
    const double at = x.at(tick.value);
    svg.line({at, box.bottom()}, {at, box.bottom() + tick_length}, ink);
    if (texts_below) svg.text({at, box.bottom() + 15}, tick.text, {.size = tick_text, .anchor = Anchor::middle});
  }
  double widest = 0;
  for (const Tick& tick : ticks_up()) {
    const double at = y.at(tick.value);
    svg.line({box.left - tick_length, at}, {box.left, at}, ink);
    svg.text({box.left - 7, at + 3.5}, tick.text, {.size = tick_text, .anchor = Anchor::end});
    widest = std::max(widest, text_width(tick.text, tick_text));
  }
  if (texts_below) {
    svg.text({box.left + box.width / 2, box.bottom() + 30}, scaled_label(x),
             {.size = label_text, .anchor = Anchor::middle});
  }
  svg.text({std::max(box.left - 14 - widest, box.left - room_left + 11), box.top + box.height / 2}, scaled_label(y),
           {.size = label_text, .anchor = Anchor::middle, .upwards = true});
}

}  // namespace lfd::plot
