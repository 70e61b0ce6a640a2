// Colours, dashes and markers that stay apart for colour-blind readers and in grey print.
#pragma once

#include <cstddef>
#include <string>

#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

inline constexpr const char* black = "#000000";
inline constexpr const char* grey = "#8c8c8c";
inline constexpr const char* light_grey = "#b0b0b0";
inline constexpr const char* grid_grey = "#e6e6e6";
inline constexpr const char* obstacle_fill = "#f0e442";
inline constexpr double obstacle_opacity = 0.4;

/// What tells one series from the others.
struct Look {
  std::string color;
  std::string dash;
  MarkerShape marker = MarkerShape::circle;
};

/// Look of series number i, from 0. Colours of Okabe and Ito (2008) without yellow, which is lost on white; neighbours
/// differ in colour, dash and marker, 28 series in colour or dash, 49 in colour or marker.
[[nodiscard]] Look look(std::size_t i);
/// The same for many thin lines, which are solid as long as the colours suffice, for 7 series.
[[nodiscard]] Look dense_look(std::size_t i);

}  // namespace lfd::plot
