// The curve that a motion along rows of joints follows.
#pragma once

#include <optional>
#include <vector>

#include "lfdtools/interpolation.hpp"

namespace lfd {

/// The cubic spline through rows of joints over their summed distances in joint space. Rows nearer than a
/// ten-thousandth of a radian to the one before lie on the spline of the others.
class JointCurve {
 public:
  /// @param joints  T x D, T >= 2, finite [rad]
  explicit JointCurve(const Samples& joints);

  /// Summed distance of each row, T, the first 0 [rad].
  [[nodiscard]] const Vector& along() const { return along_; }
  [[nodiscard]] double length() const { return along_[along_.size() - 1]; }
  /// Whether all rows are the same, to a thousand-millionth of a radian; there is no spline then.
  [[nodiscard]] bool at_rest() const { return !spline_; }
  /// The rows that the spline goes through, the first and the last among them.
  [[nodiscard]] const std::vector<Eigen::Index>& knots() const { return knots_; }
  /// Second derivatives at the knots [1/rad]; not of a curve at rest.
  [[nodiscard]] const Samples& second_derivatives() const { return spline_->second_derivatives(); }
  /// Joints at distances from the start, m x D [rad].
  [[nodiscard]] Samples operator()(const Vector& s) const;

 private:
  Vector along_;
  Samples start_;
  std::vector<Eigen::Index> knots_;
  std::optional<CubicSpline> spline_;
};

}  // namespace lfd
