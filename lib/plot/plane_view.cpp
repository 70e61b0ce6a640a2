#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/plot/motion_picture.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/panel.hpp"
#include "lfdtools/plot/silhouette.hpp"

namespace lfd::plot {
namespace {

constexpr double greatest_height = 300;
constexpr double least_share = 0.35;    // of the widest range, for the narrow ones
constexpr std::size_t most_names = 24;  // targets that are named beside their goals
constexpr double same_place = 5;        // [px]
constexpr double name_size = 10;

struct PlaneIndex {
  Eigen::Index across;
  Eigen::Index up;
};

Eigen::Index index_of(const Material& material, const std::string& signal) {
  const auto at = std::find(material.signals.begin(), material.signals.end(), signal);
  if (at == material.signals.end()) {
    throw DataError("plot.no_such_signal", fmt::format("there is no signal {} for a plane; there are: {}", signal,
                                                       fmt::join(material.signals, ", ")));
  }
  return at - material.signals.begin();
}

/// 0, 1, 2 for x, y, z; -1 for other signals.
int coordinate_of(const std::string& signal) {
  return signal == "x" ? 0 : signal == "y" ? 1 : signal == "z" ? 2 : -1;
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

/// Ranges of all signals: the curves, the goals, and obstacles as far as they do not dwarf these.
std::vector<Range> ranges_of(const Material& material, const CurveStyle& style) {
  std::vector<Range> ranges(material.signals.size());
  for (std::size_t d = 0; d < ranges.size(); ++d) {
    const auto column = static_cast<Eigen::Index>(d);
    for (const Curve& curve : material.curves) ranges[d].include(curve.trajectory.positions.col(column));
    for (const TargetEnd& end : style.ends()) ranges[d].include(end.position[column]);
    const int coordinate = coordinate_of(material.signals[d]);
    for (const Solid& solid : material.obstacles) {
      if (coordinate < 0) continue;
      Range with = ranges[d];
      for (const Point& point : silhouette(solid, {coordinate, coordinate})) with.include(point.x);
      if (ranges[d].empty || with.length() <= 2 * ranges[d].length()) ranges[d] = with;
    }
    ranges[d] = ranges[d].padded(0.06, 0.02);
  }
  double widest = 0;
  for (const Range& range : ranges) widest = std::max(widest, range.length());
  for (Range& range : ranges) range = range.widened_to(std::max(range.length(), least_share * widest));
  return ranges;
}

/// Names of targets beside their goals; those of one place together, none upon another.
void draw_names(Svg& svg, const Panel& panel, const PlaneIndex& plane, const std::vector<TargetEnd>& ends) {
  if (ends.size() > most_names) return;
  struct Cluster {
    Point at;
    std::string names;
  };
  std::vector<Cluster> clusters;
  for (const TargetEnd& end : ends) {
    if (end.name.empty()) continue;
    const Point at = panel.at(end.position[plane.across], end.position[plane.up]);
    const auto same = std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& cluster) {
      return std::hypot(cluster.at.x - at.x, cluster.at.y - at.y) < same_place;
    });
    if (same == clusters.end()) {
      clusters.push_back({at, end.name});
    } else {
      same->names += ", " + end.name;
    }
  }
  std::vector<Box> taken;
  for (const Cluster& cluster : clusters) taken.push_back({cluster.at.x - 4, cluster.at.y - 4, 8, 8});
  for (const Cluster& cluster : clusters) {
    const double width = text_width(cluster.names, name_size);
    for (const auto& [dx, dy] : {Point{6, -5}, Point{-6 - width, -5}, Point{6, 12}, Point{-6 - width, 12},
                                 Point{-width / 2, -8}, Point{-width / 2, 16}}) {
      const Box box{cluster.at.x + dx, cluster.at.y + dy - 8, width, 10};
      const bool inside = box.left > panel.box.left + 1 && box.right() < panel.box.right() - 1 &&
                          box.top > panel.box.top + 1 && box.bottom() < panel.box.bottom() - 1;
      if (!inside || std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return overlap(b, box); })) continue;
      taken.push_back(box);
      svg.text({box.left, cluster.at.y + dy}, cluster.names, {.size = name_size, .halo = true});
      break;
    }
  }
}

void draw_plane(Svg& svg, const Material& material, const CurveStyle& style, const PlaneIndex& plane,
                const Panel& panel) {
  panel.draw_ground(svg);
  svg.begin_clip(panel.box);
  const PlaneView view{coordinate_of(material.signals[static_cast<std::size_t>(plane.across)]),
                       coordinate_of(material.signals[static_cast<std::size_t>(plane.up)])};
  for (const Solid& solid : material.obstacles) {
    if (view.across < 0 || view.up < 0) break;
    std::vector<Point> outline = silhouette(solid, view);
    for (Point& point : outline) point = panel.at(point.x, point.y);
    svg.polygon(outline, obstacle_fill, obstacle_opacity, {"#5a5a5a", 0.8, "", 1});
  }
  for (const Curve& curve : material.curves) {
    const auto& positions = curve.trajectory.positions;
    const std::vector<Point> line = panel.line(positions.col(plane.across), positions.col(plane.up));
    const Stroke stroke = style.stroke(curve);
    if (style.cased(curve)) svg.polyline(line, {"#ffffff", stroke.width + 1.4, "", 0.8});
    svg.polyline(line, stroke);
  }
  for (const TargetEnd& end : style.ends()) {
    svg.marker(panel.at(end.position[plane.across], end.position[plane.up]), {MarkerShape::plus, black, 9, true});
  }
  draw_names(svg, panel, plane, style.ends());
  svg.end_clip();
  panel.draw_frame(svg);
}

}  // namespace

std::vector<Plane> default_planes(const Material& material) {
  const auto has = [&](const char* name) {
    return std::find(material.signals.begin(), material.signals.end(), name) != material.signals.end();
  };
  std::vector<Plane> planes;
  for (const auto& [across, up] : {Plane{"x", "y"}, Plane{"y", "z"}, Plane{"x", "z"}}) {
    if (!has(across.c_str()) || !has(up.c_str())) continue;
    if (planes.size() == 2 && !material.obstacles.empty()) continue;
    planes.emplace_back(across, up);
  }
  return planes;
}

double draw_planes(Svg& svg, const Material& material, const CurveStyle& style, const std::vector<Plane>& planes,
                   double top) {
  const std::vector<Range> ranges = ranges_of(material, style);
  std::vector<PlaneIndex> indices;
  double across = 0;  // sum of the horizontal ranges
  double up = 0;      // largest vertical range
  for (const Plane& plane : planes) {
    indices.push_back({index_of(material, plane.first), index_of(material, plane.second)});
    across += ranges[static_cast<std::size_t>(indices.back().across)].length();
    up = std::max(up, ranges[static_cast<std::size_t>(indices.back().up)].length());
  }
  // One scale for all, so that a length is the same length everywhere.
  const double room = page_width - static_cast<double>(planes.size()) * (room_left + room_right);
  const double height = std::min(room / across * up, greatest_height);
  const double scale = height / up;  // [px/m]
  const double widening = room / (across * scale);
  double left = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Range& horizontal = ranges[static_cast<std::size_t>(indices[i].across)];
    const Range& vertical = ranges[static_cast<std::size_t>(indices[i].up)];
    const double width = horizontal.length() * scale * widening;
    const Panel panel({left + room_left, top + room_above, width, height},
                      horizontal.widened_to(horizontal.length() * widening), vertical.widened_to(up),
                      with_unit(planes[i].first, unit_of(planes[i].first)),
                      with_unit(planes[i].second, unit_of(planes[i].second)));
    draw_plane(svg, material, style, indices[i], panel);
    left += room_left + width + room_right;
  }
  return top + room_above + height + room_below;
}

}  // namespace lfd::plot
