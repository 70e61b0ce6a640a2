#include "lfdtools/plot/palette.hpp"

#include <array>

namespace lfd::plot {
namespace {

constexpr std::array<const char*, 7> colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                            "#e69f00", "#56b4e9", "#4d4d4d"};
constexpr std::array<const char*, 4> dashes{"", "7 2.5", "2 2", "8 2 2 2"};
constexpr std::array<MarkerShape, 7> markers{MarkerShape::circle,  MarkerShape::square, MarkerShape::triangle,
                                             MarkerShape::diamond, MarkerShape::down,   MarkerShape::star,
                                             MarkerShape::cross};

}  // namespace

Look look(std::size_t i) {
  // Where the colours begin anew the markers go on by one: no colour meets a marker twice in 49 series.
  return {colors[i % colors.size()], dashes[i % dashes.size()], markers[(i + i / colors.size()) % markers.size()]};
}

Look dense_look(std::size_t i) {
  return {colors[i % colors.size()], dashes[i / colors.size() % dashes.size()], markers[i % markers.size()]};
}

}  // namespace lfd::plot
