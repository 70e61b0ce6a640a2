// Outlines of solids in a plane of two coordinates.
#pragma once

#include <array>
#include <vector>

#include "lfdtools/plot/svg.hpp"
#include "lfdtools/scene.hpp"

namespace lfd::plot {

/// The plane of two coordinates, 0 to 2 for x, y, z: which is drawn across the page and which up.
struct PlaneView {
  int across = 0;
  int up = 1;
};

/// Corners of the smallest convex polygon around the points, counter-clockwise where y points up (Andrew's monotone
/// chain); points on its edges are left out.
[[nodiscard]] std::vector<Point> convex_hull(std::vector<Point> points);

/// Outline of a solid seen along the third coordinate, in the coordinates of the view [m]. Round ones are polygons that
/// keep within 0.2 % of the radius. Of a plane: the blocked half of a square of `extent` [m] about its position, if it
/// is seen edge-on (within a degree); otherwise nothing.
[[nodiscard]] std::vector<Point> silhouette(const Solid& solid, PlaneView view, double extent = 100);

}  // namespace lfd::plot
