#include "lfdtools/plot/legend.hpp"

namespace lfd::plot {
namespace {

constexpr double row_height = 17;
constexpr double sign_width = 24;
constexpr double text_size = 11;
constexpr double gap = 16;  // between entries

bool has_sign(const LegendEntry& entry) {
  return entry.line || entry.marker || entry.area;
}

double width_of(const LegendEntry& entry) {
  return (has_sign(entry) ? sign_width + 5 : 0) + text_width(entry.words, text_size);
}

void draw(Svg& svg, const LegendEntry& entry, Point at) {
  const double middle = at.y - 4;
  double left = at.x;
  if (has_sign(entry)) {
    if (entry.area) svg.rectangle({left, middle - 5, sign_width, 10}, *entry.area, entry.opacity, {"", 0, "", 1});
    if (entry.line) svg.line({left, middle}, {left + sign_width, middle}, *entry.line);
    if (entry.marker) svg.marker({left + sign_width / 2, middle}, *entry.marker);
    left += sign_width + 5;
  }
  svg.text({left, at.y}, entry.words, {.size = text_size});
}

}  // namespace

double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, const Box& room) {
  std::vector<std::vector<LegendEntry>> rows;
  std::vector<double> widths;
  for (const LegendEntry& entry : entries) {
    const double width = width_of(entry);
    if (rows.empty() || widths.back() + gap + width > room.width) {
      rows.emplace_back();
      widths.push_back(-gap);
    }
    rows.back().push_back(entry);
    widths.back() += gap + width;
  }
  double y = room.top + 12;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double x = room.left + (room.width - widths[i]) / 2;
    for (const LegendEntry& entry : rows[i]) {
      draw(svg, entry, {x, y});
      x += width_of(entry) + gap;
    }
    y += row_height;
  }
  return static_cast<double>(rows.size()) * row_height;
}

}  // namespace lfd::plot
