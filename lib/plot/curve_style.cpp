#include "lfdtools/plot/curve_style.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/plot/palette.hpp"

namespace lfd::plot {
namespace {

constexpr std::size_t most_entries = 21;  // targets that a legend names
constexpr std::size_t most_curves = 3;    // of a target, until lines become thin

const char* words(Role role) {
  return role == Role::demonstration ? "demonstrations" : role == Role::reference ? "references" : "motions";
}

}  // namespace

CurveStyle::CurveStyle(const Material& material) {
  for (const Curve& curve : material.curves) ++counts_[curve.role];
  if (!counts_.contains(Role::motion) && !counts_.empty()) colored_ = counts_.begin()->first;
  for (const Curve& curve : material.curves) {
    if (curve.role != colored_) continue;
    const std::string name = series_name(curve.labels);
    if (series_.emplace(name, series_.size()).second) names_.push_back(name);
  }
  many_ =
      counts_.contains(colored_) && (counts_[colored_] > most_curves * names_.size() || names_.size() > most_entries);
  find_ends(material);
}

void CurveStyle::find_ends(const Material& material) {
  const auto add = [&](const std::string& name, const Vector& position) {
    const auto same = std::find_if(ends_.begin(), ends_.end(), [&](const TargetEnd& end) { return end.name == name; });
    if (same == ends_.end()) ends_.push_back({name, position});
  };
  for (const Goal& goal : material.goals) ends_.push_back({series_name(goal.labels), goal.position});
  for (const Curve& curve : material.curves) {
    if (curve.goal) add(series_name(curve.labels), *curve.goal);
  }
  ends_name_ = ends_.empty() ? "end" : "goal";
  std::map<std::string, std::pair<Vector, double>> sums;
  for (const Curve& curve : material.curves) {
    const Vector end = curve.trajectory.goal();
    const auto [sum, is_new] = sums.try_emplace(series_name(curve.labels), end, 1.0);
    if (is_new) continue;
    sum->second.first += end;
    sum->second.second += 1;
    if (ends_name_ == "end") ends_name_ = "mean end";
  }
  for (const Curve& curve : material.curves) {
    const std::string name = series_name(curve.labels);
    add(name, sums[name].first / sums[name].second);
  }
}

Stroke CurveStyle::stroke(const Curve& curve) const {
  if (curve.role == colored_) {
    const Look own = look_of(series_.at(series_name(curve.labels)));
    return many_ ? Stroke{own.color, 0.7, own.dash, 0.5} : Stroke{own.color, 1.6, own.dash, 1};
  }
  if (curve.role == Role::demonstration) return {light_grey, 0.6, "", 0.8};
  return colored_ == Role::motion ? Stroke{"#5a5a5a", 0.9, "", 1} : Stroke{black, 1.2, "", 1};
}

Look CurveStyle::look_of(std::size_t series) const {
  return many_ ? dense_look(series) : look(series);
}

bool CurveStyle::cased(const Curve& curve) const {
  if (counts_.size() < 2 || curve.role == Role::demonstration) return false;
  return curve.role == colored_ ? !many_ : colored_ == Role::demonstration;
}

std::vector<LegendEntry> CurveStyle::legend() const {
  std::vector<LegendEntry> entries;
  for (const auto& [role, count] : counts_) {
    if (role == colored_) continue;
    Curve curve;
    curve.role = role;
    entries.push_back({words(role), stroke(curve)});
  }
  if (names_.empty()) return entries;
  const bool named = names_.size() > 1 || !names_[0].empty();
  if (named && names_.size() <= most_entries) {
    entries.push_back({fmt::format("{} to target", words(colored_))});
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const Look own = look_of(i);
      entries.push_back({names_[i], Stroke{own.color, 1.8, own.dash, 1}});
    }
  } else {
    const std::string count = named ? fmt::format(" to {} targets, by colour", names_.size()) : "";
    entries.push_back({words(colored_) + count, Stroke{look(0).color, 1.6, "", 1}});
  }
  return entries;
}

}  // namespace lfd::plot
