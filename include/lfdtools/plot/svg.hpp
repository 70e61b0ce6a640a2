// Scalable vector graphics: elements as text, the same bytes for the same drawing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lfd::plot {

/// A place on the page, right and down from its upper left corner [px].
struct Point {
  double x = 0;
  double y = 0;
};

/// A rectangle on the page [px].
struct Box {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;

  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

/// How a line is drawn.
struct Stroke {
  std::string color = "#000000";
  double width = 1;    ///< [px]
  std::string dash;    ///< lengths of strokes and gaps [px], such as "6 3"; empty: solid
  double opacity = 1;  ///< 0 to 1
};

enum class MarkerShape { circle, square, triangle, diamond, plus, cross, down, star };

/// A sign at a place.
struct Marker {
  MarkerShape shape = MarkerShape::circle;
  std::string color = "#000000";
  double size = 6;     ///< width [px]
  bool filled = true;  ///< false: white inside
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 11;  ///< [px]
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool upwards = false;  ///< reads from below to above
  bool halo = false;     ///< white around it: over lines
  std::string color = "#000000";
};

/// The text with &, <, >, " and ' as entities; what XML 1.0 forbids (control characters, bytes that are not UTF-8)
/// becomes U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// A length to a hundredth of a pixel, without trailing zeros, whatever the locale.
[[nodiscard]] std::string coordinate(double value);

/// Width that a text will have, about: fonts differ. @param size  of the font [px]   @return [px]
[[nodiscard]] double text_width(std::string_view text, double size);

/// The line without the points that lie within `tolerance` [px] of it anyway (Douglas and Peucker).
[[nodiscard]] std::vector<Point> simplified(const std::vector<Point>& line, double tolerance = 0.1);

/// A drawing in the making. Later elements cover earlier ones.
class Svg {
 public:
  void line(Point from, Point to, const Stroke& stroke);
  /// A line through the points; one point alone is a dot.
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  /// @param outline  of no colour: none
  void polygon(const std::vector<Point>& points, const std::string& fill, double opacity, const Stroke& outline);
  void rectangle(const Box& box, const std::string& fill, double opacity, const Stroke& outline);
  void marker(Point at, const Marker& marker);
  /// @param at  the anchor on the base line
  void text(Point at, std::string_view words, const TextStyle& style = {});

  /// What follows, up to end_clip, shows inside the box only.
  void begin_clip(const Box& box);
  void end_clip();

  /// The whole document, on white. @param width, height  [px]   @param title  for readers who do not see it
  [[nodiscard]] std::string document(double width, double height, std::string_view title) const;

 private:
  std::string body_;
  int clips_ = 0;
};

}  // namespace lfd::plot
