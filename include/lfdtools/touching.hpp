// How likely an arm touches what it passes, where the path of its hand is known only so well.
#pragma once

#include <cstdint>
#include <vector>

#include "lfdtools/clearance.hpp"
#include "lfdtools/hand_spread.hpp"

namespace lfd {

struct TouchingOptions {
  double margin = 0.0;        ///< touching is being no further than this [m]
  bool self = false;          ///< the arm itself counts too
  Eigen::Index draws = 4096;  ///< of the hand's path
  std::uint64_t seed = 1;
};

/// A probability and the standard error of its computation.
struct Chance {
  double probability = 0.0;
  double error = 0.0;
};

/// @see touching
struct Touching {
  std::vector<Chance> samples;  ///< T, of each sample by itself
  Chance path;                  ///< of any sample
  Chance out_of_reach;          ///< that at any sample where something might be touched the hand is out of reach
  Chance path_or_out_of_reach;  ///< of either
};

/// Probability that the arm touches, by sample and for the samples together: paths of the hand are drawn from the
/// spread, joints follow them from where they are (Newton's method through the Jacobian, near singularities the
/// inverse kinematics; orientation kept), and full distances tell which touch.
///
/// So that what is rare is seen too, most paths are drawn where a link touches to first order, where
/// gap + slope J^-1 dx <= margin for an end of its axis, and where the hand is three times as far off as it may be at
/// one sample; a path counts by the ratio of the densities (PathProposal). So the first order decides where to look,
/// not what is told. The way between samples is no part of it, nor is whether the joints' range allows a drawn path;
/// where the hand is out of reach nothing touches, at other samples of that path it may.
/// @param joints  T x 6 [rad]   @param tool  pose of the hand, whose error is told, in the flange frame
/// @throws DataError [touching.shape] if the samples do not agree in number, [touching.not_finite]
[[nodiscard]] Touching touching(const ArmClearance& arm, const Samples& joints, const HandSpread& spread,
                                const Pose& tool = {}, const TouchingOptions& options = {});

}  // namespace lfd
