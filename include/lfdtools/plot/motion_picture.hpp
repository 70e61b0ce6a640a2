// Demonstrations, references and motions in planes and against time (paper Figures 3, 5 and 8).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lfdtools/plot/curve_style.hpp"
#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// Two signals: across the page and up.
using Plane = std::pair<std::string, std::string>;

/// The planes that suit the signals: x-y and y-z with an obstacle (Figure 8), x-y, y-z and x-z without; of other
/// signals none.
[[nodiscard]] std::vector<Plane> default_planes(const Material& material);

/// A row of plane views, each to scale, with goals, their names, and the outlines of obstacles.
/// @param top  upper edge on the page [px]   @return lower edge [px]
/// @throws DataError [plot.no_such_signal] of a plane
double draw_planes(Svg& svg, const Material& material, const CurveStyle& style, const std::vector<Plane>& planes,
                   double top);

/// A panel a signal over time, three in a row, with bands of two standard deviations and mixture components.
double draw_times(Svg& svg, const Material& material, const CurveStyle& style, double top);

/// Legend of both.
double draw_motion_legend(Svg& svg, const Material& material, const CurveStyle& style, bool planes, bool times,
                          double top);

}  // namespace lfd::plot
