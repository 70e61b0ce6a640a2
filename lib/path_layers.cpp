#include "path_layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lfd {
namespace {

bool has_free_wrist(const SolutionLayer& layer) {
  return std::any_of(layer.begin(), layer.end(), [](const IkSolution& s) { return s.wrist_free; });
}

/// The same shoulder and elbow, see branch_name.
bool same_arm(const IkSolution& a, const IkSolution& b) {
  return (a.branch & 5) == (b.branch & 5);
}

/// Adds the solution of a singular wrist with q6 as near as can be to the given value, for the same shoulder and elbow.
void add_with_q6(const InverseKinematics& arm, const Pose& pose, double tolerance, const IkSolution& like, double q6,
                 SolutionLayer& layer) {
  IkOptions options;
  options.tolerance = tolerance;
  options.seed = like.joints;
  (*options.seed)[5] = q6;
  for (const IkSolution& solution : arm(pose, options)) {
    if (!solution.wrist_free || !same_arm(solution, like)) continue;
    const bool known = std::any_of(layer.begin(), layer.end(), [&](const IkSolution& other) {
      return same_arm(other, solution) && std::abs(wrap_angle(other.joints[5] - solution.joints[5])) < 1e-9;
    });
    if (!known) layer.push_back(solution);
  }
}

/// Where the wrist is singular over samples first..last, q6 may be anything, and the solver's own choice need not meet
/// that of the neighbours. Adds q6 going evenly in time from every neighbour before to every one after, or staying as
/// on the one side there is, or, with no neighbours, at eight constant values.
void connect_free_wrists(const InverseKinematics& arm, const std::vector<Pose>& flange, const Vector& times,
                         double tolerance, std::vector<SolutionLayer>& layers, std::size_t first, std::size_t last) {
  const bool has_before = first > 0, has_after = last + 1 < layers.size();
  const double begin = times[static_cast<Eigen::Index>(has_before ? first - 1 : first)];
  const double end = times[static_cast<Eigen::Index>(has_after ? last + 1 : last)];
  for (std::size_t t = first; t <= last; ++t) {
    const auto add = [&](const IkSolution& like, double q6) {
      add_with_q6(arm, flange[t], tolerance, like, q6, layers[t]);
    };
    const double share = (times[static_cast<Eigen::Index>(t)] - begin) / std::max(end - begin, 1e-300);
    if (has_before && has_after) {
      for (const IkSolution& before : layers[first - 1]) {
        for (const IkSolution& after : layers[last + 1]) {
          if (!same_arm(before, after)) continue;
          add(before, before.joints[5] + share * wrap_angle(after.joints[5] - before.joints[5]));
        }
      }
    } else if (has_before || has_after) {
      const SolutionLayer& side = has_before ? layers[first - 1] : layers[last + 1];
      for (const IkSolution& neighbour : side) add(neighbour, neighbour.joints[5]);
    } else {
      const SolutionLayer own = layers[t];
      for (const IkSolution& like : own) {
        for (int eighth = 0; eighth < 8; ++eighth) add(like, eighth * std::numbers::pi / 4.0);
      }
    }
  }
}

}  // namespace

std::vector<SolutionLayer> solve_layers(const InverseKinematics& arm, const std::vector<Pose>& flange,
                                        const Vector& times, const IkOptions& options) {
  std::vector<SolutionLayer> layers;
  layers.reserve(flange.size());
  for (const Pose& pose : flange) {
    const IkSolutions found = arm(pose, options);
    layers.emplace_back(found.begin(), found.end());
  }
  for (std::size_t first = 0; first < layers.size(); ++first) {
    if (!has_free_wrist(layers[first])) continue;
    std::size_t last = first;
    while (last + 1 < layers.size() && has_free_wrist(layers[last + 1])) ++last;
    connect_free_wrists(arm, flange, times, options.tolerance, layers, first, last);
    first = last;
  }
  return layers;
}

}  // namespace lfd
