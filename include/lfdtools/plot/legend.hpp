// What the lines, markers and areas of a figure stand for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// One sign and its words. Without any sign the words are a heading of what follows.
struct LegendEntry {
  std::string words;
  std::optional<Stroke> line;
  std::optional<Marker> marker;
  std::optional<std::string> area;  ///< colour of a filled area
  double opacity = 1;               ///< of the area
};

/// Draws the entries from left to right in as many rows as they need, each row centred.
/// @return height of all rows [px]
double draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, const Box& room);

}  // namespace lfd::plot
