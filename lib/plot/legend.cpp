#include "lfdtools/plot/legend.hpp"

#include <algorithm>
#include <utility>

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
    if (entry.line) {
      Stroke stroke = *entry.line;
      stroke.width = std::max(stroke.width, 1.2);  // thin ones are seen in the figure by their number
      svg.line({left, middle}, {left + sign_width, middle}, stroke);
    }
    if (entry.marker) svg.marker({left + sign_width / 2, middle}, *entry.marker);
    left += sign_width + 5;
  }
  svg.text({left, at.y}, entry.words, {.size = text_size});
}

/// Entries from left to right, a new row where the width is used up.
std::vector<std::vector<LegendEntry>> rows_of(const std::vector<LegendEntry>& entries, double width) {
  std::vector<std::vector<LegendEntry>> rows;
  double used = 0;
  for (const LegendEntry& entry : entries) {
    const double own = width_of(entry);
    if (rows.empty() || used + gap + own > width) {
      rows.emplace_back();
      used = -gap;
    }
    rows.back().push_back(entry);
    used += gap + own;
  }
  return rows;
}

}  // namespace

double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, const Box& room) {
  std::vector<std::vector<LegendEntry>> rows = rows_of(entries, room.width);
  // As narrow as the number of rows allows: no row with a single entry left over.
  for (double width = room.width; width > room.width / 3; width -= 10) {
    std::vector<std::vector<LegendEntry>> narrower = rows_of(entries, width);
    if (narrower.size() > rows.size()) break;
    rows = std::move(narrower);
  }
  double y = room.top + 12;
  for (const std::vector<LegendEntry>& row : rows) {
    double width = -gap;
    for (const LegendEntry& entry : row) width += gap + width_of(entry);
    double x = room.left + (room.width - width) / 2;
    for (const LegendEntry& entry : row) {
      draw(svg, entry, {x, y});
      x += width_of(entry) + gap;
    }
    y += row_height;
  }
  return static_cast<double>(rows.size()) * row_height;
}

}  // namespace lfd::plot
