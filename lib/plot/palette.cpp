#include "lfdtools/plot/palette.hpp"

#include <array>

namespace lfd::plot {

Look look(std::size_t i) {
  static constexpr std::array<const char*, 7> colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                     "#e69f00", "#56b4e9", "#4d4d4d"};
  static constexpr std::array<const char*, 4> dashes{"", "6 2.5", "1.5 2", "7 2 1.5 2"};
  static constexpr std::array<MarkerShape, 7> markers{MarkerShape::circle,  MarkerShape::square, MarkerShape::triangle,
                                                      MarkerShape::diamond, MarkerShape::down,   MarkerShape::star,
                                                      MarkerShape::cross};
  return {colors[i % colors.size()], dashes[i / colors.size() % dashes.size()], markers[i % markers.size()]};
}

}  // namespace lfd::plot
