#include <catch2/catch.hpp>
#include <clocale>
#include <cmath>

#include "lfdtools/plot/legend.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/svg.hpp"

using namespace lfd::plot;

TEST_CASE("Text cannot leave its element") {
  CHECK(escaped("<a href=\"x\">&'") == "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  CHECK(escaped("S\u00fcd \u2212 1") == "S\u00fcd \u2212 1");
}

TEST_CASE("What XML forbids becomes the replacement character") {
  CHECK(escaped(std::string_view("a\0b\x1b[c", 6)) == "a\uFFFDb\uFFFD[c");
  CHECK(escaped("\xff\xc3") == "\uFFFD\uFFFD");
  CHECK(escaped("\xEF\xBF\xBF") == "\uFFFD");
  CHECK(escaped("tab\tline\n") == "tab\tline\n");
}

TEST_CASE("Lengths have two decimals at most and no minus zero, in any locale") {
  for (const char* locale : {"C", "de_DE.UTF-8"}) {
    const char* const old = std::setlocale(LC_ALL, locale);
    CHECK(coordinate(1.5) == "1.5");
    CHECK(coordinate(-0.001) == "0");
    CHECK(coordinate(12.3456) == "12.35");
    CHECK(coordinate(100) == "100");
    if (old != nullptr) std::setlocale(LC_ALL, "C");
  }
}

TEST_CASE("A line loses the points that it does not need, and no others") {
  std::vector<Point> straight;
  std::vector<Point> arc;
  for (int k = 0; k <= 1000; ++k) {
    straight.push_back({0.1 * k, 0.2 * k});
    arc.push_back({100 * std::cos(1e-3 * k), 100 * std::sin(1e-3 * k)});
  }
  CHECK(simplified(straight).size() == 2);
  const auto few = simplified(arc, 0.1);
  CHECK(few.size() < 30);
  CHECK(few.back().x == arc.back().x);
  for (const Point& point : few) CHECK(std::hypot(point.x, point.y) == Approx(100));
  // A loop whose ends meet is kept.
  CHECK(simplified({{0, 0}, {5, 5}, {0, 10}, {0, 0}}).size() == 4);
  CHECK(simplified({}).empty());
}

TEST_CASE("A document stands alone, on white, with its size") {
  Svg svg;
  svg.text({10, 20}, "a < b");
  const std::string document = svg.document(720, 100, "title & more");
  CHECK(document.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\""));
  CHECK(document.find("width=\"180mm\" height=\"25mm\" viewBox=\"0 0 720 100\"") != std::string::npos);
  CHECK(document.find("fill=\"#ffffff\"") != std::string::npos);
  CHECK(document.find("<title>title &amp; more</title>") != std::string::npos);
  CHECK(document.ends_with(">a &lt; b</text>\n</svg>\n"));
}

TEST_CASE("Every marker is drawn, and one point alone is a dot") {
  for (const MarkerShape shape : {MarkerShape::circle, MarkerShape::square, MarkerShape::triangle, MarkerShape::diamond,
                                  MarkerShape::plus, MarkerShape::cross, MarkerShape::down, MarkerShape::star}) {
    Svg svg;
    const std::string empty = svg.document(10, 10, "");
    svg.marker({5, 5}, {shape, "#000000", 6, true});
    CHECK(svg.document(10, 10, "").size() > empty.size());
  }
  Svg svg;
  svg.polyline({{1, 1}}, {});
  CHECK(svg.document(10, 10, "").find("points=\"1.0,1.0 1.0,1.0\"") != std::string::npos);
}

TEST_CASE("28 series look different, neighbours in more than colour") {
  for (std::size_t i = 0; i < 28; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CHECK((look(i).color != look(j).color || look(i).dash != look(j).dash));
      CHECK((look(i).color != look(j).color || look(i).marker != look(j).marker));
      CHECK((dense_look(i).color != dense_look(j).color || dense_look(i).dash != dense_look(j).dash));
    }
    CHECK(look(i).dash != look(i + 1).dash);
    CHECK(look(i).marker != look(i + 1).marker);
  }
}

TEST_CASE("A legend has as many rows as its width asks for") {
  const std::vector<LegendEntry> entries(12, {"a method", Stroke{}});
  Svg svg;
  const double one = draw_legend(svg, {entries[0]}, {0, 0, 700, 0});
  CHECK(draw_legend(svg, entries, {0, 0, 700, 0}) == 2 * one);
  CHECK(draw_legend(svg, entries, {0, 0, 90, 0}) == 12 * one);
  CHECK(draw_legend(svg, {}, {0, 0, 700, 0}) == 0);
}
