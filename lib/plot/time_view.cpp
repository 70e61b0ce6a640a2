#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lfdtools/plot/motion_picture.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/panel.hpp"

namespace lfd::plot {
namespace {

constexpr double band_sds = 2;  // half-width of a band
constexpr double band_opacity = 0.22;
constexpr const char* component_dash = "3 2";
constexpr int most_in_row = 3;
constexpr int ellipse_corners = 64;

/// The line at two standard deviations around a component, over time and one signal.
std::vector<Point> ellipse(const Gmm& mixture, Eigen::Index component, Eigen::Index signal) {
  const Matrix& covariance = mixture.covariances[static_cast<std::size_t>(component)];
  const Eigen::Index dims[2] = {0, signal + 1};
  Eigen::Matrix2d Sigma;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) Sigma(i, j) = covariance(dims[i], dims[j]);
  }
  const Eigen::Matrix2d L = Sigma.llt().matrixL();
  std::vector<Point> points;
  for (int k = 0; k < ellipse_corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / ellipse_corners;
    const Eigen::Vector2d around = band_sds * (L * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    points.push_back({mixture.means(component, 0) + around[0], mixture.means(component, dims[1]) + around[1]});
  }
  return points;
}

/// Whether the times are those of a clock, such as seconds since 1970: too far from zero for ticks.
bool of_a_clock(const Material& material) {
  constexpr double far = 1e4;  // durations
  double latest = 0;
  double longest = 0;
  for (const Curve& curve : material.curves) {
    latest = std::max(latest, curve.trajectory.times.cwiseAbs().maxCoeff());
    longest = std::max(longest, curve.trajectory.duration());
  }
  return longest > 0 && latest > far * longest && material.mixtures.empty();
}

/// Times as they are drawn: of a clock, each curve's from its first sample on.
Vector drawn_times(const Curve& curve, bool clock) {
  const Vector& times = curve.trajectory.times;
  return clock ? Vector(times.array() - times[0]) : times;
}

void draw_band(Svg& svg, const Panel& panel, const Curve& curve, const Vector& times, Eigen::Index signal,
               const std::string& color) {
  const Vector mean = curve.trajectory.positions.col(signal);
  const Vector half = band_sds * curve.sd.col(signal);
  std::vector<Point> outline = simplified(panel.line(times, mean + half));
  std::vector<Point> below = simplified(panel.line(times, mean - half));
  outline.insert(outline.end(), below.rbegin(), below.rend());
  svg.polygon(outline, color, band_opacity, {"", 0, "", 1});
}

void draw_signal(Svg& svg, const Material& material, const CurveStyle& style, Eigen::Index signal, bool clock,
                 const Panel& panel) {
  panel.draw_ground(svg);
  svg.begin_clip(panel.box);
  for (const Curve& curve : material.curves) {
    if (curve.sd.size() > 0) draw_band(svg, panel, curve, drawn_times(curve, clock), signal, style.stroke(curve).color);
  }
  for (const Curve& curve : material.curves) {
    const std::vector<Point> line = panel.line(drawn_times(curve, clock), curve.trajectory.positions.col(signal));
    const Stroke stroke = style.stroke(curve);
    if (style.cased(curve)) svg.polyline(line, {"#ffffff", stroke.width + 1.4, stroke.dash, 0.8});
    svg.polyline(line, stroke);
  }
  for (const GmmFile& mixture : material.mixtures) {
    for (Eigen::Index k = 0; k < mixture.gmm.components(); ++k) {
      std::vector<Point> outline = ellipse(mixture.gmm, k, signal);
      for (Point& point : outline) point = panel.at(point.x, point.y);
      svg.polygon(outline, black, 0.06, {black, 0.9, component_dash, 1});
    }
  }
  svg.end_clip();
  panel.draw_frame(svg);
}

}  // namespace

double draw_times(Svg& svg, const Material& material, const CurveStyle& style, double top) {
  const auto D = static_cast<int>(material.signals.size());
  const bool clock = of_a_clock(material);
  Range times;
  std::vector<Range> ranges(material.signals.size());
  for (const Curve& curve : material.curves) {
    times.include(drawn_times(curve, clock));
    for (std::size_t d = 0; d < ranges.size(); ++d) {
      const Vector values = curve.trajectory.positions.col(static_cast<Eigen::Index>(d));
      ranges[d].include(values);
      if (curve.sd.size() == 0) continue;
      const Vector half = band_sds * curve.sd.col(static_cast<Eigen::Index>(d));
      ranges[d].include(values + half);
      ranges[d].include(values - half);
    }
  }
  for (const GmmFile& mixture : material.mixtures) {
    for (Eigen::Index k = 0; k < mixture.gmm.components(); ++k) {
      for (std::size_t d = 0; d < ranges.size(); ++d) {
        for (const Point& point : ellipse(mixture.gmm, k, static_cast<Eigen::Index>(d))) {
          times.include(point.x);
          ranges[d].include(point.y);
        }
      }
    }
  }
  const int columns = std::min(D, most_in_row);
  const double width = page_width / columns - room_left - room_right;
  const double height = D <= 2 ? 220 : 160;
  for (int d = 0; d < D; ++d) {
    const double left = d % columns * (width + room_left + room_right) + room_left;
    const int row = d / columns;
    const double upper = top + row * (room_above + height + room_below) + room_above;
    const std::string& name = material.signals[static_cast<std::size_t>(d)];
    const Panel panel({left, upper, width, height}, times.padded(0.02, 0.1),
                      ranges[static_cast<std::size_t>(d)].padded(0.06, 0.02),
                      clock ? "time from the first sample [s]" : "time [s]", with_unit(name, unit_of(name)));
    draw_signal(svg, material, style, d, clock, panel);
  }
  const int rows = (D + columns - 1) / columns;
  return top + rows * (room_above + height + room_below);
}

double draw_motion_legend(Svg& svg, const Material& material, const CurveStyle& style, bool planes, bool times,
                          double top) {
  std::vector<LegendEntry> entries = style.legend();
  const bool bands = std::any_of(material.curves.begin(), material.curves.end(),
                                 [](const Curve& curve) { return curve.sd.size() > 0; });
  if (times && bands) entries.push_back({"two standard deviations", {}, {}, grey, band_opacity * 2});
  if (times && !material.mixtures.empty()) {
    entries.push_back({"mixture component, two standard deviations", Stroke{black, 0.9, component_dash, 1}});
  }
  if (planes && !style.ends().empty()) {
    entries.push_back({style.ends_name(), {}, Marker{MarkerShape::plus, black, 9, true}});
  }
  if (planes && !material.obstacles.empty()) {
    const std::string& name = material.obstacles[0].name;
    const bool one = material.obstacles.size() == 1;
    const std::string words = !one ? "obstacles" : name.empty() ? "obstacle" : name;
    entries.push_back({words, {}, {}, obstacle_fill, obstacle_opacity});
  }
  return top + draw_legend(svg, entries, {10, top, page_width - 20, 0});
}

}  // namespace lfd::plot
