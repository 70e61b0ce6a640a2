// Where paths of a hand are drawn when those that touch are sought. For touching.cpp alone.
#pragma once

#include <vector>

#include "lfdtools/random.hpp"
#include "lfdtools/rotation.hpp"

namespace lfd {

/// Errors dx of the hand at one place where slope . dx <= -threshold sd(slope . dx).
struct HalfSpace {
  std::size_t place = 0;
  Vector3 slope;
  double threshold = 0.0;  ///< [standard deviations]
};

/// A mixture from which errors of the hand's path, z of z ~ N(0, I) and dx = F z, are drawn, and by which they count:
///   0.1  the spread itself, so that no draw counts over 10
///   0.2  one place after another three times as wide, whatever the direction: what no half space foresees
///   0.7  half spaces, most where they are likely, three tenths of them alike at all places, for what is rare
/// (importance sampling with a mixture of known densities, Owen and Zhou 2000; the union of half spaces by the number
/// of them that a draw lies in, Karp and Luby 1983).
class PathProposal {
 public:
  /// @param factor  F, 3 P x K, by place, then by axis [m]
  PathProposal(Matrix factor, const std::vector<HalfSpace>& half_spaces);

  [[nodiscard]] const Matrix& factor() const { return factor_; }

  /// @param at  in [0, 1): which part of the mixture, so that draws can be spread evenly over them
  [[nodiscard]] Vector draw(double at, Random random) const;

  /// Density of the spread over that of the mixture, 0 to 10. @param dx  F z, 3 P
  [[nodiscard]] double weight(const Eigen::Ref<const Vector>& dx) const;

 private:
  struct Part {
    std::size_t place;
    Vector3 slope;  ///< over the standard deviation: slope . dx is a standard normal
    double threshold;
    double density;  ///< share of the draws over probability
  };

  /// W, r x 3, r the axes along which the hand may be off: W dx ~ N(0, I).
  using Whitening = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>;
  [[nodiscard]] static Whitening whitening(const Eigen::Ref<const Matrix>& F);

  [[nodiscard]] Eigen::Index places() const { return factor_.rows() / 3; }
  [[nodiscard]] static Vector3 at_place(const Eigen::Ref<const Vector>& dx, Eigen::Index place) {
    return dx.segment<3>(3 * place);
  }

  Matrix factor_;
  std::vector<Whitening> whitening_;  // by place
  std::vector<Part> parts_;
  std::vector<double> up_to_;  // shares of the parts, summed from `wide`
  double wide_ = 0.0;          // up to here the spread itself and single places
};

}  // namespace lfd
