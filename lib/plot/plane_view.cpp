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
constexpr double least_shape = 0.6;     // width over height
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

double distance(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

bool overlap(const Box& a, const Box& b) {
  constexpr double apart = 3;  // names side by side stay two
  return a.left < b.right() + apart && b.left < a.right() + apart && a.top < b.bottom() && b.top < a.bottom();
}

/// What a solid spans along one coordinate; of one that is too long for the figure, its middle.
Range extent_of(const Solid& solid, int coordinate, double longest) {
  Range extent;
  for (const Point& point : silhouette(solid, {coordinate, coordinate})) extent.include(point.x);
  if (!extent.empty && extent.length() <= longest) return extent;
  const double middle = solid.pose.position[coordinate];
  return {middle - solid.radius, middle + solid.radius, false};
}

/// Ranges of all signals: the curves, the goals, and obstacles as far as they do not dwarf these.
std::vector<Range> ranges_of(const Material& material, const CurveStyle& style) {
  std::vector<Range> ranges(material.signals.size());
  double widest = 0;
  for (std::size_t d = 0; d < ranges.size(); ++d) {
    const auto column = static_cast<Eigen::Index>(d);
    for (const Curve& curve : material.curves) ranges[d].include(curve.trajectory.positions.col(column));
    for (const TargetEnd& end : style.ends()) ranges[d].include(end.position[column]);
    widest = std::max(widest, ranges[d].length());
  }
  const double longest = widest > 0 ? 2 * widest : 10;
  for (std::size_t d = 0; d < ranges.size(); ++d) {
    const int coordinate = coordinate_of(material.signals[d]);
    for (const Solid& solid : material.obstacles) {
      if (coordinate < 0) continue;
      Range with = ranges[d];
      with.include(extent_of(solid, coordinate, longest));
      if (with.length() <= longest) ranges[d] = with;
    }
    ranges[d] = ranges[d].padded(0.11, 0.02);
  }
  for (const Range& range : ranges) widest = std::max(widest, range.length());
  for (Range& range : ranges) range = range.widened_to(std::max(range.length(), least_share * widest));
  return ranges;
}

/// Width over height of a plane to scale, wide enough for ticks and names.
double shape_of(const std::vector<Range>& ranges, const PlaneIndex& plane) {
  const double across = ranges[static_cast<std::size_t>(plane.across)].length();
  return std::max(across / ranges[static_cast<std::size_t>(plane.up)].length(), least_shape);
}

/// How many points of curves lie in each of the boxes.
std::vector<std::size_t> points_inside(const Material& material, const Panel& panel, const PlaneIndex& plane,
                                       const std::vector<Box>& boxes) {
  std::vector<std::size_t> counts(boxes.size());
  for (const Curve& curve : material.curves) {
    const auto& positions = curve.trajectory.positions;
    for (Eigen::Index k = 0; k < positions.rows(); ++k) {
      const Point at = panel.at(positions(k, plane.across), positions(k, plane.up));
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& box = boxes[i];
        counts[i] += at.x > box.left && at.x < box.right() && at.y > box.top && at.y < box.bottom() ? 1 : 0;
      }
    }
  }
  return counts;
}

/// Names of targets beside their goals; those of one place together, none upon another,
/// where the curves are sparse.
void draw_names(Svg& svg, const Material& material, const Panel& panel, const PlaneIndex& plane,
                const std::vector<TargetEnd>& ends) {
  if (ends.size() > most_names) return;
  struct Cluster {
    Point at;
    std::string names;
  };
  std::vector<Cluster> clusters;
  for (const TargetEnd& end : ends) {
    if (end.name.empty()) continue;
    const Point at = panel.at(end.position[plane.across], end.position[plane.up]);
    const auto same = std::find_if(clusters.begin(), clusters.end(),
                                   [&](const Cluster& cluster) { return distance(cluster.at, at) < same_place; });
    if (same == clusters.end()) {
      clusters.push_back({at, end.name});
    } else {
      same->names += ", " + end.name;
    }
  }
  std::vector<Box> taken;
  taken.reserve(2 * clusters.size());
  for (const Cluster& cluster : clusters) taken.push_back({cluster.at.x - 4, cluster.at.y - 4, 8, 8});
  for (const Cluster& cluster : clusters) {
    const double width = text_width(cluster.names, name_size);
    std::vector<Box> boxes;
    for (const auto& [dx, dy] : {Point{6, -5}, Point{-6 - width, -5}, Point{6, 12}, Point{-6 - width, 12},
                                 Point{-width / 2, -8}, Point{-width / 2, 16}, Point{7, 4}, Point{-7 - width, 4}}) {
      const Box box{cluster.at.x + dx, cluster.at.y + dy - 8, width, 10};
      const bool inside = box.left > panel.box.left + 2 && box.right() < panel.box.right() - 2 &&
                          box.top > panel.box.top + 2 && box.bottom() < panel.box.bottom() - 2;
      const Point middle{box.left + box.width / 2, box.top + box.height / 2};
      const bool beside_another = std::any_of(clusters.begin(), clusters.end(), [&](const Cluster& other) {
        return &other != &cluster && distance(middle, other.at) < 1.4 * distance(middle, cluster.at);
      });
      const bool covered = std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return overlap(b, box); });
      if (!inside || beside_another || covered) continue;
      boxes.push_back(box);
    }
    if (boxes.empty()) continue;
    const std::vector<std::size_t> counts = points_inside(material, panel, plane, boxes);
    const Box& best = boxes[static_cast<std::size_t>(std::min_element(counts.begin(), counts.end()) - counts.begin())];
    taken.push_back(best);
    svg.text({best.left, best.top + 8}, cluster.names, {.size = name_size, .halo = true});
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
    svg.polygon(outline, obstacle_fill, obstacle_opacity, {"#7a7000", 0.8, "", 1});
  }
  for (const Curve& curve : material.curves) {
    const auto& positions = curve.trajectory.positions;
    const std::vector<Point> line = panel.line(positions.col(plane.across), positions.col(plane.up));
    const Stroke stroke = style.stroke(curve);
    if (style.cased(curve)) svg.polyline(line, {"#ffffff", stroke.width + 1.4, stroke.dash, 0.8});
    svg.polyline(line, stroke);
  }
  const double size = style.ends().size() > most_names ? 5 : 9;
  for (const TargetEnd& end : style.ends()) {
    svg.marker(panel.at(end.position[plane.across], end.position[plane.up]), {MarkerShape::plus, black, size, true});
  }
  draw_names(svg, material, panel, plane, style.ends());
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
  double shapes = 0;  // sum of widths over heights
  for (const Plane& plane : planes) {
    indices.push_back({index_of(material, plane.first), index_of(material, plane.second)});
    shapes += shape_of(ranges, indices.back());
  }
  // One height for all, and each panel as wide as its ranges ask for: the row is full.
  const double room = page_width - static_cast<double>(planes.size()) * (room_left + room_right);
  const double height = std::min(room / shapes, greatest_height);
  const double widening = room / (shapes * height);
  double left = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Range& horizontal = ranges[static_cast<std::size_t>(indices[i].across)];
    const Range& vertical = ranges[static_cast<std::size_t>(indices[i].up)];
    const double width = shape_of(ranges, indices[i]) * height * widening;
    const Panel panel({left + room_left, top + room_above, width, height},
                      horizontal.widened_to(vertical.length() * width / height), vertical,
                      with_unit(planes[i].first, unit_of(planes[i].first)),
                      with_unit(planes[i].second, unit_of(planes[i].second)));
    draw_plane(svg, material, style, indices[i], panel);
    left += room_left + width + room_right;
  }
  return top + room_above + height + room_below;
}

}  // namespace lfd::plot
