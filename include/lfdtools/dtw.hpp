// Dynamic time warping of two series (paper section III-A, Table 1 step 1).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "lfdtools/linalg.hpp"

namespace lfd {

/// What limits the path.
struct DtwOptions {
  /// Sakoe-Chiba band: half-width in samples, as a fraction in (0, 1] of the longer series. Cell (i, j) is open where
  /// |i - j| <= max(ceil(window L), |T_a - T_b|), the second term so that a path exists. At 1 there is no band, as
  /// without a value.
  std::optional<double> window;
};

/// The cheapest path and what it costs.
struct DtwPath {
  double cost = 0;  ///< sum of local distances over the steps [unit of the signals]
  std::vector<std::pair<Eigen::Index, Eigen::Index>> steps;  ///< (row of a, row of b), from (0, 0) to the last rows
};

/// Cost of the cheapest path through the local Euclidean distances |a_i - b_j| with steps (1,0), (0,1), (1,1), each
/// cell on the path counted once:  D(i,j) = |a_i - b_j| + min(D(i-1,j-1), D(i-1,j), D(i,j-1)). The same bits with a and
/// b exchanged. Three anti-diagonals of memory.
/// @param a, b  T_a x D and T_b x D, T_a, T_b >= 1, D >= 1
/// @throws DataError [dtw.empty] [dtw.dimensions] [dtw.not_finite] [dtw.overflow], UsageError [dtw.window] outside (0,
/// 1]
[[nodiscard]] double dtw_cost(const Samples& a, const Samples& b, const DtwOptions& options = {});

/// The same cost with the path; of equally cheap steps the diagonal one is taken. 2 bits of memory a cell of the band.
/// @param a, b  as dtw_cost   @throws as dtw_cost
[[nodiscard]] DtwPath dtw(const Samples& a, const Samples& b, const DtwOptions& options = {});

}  // namespace lfd
