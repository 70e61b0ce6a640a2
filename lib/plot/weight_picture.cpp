#include "lfdtools/plot/weight_picture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/plot/legend.hpp"
#include "lfdtools/plot/palette.hpp"
#include "lfdtools/plot/panel.hpp"

namespace lfd::plot {
namespace {

constexpr double panel_height = 150;
constexpr std::size_t most_whiskers = 7;  // series with standard deviations as whiskers; more have bands
constexpr double spread = 0.45;           // of the whiskers of one basis, in bases
constexpr double band_opacity = 0.12;
constexpr std::size_t most_entries = 21;  // of the legend

/// The index of a word in a list to which it is added if it is new.
std::size_t place_of(std::vector<std::string>& list, const std::string& word) {
  const auto at = std::find(list.begin(), list.end(), word);
  if (at == list.end()) list.push_back(word);
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), word) - list.begin());
}

/// "[m]" for weights that are forces, nothing for those in units of goal - start or of unknown origin.
std::string unit_of_weights(const Material& material) {
  if (material.training.empty()) return "";
  const bool forces = std::all_of(material.training.begin(), material.training.end(),
                                  [](const TrainingWeights& row) { return row.scaling == DmpScaling::none; });
  return forces ? "m" : "";
}

/// The training row's weights of a signal; empty if it has none.
Vector weights_of(const TrainingWeights& row, const std::string& signal) {
  const auto at = std::find(row.columns.begin(), row.columns.end(), signal);
  if (at == row.columns.end()) return {};
  return row.weights.row(at - row.columns.begin()).transpose();
}

/// @param shift  to the side of the basis [bases]
void draw_prediction(Svg& svg, const Panel& panel, const PredictedWeights& weights, const Look& look, double shift,
                     bool whiskers) {
  const Vector across = weights.basis.array() + shift;
  if (whiskers) {
    for (Eigen::Index k = 0; k < across.size(); ++k) {
      const Point low = panel.at(across[k], weights.mean[k] - weights.sd[k]);
      const Point high = panel.at(across[k], weights.mean[k] + weights.sd[k]);
      const Stroke stroke{look.color, 1.1, "", 1};
      svg.line(low, high, stroke);
      svg.line({low.x - 2, low.y}, {low.x + 2, low.y}, stroke);
      svg.line({high.x - 2, high.y}, {high.x + 2, high.y}, stroke);
    }
  } else {
    std::vector<Point> outline = panel.line(across, weights.mean + weights.sd);
    const std::vector<Point> below = panel.line(across, weights.mean - weights.sd);
    outline.insert(outline.end(), below.rbegin(), below.rend());
    svg.polygon(outline, look.color, band_opacity, {"", 0, "", 1});
  }
  const std::vector<Point> line = panel.line(across, weights.mean);
  svg.polyline(line, {look.color, 1, look.dash, 0.75});
  for (const Point& point : line) svg.marker(point, {look.marker, look.color, 5, true});
}

}  // namespace

double draw_weights(Svg& svg, const Material& material, double top) {
  std::vector<std::string> signals;
  std::vector<std::string> series;
  for (const PredictedWeights& weights : material.predicted) {
    (void)place_of(signals, weights.signal);
    (void)place_of(series, series_name(weights.labels));
  }
  if (signals.empty()) {
    for (const TrainingWeights& row : material.training) {
      for (const std::string& column : row.columns) (void)place_of(signals, column);
    }
  }
  const bool whiskers = series.size() <= most_whiskers;
  const std::string unit = unit_of_weights(material);
  for (const std::string& signal : signals) {
    Range across;
    Range up;
    for (const TrainingWeights& row : material.training) {
      const Vector weights = weights_of(row, signal);
      if (weights.size() == 0) continue;
      across.include(1);
      across.include(static_cast<double>(weights.size()));
      up.include(weights);
    }
    for (const PredictedWeights& weights : material.predicted) {
      if (weights.signal != signal) continue;
      across.include(weights.basis);
      up.include(Vector(weights.mean + weights.sd));
      up.include(Vector(weights.mean - weights.sd));
    }
    up.include(0);
    across.include(across.low - 0.6);
    across.include(across.high + 0.6);
    const bool last = signal == signals.back();
    Panel panel({room_left + 8, top + room_above, page_width - room_left - room_right - 8, panel_height}, across,
                up.padded(0.06, 1e-3), "basis function", with_unit("weight of " + signal, unit));
    panel.integers = true;
    panel.texts_below = last;
    panel.draw_ground(svg);
    svg.begin_clip(panel.box);
    svg.line(panel.at(across.low, 0), panel.at(across.high, 0), {grey, 0.8, "", 1});
    for (const TrainingWeights& row : material.training) {
      const Vector weights = weights_of(row, signal);
      if (weights.size() == 0) continue;
      const Vector basis = Vector::LinSpaced(weights.size(), 1, static_cast<double>(weights.size()));
      svg.polyline(panel.line(basis, weights), {"#a0a0a0", 0.8, "", 0.8});
    }
    const double count = static_cast<double>(series.size());
    for (const PredictedWeights& weights : material.predicted) {
      if (weights.signal != signal) continue;
      const std::size_t i = place_of(series, series_name(weights.labels));
      const double shift = whiskers && count > 1 ? spread * (static_cast<double>(i) / (count - 1) - 0.5) : 0;
      draw_prediction(svg, panel, weights, look(i), shift, whiskers);
    }
    svg.end_clip();
    panel.draw_frame(svg);
    top += room_above + panel_height + (last ? room_below : 4);
  }
  std::vector<LegendEntry> entries;
  if (!material.training.empty()) {
    entries.push_back({fmt::format("training rows ({})", material.training.size()), Stroke{"#a0a0a0", 1, "", 1}});
  }
  const bool named = series.size() > 1 || (series.size() == 1 && !series[0].empty());
  if (!series.empty() && (!named || series.size() > most_entries)) {
    entries.push_back({"predicted, one standard deviation", Stroke{look(0).color, 1.2, "", 1},
                       Marker{look(0).marker, look(0).color, 5, true}});
  } else if (named) {
    entries.push_back({"predicted, with one standard deviation, for target"});
    for (std::size_t i = 0; i < series.size(); ++i) {
      const Look own = look(i);
      entries.push_back({series[i], Stroke{own.color, 1.2, own.dash, 1}, Marker{own.marker, own.color, 6, true}});
    }
  }
  return top + draw_legend(svg, entries, {10, top, page_width - 20, 0});
}

}  // namespace lfd::plot
