// The figure that suits a material.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/io/message.hpp"
#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/motion_picture.hpp"

namespace lfd::plot {

enum class PictureKind {
  automatic,   ///< by the content
  motions,     ///< planes, and signals against time below
  planes,      ///< planes alone
  time,        ///< signals against time alone
  weights,     ///< weights by basis function
  errors,      ///< leave-one-target-out errors as bars
  reliability  ///< observed against nominal shares
};

struct PictureOptions {
  PictureKind kind = PictureKind::automatic;
  std::vector<Plane> planes;  ///< empty: default_planes
  std::string title;          ///< above the figure; empty: none
};

/// The picture that the material asks for: its errors, its reliability, its predicted or (without curves) training
/// weights, planes where there is an obstacle, motions where signals are positions, else time.
/// @throws DataError [plot.several_pictures] if it asks for more than one
[[nodiscard]] PictureKind suitable_kind(const Material& material);

/// The whole SVG document.
/// @throws DataError [plot.nothing_to_draw] if the material has nothing for the kind, [plot.several_pictures],
///         [plot.no_such_signal], [plot.out_of_range]
[[nodiscard]] std::string draw(const Material& material, const PictureOptions& options, Messages& messages);

/// Planes from words such as x-y. @throws UsageError [usage.value]
[[nodiscard]] std::vector<Plane> planes_of(const std::vector<std::string>& words);

}  // namespace lfd::plot
