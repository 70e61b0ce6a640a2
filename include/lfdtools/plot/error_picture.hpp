// Methods compared on targets that they have not seen: bars of leave-one-target-out errors.
#pragma once

#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// A panel a measure: the mean over targets of each method as a bar, single targets as dots, the mean in figures. Bars
/// far beyond most others are cut, with a mark, so that the others can be told apart.
/// @param top  upper edge on the page [px]   @return lower edge [px]
double draw_errors(Svg& svg, const Material& material, double top);

/// Where an axis of bars from 0 ends: the largest value, unless some means are over five times the median mean: then a
/// quarter beyond the largest of the others' values.
/// @param means  of each method   @param greatest  value of each method
[[nodiscard]] double bar_limit(const std::vector<double>& means, const std::vector<double>& greatest);

}  // namespace lfd::plot
