#include "lfdtools/plot/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lfdtools/io/utf8.hpp"

namespace lfd::plot {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";  // U+FFFD

std::string attributes(const Stroke& stroke) {
  std::string text = fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", stroke.color, coordinate(stroke.width));
  if (!stroke.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", stroke.dash);
  if (stroke.opacity < 1) text += fmt::format(" stroke-opacity=\"{}\"", coordinate(stroke.opacity));
  return text;
}

std::string filling(const std::string& fill, double opacity, const Stroke& outline) {
  std::string text = fmt::format(" fill=\"{}\"", fill);
  if (opacity < 1) text += fmt::format(" fill-opacity=\"{}\"", coordinate(opacity));
  return outline.color.empty() ? text : text + attributes(outline);
}

std::string listed(const std::vector<Point>& points) {
  std::string text;
  for (const Point& point : points) {
    // A tenth of a pixel is 25 micrometres on paper.
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", point.x, point.y);
  }
  return text;
}

/// Distance of p from the segment a b.
double distance(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double s = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - s * dx, p.y - a.y - s * dy);
}

/// Corners of a marker of half width r about the origin.
std::vector<Point> corners(MarkerShape shape, double r) {
  switch (shape) {
    case MarkerShape::square:
      return {{-0.9 * r, -0.9 * r}, {0.9 * r, -0.9 * r}, {0.9 * r, 0.9 * r}, {-0.9 * r, 0.9 * r}};
    case MarkerShape::triangle:
      return {{0, -1.1 * r}, {1.05 * r, 0.8 * r}, {-1.05 * r, 0.8 * r}};
    case MarkerShape::down:
      return {{0, 1.1 * r}, {-1.05 * r, -0.8 * r}, {1.05 * r, -0.8 * r}};
    case MarkerShape::diamond:
      return {{0, -1.2 * r}, {1.2 * r, 0}, {0, 1.2 * r}, {-1.2 * r, 0}};
    case MarkerShape::star: {
      std::vector<Point> points;
      for (int k = 0; k < 10; ++k) {
        const double angle = k * std::acos(-1.0) / 5;
        const double length = (k % 2 == 0 ? 1.25 : 0.55) * r;
        points.push_back({length * std::sin(angle), -length * std::cos(angle)});
      }
      return points;
    }
    default:
      return {};
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_sequence(text, i);
    const char c = text[i];
    const std::string_view character = text.substr(i, length);
    const bool control = static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n';
    // U+FFFE and U+FFFF are no characters of XML.
    if (length == 0 || control || character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") {
      out += replacement;
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += character;
    }
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string coordinate(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

double text_width(std::string_view text, double size) {
  double width = 0;
  for (std::size_t i = 0; i < text.size(); i += std::max<std::size_t>(utf8_sequence(text, i), 1)) {
    const char c = text[i];
    const bool narrow = std::string_view(" .,:;'|!()[]ijlft").find(c) != std::string_view::npos;
    const bool wide = std::string_view("mwMW%").find(c) != std::string_view::npos;
    const bool lower = c >= 'a' && c <= 'z';
    width += narrow ? 0.34 : wide ? 0.88 : lower ? 0.57 : 0.64;
  }
  return width * size;
}

std::vector<Point> simplified(const std::vector<Point>& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, line.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    double farthest = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = distance(line[i], line[first], line[last]);
      if (d > farthest) {
        farthest = d;
        at = i;
      }
    }
    if (at == first) continue;
    kept[at] = true;
    spans.emplace_back(first, at);
    spans.emplace_back(at, last);
  }
  std::vector<Point> out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) out.push_back(line[i]);
  }
  return out;
}

void Svg::line(Point from, Point to, const Stroke& stroke) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", coordinate(from.x), coordinate(from.y),
                       coordinate(to.x), coordinate(to.y), attributes(stroke));
}

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (points.empty()) return;
  std::vector<Point> drawn = simplified(points);
  // Without length there is nothing to stroke; a short one with round ends is a dot.
  if (drawn.size() == 1) drawn.push_back({drawn[0].x + 0.01, drawn[0].y});
  body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke-linejoin=\"round\"{}{}/>\n", listed(drawn),
                       stroke.dash.empty() ? " stroke-linecap=\"round\"" : "", attributes(stroke));
}

void Svg::polygon(const std::vector<Point>& points, const std::string& fill, double opacity, const Stroke& outline) {
  if (points.empty()) return;
  body_ += fmt::format("<polygon points=\"{}\"{}/>\n", listed(points), filling(fill, opacity, outline));
}

void Svg::rectangle(const Box& box, const std::string& fill, double opacity, const Stroke& outline) {
  body_ +=
      fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", coordinate(box.left), coordinate(box.top),
                  coordinate(box.width), coordinate(box.height), filling(fill, opacity, outline));
}

void Svg::marker(Point at, const Marker& marker) {
  const double r = marker.size / 2;
  const std::string fill = marker.filled ? marker.color : "#ffffff";
  const Stroke outline{marker.color, marker.filled ? 0.5 : 1.2, "", 1};
  switch (marker.shape) {
    case MarkerShape::circle:
      body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", coordinate(at.x), coordinate(at.y),
                           coordinate(r), filling(fill, 1, outline));
      return;
    case MarkerShape::plus:
      line({at.x - r, at.y}, {at.x + r, at.y}, {marker.color, 1.4, "", 1});
      line({at.x, at.y - r}, {at.x, at.y + r}, {marker.color, 1.4, "", 1});
      return;
    case MarkerShape::cross:
      line({at.x - 0.8 * r, at.y - 0.8 * r}, {at.x + 0.8 * r, at.y + 0.8 * r}, {marker.color, 1.4, "", 1});
      line({at.x - 0.8 * r, at.y + 0.8 * r}, {at.x + 0.8 * r, at.y - 0.8 * r}, {marker.color, 1.4, "", 1});
      return;
    default: {
      std::vector<Point> points = corners(marker.shape, r);
      for (Point& point : points) point = {at.x + point.x, at.y + point.y};
      polygon(points, fill, 1, outline);
    }
  }
}

void Svg::text(Point at, std::string_view words, const TextStyle& style) {
  if (words.empty()) return;
  const char* anchor = style.anchor == Anchor::start ? "start" : style.anchor == Anchor::middle ? "middle" : "end";
  std::string more = style.bold ? " font-weight=\"bold\"" : "";
  if (style.halo) more += " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
  if (style.upwards) more += fmt::format(" transform=\"rotate(-90 {} {})\"", coordinate(at.x), coordinate(at.y));
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"{}>{}</text>\n",
                       coordinate(at.x), coordinate(at.y), coordinate(style.size), anchor, style.color, more,
                       escaped(words));
}

void Svg::begin_clip(const Box& box) {
  ++clips_;
  body_ += fmt::format(
      "<clipPath id=\"clip{0}\"><rect x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\"/></clipPath>\n"
      "<g clip-path=\"url(#clip{0})\">\n",
      clips_, coordinate(box.left), coordinate(box.top), coordinate(box.width), coordinate(box.height));
}

void Svg::end_clip() {
  body_ += "</g>\n";
}

std::string Svg::document(double width, double height, std::string_view title) const {
  // 720 px are 180 mm, two columns of a journal's page.
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{2}mm\" height=\"{3}mm\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">\n"
      "<title>{4}</title>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{5}</svg>\n",
      coordinate(width), coordinate(height), coordinate(width / 4), coordinate(height / 4), escaped(title), body_);
}

}  // namespace lfd::plot
