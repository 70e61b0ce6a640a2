// Whether bands hold what they promise: observed shares against nominal levels, and how wide the bands are.
#pragma once

#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// Left the share of samples and of whole paths inside, with the diagonal of a band that is right; right the mean
/// half-width in millimetres.
/// @param top  upper edge on the page [px]   @return lower edge [px]
double draw_reliability(Svg& svg, const Material& material, double top);

}  // namespace lfd::plot
