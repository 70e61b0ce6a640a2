#include "lfdtools/motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

void check(const Vector& times, const Samples& joints) {
  if (times.size() < 1 || joints.rows() != times.size() || joints.cols() != 6) {
    throw DataError("motion.shape",
                    fmt::format("{} times but joints of {} x {}", times.size(), joints.rows(), joints.cols()));
  }
  if (!times.allFinite() || !joints.allFinite()) {
    throw DataError("motion.not_finite", "a joint path has a value that is not a finite number");
  }
  for (Eigen::Index t = 1; t < times.size(); ++t) {
    if (times[t] > times[t - 1]) continue;
    throw DataError("motion.time_not_rising", fmt::format("time {} s is not after {} s", times[t], times[t - 1]));
  }
}

/// |second divided difference| of the rows at the inner samples, exact for parabolas on any spacing.
Samples second_differences(const Vector& times, const Samples& values) {
  Samples result = Samples::Zero(values.rows(), values.cols());
  for (Eigen::Index t = 1; t + 1 < times.size(); ++t) {
    const double before = times[t] - times[t - 1], after = times[t + 1] - times[t];
    result.row(t) = 2.0 / (before + after) *
                    ((values.row(t + 1) - values.row(t)) / after - (values.row(t) - values.row(t - 1)) / before);
  }
  return result;
}

}  // namespace

MotionFigures motion_figures(const Robot& robot, const Vector& times, const Samples& joints, const Pose& tool) {
  check(times, joints);
  const Eigen::Index T = times.size();
  MotionFigures figures;
  figures.range_excess = Samples::Zero(T, 6);
  figures.step = Samples::Zero(T, 6);
  figures.speed = Samples::Zero(T, 6);
  figures.acceleration = second_differences(times, joints).cwiseAbs();
  figures.speed_ratio = Vector::Zero(T);
  figures.acceleration_ratio = Vector::Zero(T);
  figures.tcp_speed = Vector::Zero(T);
  figures.condition = Vector::Zero(T);

  Samples tip(T, 3);
  for (Eigen::Index t = 0; t < T; ++t) {
    const Joints q = joints.row(t).transpose();
    tip.row(t) = (forward_kinematics(robot, q) * tool).position.transpose();
    figures.condition[t] = condition_number(jacobian(robot, q));
    for (int j = 0; j < 6; ++j) {
      const double below = robot.limits.position(j, 0) - q[j], above = q[j] - robot.limits.position(j, 1);
      figures.range_excess(t, j) = std::max({0.0, below, above});
    }
    if (robot.limits.acceleration) {
      const Joints ratios = figures.acceleration.row(t).transpose().cwiseQuotient(*robot.limits.acceleration);
      figures.acceleration_ratio[t] = ratios.maxCoeff();
    }
    if (t == 0) continue;
    const double dt = times[t] - times[t - 1];
    figures.step.row(t) = (joints.row(t) - joints.row(t - 1)).cwiseAbs();
    figures.speed.row(t) = figures.step.row(t) / dt;
    figures.speed_ratio[t] = figures.speed.row(t).transpose().cwiseQuotient(robot.limits.velocity).maxCoeff();
    figures.tcp_speed[t] = (tip.row(t) - tip.row(t - 1)).norm() / dt;
  }
  figures.tcp_acceleration = second_differences(times, tip).rowwise().norm();
  return figures;
}

Worst worst(const Vector& figure) {
  Worst result;
  if (figure.size() > 0) result.value = figure.maxCoeff(&result.sample);
  return result;
}

Worst worst(const Samples& figure) {
  return worst(figure.cols() > 0 ? Vector(figure.rowwise().maxCoeff()) : Vector());
}

}  // namespace lfd
