#include "retime_excess.hpp"

#include <algorithm>
#include <cmath>

namespace lfd::retiming {

double Limits::tip_share(const Joints& position, const Joints& velocity) const {
  const Jacobian J = jacobian(robot_, position, options_.tool.position);
  return (J.topRows<3>() * velocity).norm() / *options_.tip_speed;
}

double Limits::speed_share(const Joints& position, const Joints& velocity) const {
  const double joint = velocity.cwiseAbs().cwiseQuotient(options_.velocity).maxCoeff();
  return options_.tip_speed ? std::max(joint, tip_share(position, velocity)) : joint;
}

double Limits::acceleration_share(const Joints& acceleration) const {
  return acceleration.cwiseAbs().cwiseQuotient(options_.acceleration).maxCoeff();
}

Vector Limits::excess_of(const CubicSpline& spline, const Vector& times) const {
  Vector excess(times.size());
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    // The second derivative is linear between two rows, and largest at one; the first is a parabola.
    excess[k] = std::sqrt(acceleration_share(spline.second_derivatives().row(k).transpose()));
    if (k == 0) continue;
    const Vector quarters = Vector::LinSpaced(5, times[k - 1], times[k]);
    const Samples speeds = spline.derivative(quarters);
    const Joints speed =
        largest_between(speeds.row(0).transpose(), speeds.row(2).transpose(), speeds.row(4).transpose());
    excess[k] = std::max(excess[k], speed.cwiseQuotient(options_.velocity).maxCoeff());
    if (!options_.tip_speed) continue;
    const Samples joints = spline(quarters);
    for (Eigen::Index i = 0; i < quarters.size(); ++i) {
      excess[k] = std::max(excess[k], tip_share(joints.row(i).transpose(), speeds.row(i).transpose()));
    }
  }
  return excess;
}

Joints largest_between(const Joints& begin, const Joints& middle, const Joints& end) {
  Joints largest = begin.cwiseAbs().cwiseMax(end.cwiseAbs());
  for (int j = 0; j < 6; ++j) {
    const double square = 2.0 * (begin[j] - 2.0 * middle[j] + end[j]), slope = end[j] - begin[j] - square;
    const double turn = -slope / (2.0 * square);
    if (turn > 0.0 && turn < 1.0) largest[j] = std::max(largest[j], std::abs(begin[j] + 0.5 * turn * slope));
  }
  return largest;
}

}  // namespace lfd::retiming
