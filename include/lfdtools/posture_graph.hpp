// The layered graph of arm configurations along a path, and the best way through it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lfdtools/dh.hpp"

namespace lfd {

/// One configuration that reaches a sample of the path.
struct Posture {
  Joints joints = Joints::Zero();  ///< [rad], each stands for all angles that differ by whole turns
  int branch = 0;
  int border = 0;  ///< bits of the branch that are on either side, see border_bits
};

/// What decides between ways through the graph, see best_way.
struct GraphOptions {
  std::optional<Joints> seed;  ///< start near these joints, whole turns counted
  double max_step = 0.5;       ///< a joint that moves further is a jump [rad]
  double step_slack = 1.1;  ///< largest step, as a factor of the smallest possible, that still counts as equally good
  bool respect_limits = true;  ///< whole turns only within the joint ranges
};

/// A way through the graph, or how far any got.
struct Way {
  std::vector<int> posture;    ///< T indices, one a layer; empty if no way stays within the joint ranges
  Samples joints;              ///< T x 6 [rad], whole turns included
  double largest_ratio = 0.0;  ///< largest |dq_j| / (v_j dt) along the way
  Eigen::Index blocked = 0;    ///< first layer that no way within the joint ranges comes to
};

/// The best way, from the whole turns nearest to the seed (without one: to zero), joint ranges left aside; if it leaves
/// them, the best of all ways and turns that keep them. What decides, in this order:
/// - the start nearest to the seed, if there is one (sum of squares of joint differences over speed limits), of those
///   from which a way without jumps goes on;
/// - the largest joint speed over its limit: smallest possible up to step_slack;
/// - fewest jumps, then fewest changes of branch, those to or from a border aside;
/// - least sum over time of the largest joint motion over its speed limit [s];
/// - smallest start angles (sum of squares), lowest indices.
/// Successive angles differ by at most half a turn. Of joints that some way takes out of their ranges, whole turns as
/// far from the seed (without one: from zero) are looked at as ways wind, so that ranges of any width will do; where
/// several such ranges are wider than arms have them, fewer, up to 1024 combinations.
/// @param layers  T >= 1, none of them empty
/// @param times   T, strictly rising [s]
[[nodiscard]] Way best_way(const std::vector<std::vector<Posture>>& layers, const Vector& times,
                           const JointLimits& limits, const GraphOptions& options = {});

}  // namespace lfd
