#include "lfdtools/plot/error_picture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/plot/legend.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/panel.hpp"

namespace lfd::plot {
namespace {

constexpr double row_height = 24;  // of a method
constexpr double bar_height = 15;
constexpr double text_size = 11;
constexpr double far_mean = 5;  // times the median mean

/// One method's values of one measure.
struct Bar {
  std::string method;
  std::vector<double> values;  // a target each
  double mean = 0;
};

/// Columns of lengths are drawn in millimetres, shares as they are.
bool is_length(const std::string& measure) {
  return measure == "rmse" || measure == "end_error" || measure == "dtw" || measure == "outside";
}

std::string title_of(const std::string& measure) {
  if (measure == "rmse") return "root mean square error [mm]";
  if (measure == "end_error") return "distance of the end from the goal [mm]";
  if (measure == "dtw") return "dynamic time warping distance a sample [mm]";
  if (measure == "outside") return "depth outside the demonstrated region [mm]";
  return measure;
}

std::vector<Bar> bars_of(const Material& material, Eigen::Index measure) {
  const double unit = is_length(material.measures[static_cast<std::size_t>(measure)]) ? 1e3 : 1;
  std::vector<Bar> bars;
  for (const ErrorRow& row : material.errors) {
    auto bar = std::find_if(bars.begin(), bars.end(), [&](const Bar& other) { return other.method == row.method; });
    if (bar == bars.end()) bar = bars.insert(bars.end(), {row.method, {}, 0});
    bar->values.push_back(unit * row.values[measure]);
  }
  for (Bar& bar : bars) {
    for (const double value : bar.values) bar.mean += value / static_cast<double>(bar.values.size());
  }
  return bars;
}

/// The mean, and how many targets lie beyond the end of the axis.
std::string figures_of(const Bar& bar, double limit) {
  const auto beyond = std::count_if(bar.values.begin(), bar.values.end(), [&](double v) { return v > limit; });
  const std::string more = beyond > 0 ? fmt::format(", {} beyond", beyond) : "";
  return fmt::format("{:.{}f}{}", bar.mean, bar.mean < 10 ? 2 : 1, more);
}

/// The end of a bar that goes on: two slanted white lines across it, and its value at its foot.
void draw_cut(Svg& svg, double at, double middle) {
  for (const double dx : {-7.0, -3.0}) {
    svg.line({at + dx - 2, middle + bar_height / 2 + 1}, {at + dx + 2, middle - bar_height / 2 - 1},
             {"#ffffff", 1.6, "", 1});
  }
}

void draw_bar(Svg& svg, const Panel& panel, const Bar& bar, double middle) {
  const double limit = panel.x.range.high;
  const bool cut = bar.mean > limit;
  const double end = panel.x.at(std::min(bar.mean, limit));
  svg.rectangle({panel.box.left, middle - bar_height / 2, std::max(end - panel.box.left, 0.0), bar_height}, "#56b4e9",
                0.75, {"#0072b2", 0.8, "", 1});
  if (cut) draw_cut(svg, end, middle);
  // Dots of the same value are moved apart by their order: no two targets hide each other for good.
  for (std::size_t i = 0; i < bar.values.size(); ++i) {
    const double shift = (static_cast<double>(i % 3) - 1) * 3.2;
    if (bar.values[i] <= limit) {
      svg.marker({panel.x.at(std::max(bar.values[i], 0.0)), middle + shift}, {MarkerShape::circle, black, 3.6, true});
    }
  }
  svg.text({panel.box.right() + 8, middle + 4}, figures_of(bar, limit), {.size = text_size});
}

}  // namespace

double bar_limit(const std::vector<double>& means, const std::vector<double>& greatest) {
  std::vector<double> sorted = means;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted.empty() ? 0 : sorted[(sorted.size() - 1) / 2];
  const double all = greatest.empty() ? 0 : *std::max_element(greatest.begin(), greatest.end());
  double others = 0;
  bool far = false;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i] > far_mean * median) {
      far = true;
    } else {
      others = std::max(others, greatest[i]);
    }
  }
  return far && others > 0 ? std::min(1.25 * others, all) : all;
}

double draw_errors(Svg& svg, const Material& material, double top) {
  std::size_t targets = 0;
  bool any_cut = false;
  for (std::size_t m = 0; m < material.measures.size(); ++m) {
    const std::vector<Bar> bars = bars_of(material, static_cast<Eigen::Index>(m));
    double names = 0;
    std::vector<double> means;
    std::vector<double> greatest;
    for (const Bar& bar : bars) {
      names = std::max(names, text_width(bar.method, text_size));
      means.push_back(bar.mean);
      greatest.push_back(*std::max_element(bar.values.begin(), bar.values.end()));
      targets = std::max(targets, bar.values.size());
    }
    Range across;
    across.include(0);
    across.include(bar_limit(means, greatest));
    across.high = across.padded(0.03, 1).high;
    const double height = row_height * static_cast<double>(bars.size()) + 8;
    const double left = std::min(names + 24, 0.4 * page_width);
    double figures = text_width("mean", text_size);
    for (const Bar& bar : bars) figures = std::max(figures, text_width(figures_of(bar, across.high), text_size));
    Panel panel({left, top + room_above + 6, page_width - left - figures - 20, height}, across, {0, 1, false},
                title_of(material.measures[m]), "");
    panel.values_up = false;
    panel.draw_ground(svg);
    svg.text({panel.box.right() + 8, panel.box.top - 3}, "mean", {.size = text_size, .bold = true});
    for (std::size_t i = 0; i < bars.size(); ++i) {
      const double middle = panel.box.top + 4 + row_height * (static_cast<double>(i) + 0.5);
      svg.text({panel.box.left - 8, middle + 4}, bars[i].method, {.size = text_size, .anchor = Anchor::end});
      draw_bar(svg, panel, bars[i], middle);
      any_cut = any_cut || greatest[i] > panel.x.range.high;
    }
    panel.draw_frame(svg);
    top = panel.box.bottom() + room_below;
  }
  std::vector<LegendEntry> entries{
      {fmt::format("mean over {} target{}", targets, targets == 1 ? "" : "s"), {}, {}, "#56b4e9", 0.75},
      {"one target left out", {}, Marker{MarkerShape::circle, black, 3.6, true}}};
  if (any_cut) entries.push_back({"//  the bar goes on; dots beyond the axis are counted"});
  return top + draw_legend(svg, entries, {10, top, page_width - 20, 0});
}

}  // namespace lfd::plot
