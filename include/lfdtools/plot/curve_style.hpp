// Which curve gets which line: targets by colour, roles by weight.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lfdtools/plot/legend.hpp"
#include "lfdtools/plot/material.hpp"
#include "lfdtools/plot/palette.hpp"

namespace lfd::plot {

/// The end that belongs to a target.
struct TargetEnd {
  std::string name;  ///< of the series
  Vector position;   ///< D
};

/// Lines of the curves of one figure. The targets of one role have colours: of motions, where there are demonstrations
/// or references of other origin to see them among, else of the role that stands lowest. Demonstrations behind motions
/// are light, references are black or grey.
class CurveStyle {
 public:
  explicit CurveStyle(const Material& material);

  [[nodiscard]] Stroke stroke(const Curve& curve) const;
  /// Whether a white line goes below it, so that it is seen on lines of its own kind.
  [[nodiscard]] bool cased(const Curve& curve) const;
  /// Roles that occur, in words, and the coloured targets, as long as there are not too many.
  [[nodiscard]] std::vector<LegendEntry> legend() const;
  /// Where each target is: its goal, else the goal of its reference, else the mean last sample of its curves.
  [[nodiscard]] const std::vector<TargetEnd>& ends() const { return ends_; }
  /// "goal" or what stands for it.
  [[nodiscard]] const std::string& ends_name() const { return ends_name_; }

 private:
  void find_ends(const Material& material);
  [[nodiscard]] Look look_of(std::size_t series) const;

  std::map<Role, std::size_t> counts_;         // curves of each role
  Role colored_ = Role::motion;                // whose targets have colours
  std::map<std::string, std::size_t> series_;  // number of each coloured target
  std::vector<std::string> names_;             // in that order
  bool many_ = false;                          // curves of the coloured role lie upon each other
  std::vector<TargetEnd> ends_;
  std::string ends_name_;
};

}  // namespace lfd::plot
