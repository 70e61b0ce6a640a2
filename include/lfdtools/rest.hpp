// Weights whose motion ends at its goal, at rest, and stays there.
#pragma once

#include "lfdtools/dmp.hpp"

namespace lfd {

/// A fit to a recording that was cut while the hand still moved goes on moving after tau. This changes weights as little
/// as possible, measured by how far the motion moves, so that at tau
///     y = g,  y' = 0,  f = 0,  and f / x -> 0 as x -> 0 (nothing pushes later):
/// four conditions C w = c on the weights of each axis. C is the same for all primitives of the same settings and c is
/// linear in g - y0, so weights that a process predicts linearly from such rows meet them too.
class RestConditions {
 public:
  /// @param A  N x N, invertible: |w A| is the size of the motion that weights w of one axis make (trajectory_metric)
  /// @throws DataError as check(DmpSettings); [rest.too_few_bases] under five basis functions
  RestConditions(const DmpSettings& settings, const Matrix& A);

  /// The primitive's weights, D x N, moved onto the conditions. An axis whose scale is zero keeps its weights.
  [[nodiscard]] Matrix apply(const Dmp& dmp) const;

 private:
  DmpSettings settings_;
  Matrix C_;        // 4 x N, for unit scale and tau = 1
  Matrix correct_;  // N x 4: w -= correct (C w - c)
};

}  // namespace lfd
