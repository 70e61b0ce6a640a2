#include "lfdtools/plot/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lfdtools/error.hpp"
#include "lfdtools/plot/error_picture.hpp"
#include "lfdtools/plot/panel.hpp"
#include "lfdtools/plot/reliability_picture.hpp"
#include "lfdtools/plot/weight_picture.hpp"

namespace lfd::plot {
namespace {

constexpr double title_size = 13;

bool has_motions(const Material& material) {
  return !material.curves.empty() || !material.mixtures.empty() || !material.goals.empty();
}

/// What a kind draws; nullptr if the material has it.
const char* missing_for(const Material& material, PictureKind kind, const std::vector<Plane>& planes) {
  switch (kind) {
    case PictureKind::motions:
    case PictureKind::planes:
      if (!has_motions(material) && material.obstacles.empty()) return "demonstrations, references, motions or goals";
      return planes.empty() ? "signals of which two are positions x, y, z (--planes names others)" : nullptr;
    case PictureKind::time:
      return material.curves.empty() && material.mixtures.empty() ? "a table with a time t" : nullptr;
    case PictureKind::weights:
      return material.predicted.empty() && material.training.empty() ? "weights" : nullptr;
    case PictureKind::errors:
      return material.errors.empty() ? "leave-one-target-out errors" : nullptr;
    case PictureKind::reliability:
      return material.reliability.empty() ? "reliability" : nullptr;
    case PictureKind::automatic:
      break;
  }
  return nullptr;
}

/// Title of the document where the user has none: it is read out, not drawn.
const char* heading(PictureKind kind) {
  switch (kind) {
    case PictureKind::motions:
      return "Motions in planes and against time";
    case PictureKind::planes:
      return "Motions in planes";
    case PictureKind::time:
      return "Signals against time";
    case PictureKind::weights:
      return "Weights of movement primitives";
    case PictureKind::errors:
      return "Errors at targets that were left out";
    default:
      return "Reliability of bands";
  }
}

double draw_motions(Svg& svg, const Material& material, PictureKind kind, const std::vector<Plane>& planes,
                    double top) {
  const CurveStyle style(material);
  const bool with_planes = kind != PictureKind::time;
  const bool with_times = kind != PictureKind::planes && !(material.curves.empty() && material.mixtures.empty());
  if (with_planes) top = draw_planes(svg, material, style, planes, top);
  if (with_times) top = draw_times(svg, material, style, top);
  return draw_motion_legend(svg, material, style, with_planes, with_times, top);
}

}  // namespace

PictureKind suitable_kind(const Material& material) {
  std::vector<PictureKind> kinds;
  if (!material.errors.empty()) kinds.push_back(PictureKind::errors);
  if (!material.reliability.empty()) kinds.push_back(PictureKind::reliability);
  const bool motions = has_motions(material) || !material.obstacles.empty();
  if (!material.predicted.empty() || (!material.training.empty() && !motions)) kinds.push_back(PictureKind::weights);
  if (motions) {
    const bool positions = !default_planes(material).empty();
    kinds.push_back(!positions                                               ? PictureKind::time
                    : !material.obstacles.empty() || material.curves.empty() ? PictureKind::planes
                                                                             : PictureKind::motions);
    // A mixture alone is over time.
    if (material.curves.empty() && !material.mixtures.empty()) kinds.back() = PictureKind::time;
  }
  if (kinds.size() > 1) {
    throw DataError("plot.several_pictures",
                    fmt::format("the inputs ask for different pictures, and --kind chooses one: there are {}",
                                fmt::join(material.found, ", ")));
  }
  return kinds.empty() ? PictureKind::planes : kinds[0];
}

std::string draw(const Material& material, const PictureOptions& options, Messages& messages) {
  const PictureKind kind = options.kind == PictureKind::automatic ? suitable_kind(material) : options.kind;
  const std::vector<Plane> planes = options.planes.empty() ? default_planes(material) : options.planes;
  if (const char* missing = missing_for(material, kind, planes)) {
    throw DataError("plot.nothing_to_draw",
                    fmt::format("this picture needs {}, and there are {}", missing, fmt::join(material.found, ", ")));
  }
  const bool of_motions = kind == PictureKind::motions || kind == PictureKind::planes || kind == PictureKind::time;
  if (of_motions && !material.training.empty()) {
    messages.note("plot.not_drawn", "weights are not drawn among motions: --kind weights draws them");
  }
  Svg svg;
  double bottom = 2;
  if (!options.title.empty()) {
    svg.text({page_width / 2, 20}, options.title, {.size = title_size, .anchor = Anchor::middle, .bold = true});
    bottom = 24;
  }
  if (of_motions) bottom = draw_motions(svg, material, kind, planes, bottom);
  if (kind == PictureKind::weights) bottom = draw_weights(svg, material, bottom);
  if (kind == PictureKind::errors) bottom = draw_errors(svg, material, bottom);
  if (kind == PictureKind::reliability) bottom = draw_reliability(svg, material, bottom);
  return svg.document(page_width, bottom + 6, options.title.empty() ? heading(kind) : options.title);
}

std::vector<Plane> planes_of(const std::vector<std::string>& words) {
  std::vector<Plane> planes;
  for (const std::string& word : words) {
    const std::size_t dash = word.find('-');
    if (dash == 0 || dash == std::string::npos || dash + 1 == word.size()) {
      throw UsageError("usage.value", fmt::format("--planes takes pairs of signals such as x-y, not '{}'", word));
    }
    planes.emplace_back(word.substr(0, dash), word.substr(dash + 1));
  }
  return planes;
}

}  // namespace lfd::plot
