// One diagram of a figure: a frame with two axes.
#pragma once

#include <vector>

#include "lfdtools/plot/axis.hpp"
#include "lfdtools/plot/svg.hpp"

namespace lfd::plot {

/// Room beside a panel [px].
inline constexpr double room_left = 56;   ///< tick texts and label of the vertical axis
inline constexpr double room_below = 38;  ///< the same of the horizontal one
inline constexpr double room_right = 10;
inline constexpr double room_above = 12;
inline constexpr double page_width = 720;

/// A panel and its axes; y points up the page.
struct Panel {
  Box box;
  Axis x;
  Axis y;
  bool integers = false;    ///< the horizontal axis counts: ticks at whole numbers only
  bool texts_below = true;  ///< tick texts and label of the horizontal axis

  bool values_up = true;  ///< the vertical axis has values: false for rows of bars

  Panel(const Box& where, const Range& across, const Range& up, std::string label_across, std::string label_up);

  [[nodiscard]] Point at(double across, double up) const { return {x.at(across), y.at(up)}; }
  /// The samples of two signals, or of time and a signal, as a line.
  [[nodiscard]] std::vector<Point> line(const Eigen::Ref<const Vector>& across,
                                        const Eigen::Ref<const Vector>& up) const;
  /// White ground and grid: before the data.
  void draw_ground(Svg& svg) const;
  /// Frame, ticks and labels: after them.
  void draw_frame(Svg& svg) const;

 private:
  [[nodiscard]] std::vector<Tick> ticks_across() const;
  [[nodiscard]] std::vector<Tick> ticks_up() const;
};

}  // namespace lfd::plot
