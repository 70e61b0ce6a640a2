#include "lfdtools/joint_curve.hpp"

namespace lfd {
namespace {

constexpr double least_knot_distance = 1e-4;  // [rad]
constexpr double least_length = 1e-9;         // of a curve that has a spline [rad]

}  // namespace

JointCurve::JointCurve(const Samples& joints) : along_(Vector::Zero(joints.rows())), start_(joints.topRows(1)) {
  const Eigen::Index T = joints.rows();
  for (Eigen::Index t = 1; t < T; ++t) along_[t] = along_[t - 1] + (joints.row(t) - joints.row(t - 1)).norm();
  knots_ = {0};
  for (Eigen::Index t = 1; t < T; ++t) {
    if (along_[t] - along_[knots_.back()] > least_knot_distance) knots_.push_back(t);
  }
  if (knots_.back() != T - 1) {
    if (knots_.size() > 1) knots_.pop_back();
    knots_.push_back(T - 1);
  }
  if (length() > least_length) spline_.emplace(Vector(along_(knots_)), Samples(joints(knots_, Eigen::all)));
}

Samples JointCurve::operator()(const Vector& s) const {
  return spline_ ? (*spline_)(s) : Samples(start_.replicate(s.size(), 1));
}

}  // namespace lfd
