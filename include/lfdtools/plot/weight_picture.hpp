// Weights of movement primitives by basis function: predictions among the training rows (paper Figure 4).
#pragma once

#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// A panel a signal: weight over basis, mean and standard deviation of each target, training rows in grey.
/// @param top  upper edge on the page [px]   @return lower edge [px]
double draw_weights(Svg& svg, const Material& material, double top);

}  // namespace lfd::plot
