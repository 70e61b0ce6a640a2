#include "lfdtools/plot/reliability_picture.hpp"

#include <algorithm>

#include "lfdtools/plot/legend.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/panel.hpp"

namespace lfd::plot {
namespace {

constexpr double side = 290;  // of both panels

/// Levels of one method, rising.
struct Levels {
  std::string method;
  std::vector<ReliabilityRow> rows;

  template <class Member>
  [[nodiscard]] Vector column(Member member, double unit = 1) const {
    Vector values(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) values[static_cast<Eigen::Index>(i)] = unit * rows[i].*member;
    return values;
  }
};

std::vector<Levels> methods_of(const Material& material) {
  std::vector<Levels> methods;
  for (const ReliabilityRow& row : material.reliability) {
    auto at =
        std::find_if(methods.begin(), methods.end(), [&](const Levels& other) { return other.method == row.method; });
    if (at == methods.end()) at = methods.insert(methods.end(), {row.method, {}});
    at->rows.push_back(row);
  }
  for (Levels& levels : methods) {
    std::stable_sort(levels.rows.begin(), levels.rows.end(),
                     [](const ReliabilityRow& a, const ReliabilityRow& b) { return a.nominal < b.nominal; });
  }
  return methods;
}

void draw_series(Svg& svg, const Panel& panel, const Vector& across, const Vector& up, const Look& look, bool filled) {
  const std::vector<Point> line = panel.line(across, up);
  svg.polyline(line, {look.color, 1.4, filled ? "" : "5 2.5", 1});
  for (const Point& point : line) svg.marker(point, {look.marker, look.color, 6, filled});
}

}  // namespace

double draw_reliability(Svg& svg, const Material& material, double top) {
  const std::vector<Levels> methods = methods_of(material);
  Range widths;
  widths.include(0);
  for (const Levels& levels : methods) widths.include(levels.column(&ReliabilityRow::width, 1e3));
  widths.high = widths.padded(0.06, 1).high;
  const Range shares{-0.02, 1.02, false};
  const Panel share({room_left, top + room_above, side, side}, shares, shares, "nominal level of the band",
                    "observed share inside");
  const double left = page_width - room_right - side;
  const Panel width({left, top + room_above, side, side}, shares, widths, "nominal level of the band",
                    "mean half-width [mm]");
  for (const Panel* panel : {&share, &width}) panel->draw_ground(svg);
  svg.line(share.at(0, 0), share.at(1, 1), {grey, 1, "3 3", 1});
  std::vector<LegendEntry> entries{
      {"a band that is right", Stroke{grey, 1, "3 3", 1}},
      {"samples inside", Stroke{black, 1.4, "", 1}, Marker{MarkerShape::circle, black}},
      {"whole paths inside", Stroke{black, 1.4, "5 2.5", 1}, Marker{MarkerShape::circle, black, 6, false}}};
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const Look own = look(i);
    const Vector nominal = methods[i].column(&ReliabilityRow::nominal);
    draw_series(svg, share, nominal, methods[i].column(&ReliabilityRow::path), own, false);
    draw_series(svg, share, nominal, methods[i].column(&ReliabilityRow::pointwise), own, true);
    draw_series(svg, width, nominal, methods[i].column(&ReliabilityRow::width, 1e3), own, true);
    entries.push_back({methods[i].method, Stroke{own.color, 1.4, "", 1}, Marker{own.marker, own.color, 6, true}});
  }
  for (const Panel* panel : {&share, &width}) panel->draw_frame(svg);
  top += room_above + side + room_below;
  return top + draw_legend(svg, entries, {10, top, page_width - 20, 0});
}

}  // namespace lfd::plot
