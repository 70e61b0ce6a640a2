// Edges of the layered graph, and which whole turns of the joints its ways may need. For posture_graph.cpp alone.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "lfdtools/posture_graph.hpp"

namespace lfd {

using Layers = std::vector<std::vector<Posture>>;

inline constexpr double turn = 2.0 * std::numbers::pi;
/// Added to the ratio of a step that is a jump: no number of slow steps is worth one.
inline constexpr double jump_cost = 1e6;

/// The motion between two postures of successive layers, each joint by the shorter way round. It is the same for all
/// whole turns of the first posture, so sums along ways that differ by turns alone are equal to the bit.
struct Edge {
  double ratio = 0.0;    // largest |dq_j| / (v_j dt), plus jump_cost for a jump
  double seconds = 0.0;  // largest |dq_j| / v_j
  bool changes_branch = false;
  std::array<int, 6> turns{};  // of the second posture, when the first has none
  [[nodiscard]] bool jumps() const { return ratio >= jump_cost; }
};

/// The joints whose whole turns are counted, and between which angles.
struct TurnWindow {
  std::array<bool, 6> counted{};
  Eigen::Matrix<double, 6, 2> range;  ///< lower, upper [rad]
};

/// A joint that no way takes out of its range needs no turns counted: its start is the one nearest to the seed. The
/// others are looked at as many turns from there as a way could need, fewer if that would be over 1024 states of one
/// posture; ranges of two turns either way, which arms have, take up to 3^6.
/// @param edges    of each layer but the first, from every posture of the one before to every one of its own
/// @param range    of the joints, lower, upper [rad]
/// @param jumping  ways with jumps count
[[nodiscard]] TurnWindow turn_window(const Layers& layers, const std::vector<std::vector<Edge>>& edges,
                                     const Eigen::Matrix<double, 6, 2>& range, const std::optional<Joints>& seed,
                                     bool jumping);

}  // namespace lfd
