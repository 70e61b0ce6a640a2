#include "posture_turns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lfd {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double most_states = 1024.0;

/// From the start turn nearest to the seed (or zero), how far down and up any way takes a joint [rad].
std::pair<double, double> reach_of(const Layers& layers, const std::vector<std::vector<Edge>>& edges, bool jumping,
                                   Eigen::Index j, double centre) {
  double down = infinity, up = -infinity;
  std::vector<std::pair<double, double>> turns;  // fewest and most of each posture; none yet: the first above
  for (const Posture& posture : layers[0]) {
    const double n = std::nearbyint((centre - posture.joints[j]) / turn);
    turns.emplace_back(n, n);
  }
  for (std::size_t t = 0; t < layers.size(); ++t) {
    if (t > 0) {
      std::vector<std::pair<double, double>> next(layers[t].size(), {infinity, -infinity});
      for (std::size_t k = 0; k < edges[t].size(); ++k) {
        const Edge& e = edges[t][k];
        const auto& from = turns[k / next.size()];
        if (e.jumps() && !jumping) continue;
        auto& to = next[k % next.size()];
        to.first = std::min(to.first, from.first + e.turns[static_cast<std::size_t>(j)]);
        to.second = std::max(to.second, from.second + e.turns[static_cast<std::size_t>(j)]);
      }
      turns = std::move(next);
    }
    for (std::size_t i = 0; i < turns.size(); ++i) {
      down = std::min(down, layers[t][i].joints[j] + turn * turns[i].first);
      up = std::max(up, layers[t][i].joints[j] + turn * turns[i].second);
    }
  }
  return {down, up};
}

}  // namespace

TurnWindow turn_window(const Layers& layers, const std::vector<std::vector<Edge>>& edges,
                       const Eigen::Matrix<double, 6, 2>& range, const std::optional<Joints>& seed, bool jumping) {
  TurnWindow window{{}, range};
  std::array<double, 6> centre{}, width{};
  for (std::size_t j = 0; j < 6; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const double wanted = seed ? (*seed)[row] : 0.0;
    const auto [down, up] = reach_of(layers, edges, jumping, row, wanted);
    window.counted[j] = !(down >= range(row, 0) && up <= range(row, 1));
    if (!window.counted[j]) continue;
    centre[j] = std::clamp(wanted, range(row, 0), range(row, 1));
    width[j] = up >= down ? 2.0 * std::ceil((up - down) / turn) + 3.0 : 0.0;  // turns either way
    width[j] = std::min(width[j], most_states);
  }
  const auto narrow = [&](std::size_t j) {
    const auto row = static_cast<Eigen::Index>(j);
    window.range(row, 0) = std::max(range(row, 0), centre[j] - turn * width[j]);
    window.range(row, 1) = std::min(range(row, 1), centre[j] + turn * width[j]);
    return std::floor((window.range(row, 1) - window.range(row, 0)) / turn) + 1.0;
  };
  while (true) {
    double states = 1.0, most = 0.0;
    std::size_t widest = 0;
    for (std::size_t j = 0; j < 6; ++j) {
      if (!window.counted[j]) continue;
      const double count = narrow(j);
      states *= count;
      if (count > most) widest = j;
      most = std::max(most, count);
    }
    if (states <= most_states) return window;
    width[widest] -= width[widest] > 1.0 ? 1.0 : 0.25;
  }
}

}  // namespace lfd
