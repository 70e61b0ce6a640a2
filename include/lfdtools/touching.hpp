// How likely an arm touches what it passes, where the path of its hand is known only so well.
#pragma once

#include <cstdint>
#include <vector>

#include "lfdtools/clearance.hpp"

namespace lfd {

/// A Gaussian error of the hand's position along a path of T samples, in the base; the orientation is exact.
struct HandSpread {
  Matrix factor;  ///< 3 T x K, by sample, then by axis: covariance = factor factor^T [m]

  [[nodiscard]] Eigen::Index samples() const { return factor.rows() / 3; }
};

/// From covariances as `lfdtools.covariance` files hold them.
/// @param covariance  three of T x T, or one of 3 T x 3 T, by signal, then by time [m^2]
/// @param rotation  of the file's frame in the base
/// @throws DataError [touching.shape], [touching.not_positive] if one is not positive semidefinite
[[nodiscard]] HandSpread hand_spread(const std::vector<Matrix>& covariance, const Matrix3& rotation);

/// The spread with one more error, independent of it: a shift of standard deviation sd(a) share[t] along axis a.
/// @param spread  T samples, or none at all   @param sd  [m]   @param share  T
[[nodiscard]] HandSpread with_shift(const HandSpread& spread, const Vector3& sd, const Vector& share);

struct TouchingOptions {
  double margin = 0.0;        ///< touching is being closer than this [m]
  bool self = false;          ///< the arm itself counts too
  Eigen::Index draws = 4096;  ///< of the sum over overlapping events
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
};

/// Probability that the arm touches, by sample and for the samples together.
///
/// An error dx of the hand moves the joints by dq = J^-1 (dx, 0), and each distance by its slope times dq: Gaussian to
/// first order, P(pair) = Phi(-(distance - margin) / sd). A convex solid lies beyond the plane that stands for it, so
/// the first order errs towards touching: 0.066 told for 0.061 counted at an sd of 4 mm, 0.129 for 0.114 at 10 mm, past
/// the end of a rod of 6 cm (touching_test). At the edge or corner of a box it tells up to about 3 times too much where
/// the sd is as large as the rounding that the link gives the edge: 0.253 for 0.106 on a path, 0.194 for 0.060 at one
/// sample; at a flat face it is right, 0.635 for 0.642. The union over pairs and samples is their sum times the mean of
/// 1 / (number of pairs that touch), drawn given that one of them does (Karp and Luby 1983): its relative error does
/// not grow as the probability falls. A single pair needs no draw. The way between samples is no part of it.
/// @param joints  T x 6 [rad]   @param tool  pose of the hand, whose error is told, in the flange frame
/// @throws DataError [touching.shape] if the samples do not agree in number
[[nodiscard]] Touching touching(const ArmClearance& arm, const Samples& joints, const HandSpread& spread,
                                const Pose& tool = {}, const TouchingOptions& options = {});

}  // namespace lfd
