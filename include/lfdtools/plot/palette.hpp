// Colours, dashes and markers that stay apart for colour-blind readers and in grey print.
#pragma once

#include <cstddef>
#include <string>

#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

inline constexpr const char* black = "#000000";
inline constexpr const char* grey = "#8c8c8c";
inline constexpr const char* light_grey = "#c8c8c8";
inline constexpr const char* grid_grey = "#e6e6e6";
inline constexpr const char* obstacle_fill = "#8c8c8c";
inline constexpr double obstacle_opacity = 0.4;

/// What tells one series from the others.
struct Look {
  std::string color;
  std::string dash;
  MarkerShape marker = MarkerShape::circle;
};

/// Look of series number i, from 0. Colours of Okabe and Ito (2008) without yellow, which is lost on white; seven
/// series in each dash, so that 28 differ.
[[nodiscard]] Look look(std::size_t i);

}  // namespace lfd::plot
