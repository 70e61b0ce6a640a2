// How far a hand may be off along a path: a Gaussian error of its position, correlated over the samples.
#pragma once

#include <vector>

#include "lfdtools/rotation.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// A Gaussian error of the hand's position along a path of T samples, in the base; the orientation is exact.
struct HandSpread {
  Matrix factor;  ///< 3 T x K, by sample, then by axis: covariance = factor factor^T [m]

  [[nodiscard]] Eigen::Index samples() const { return factor.rows() / 3; }
};

/// From covariances as `lfdtools.covariance` files hold them.
/// @param covariance  three of T x T, or one of 3 T x 3 T, by signal, then by time [m^2]
/// @param rotation  of the file's frame in the base
/// @throws DataError [hand_spread.shape], [hand_spread.not_positive] if one is not positive semidefinite
[[nodiscard]] HandSpread hand_spread(const std::vector<Matrix>& covariance, const Matrix3& rotation);

/// Share of the way that a hand has covered at each sample, 0 at the first and 1 at the last; 1 throughout where it
/// does not move. @param positions  T x 3
[[nodiscard]] Vector share_of_way(const Samples& positions);

/// A shift of the whole path, of standard deviation sd(a) share[t] along axis a.
/// @param sd  in the file's frame [m]   @param share  T   @param rotation  of that frame in the base
[[nodiscard]] HandSpread hand_shift(const Vector3& sd, const Vector& share,
                                    const Matrix3& rotation = Matrix3::Identity());

/// Both errors at once, which are independent of each other.
/// @throws DataError [hand_spread.shape] if they differ in samples
[[nodiscard]] HandSpread together(const HandSpread& a, const HandSpread& b);

}  // namespace lfd
