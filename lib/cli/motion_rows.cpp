#include "motion_rows.hpp"

#include <fmt/format.h>

#include <numbers>

#include "lfdtools/io/covariance_file.hpp"
#include "lfdtools/metrics.hpp"
#include "motion_goals.hpp"

namespace lfd::cli {

std::string target_prefix(const Labels& labels) {
  return labels.target ? describe(labels) + ": " : std::string();
}

std::vector<std::string> value_columns(const std::vector<std::string>& columns, const MotionRequest& request) {
  auto names = joined({"t"}, columns);
  if (request.derivatives) names = joined(joined(names, prefixed("v_", columns)), prefixed("a_", columns));
  if (!request.sd.empty() && request.samples == 0) names = joined(names, prefixed("sd_", columns));
  if (request.band) names = joined(names, prefixed("band_", columns));
  return names;
}

Samples rows_of(const Motion& motion, const MotionRequest& request) {
  const Samples rows = beside(motion.times, motion.positions);
  return request.derivatives ? beside(rows, beside(motion.velocities, motion.accelerations)) : rows;
}

void report_approach(const Course& course, const Motion& motion, const std::string& name, const MotionRequest& request,
                     Run& run) {
  const Vector along = position(*request.approach, static_cast<std::size_t>(course.goal().size()), "--approach");
  const Samples path = rollout(course, linspace(0, motion.times[motion.times.size() - 1], 2001)).positions;
  const Arrival line{course.goal(), along.normalized()};
  const double angle = angle_between(arrival(path).direction, line.direction);
  const double lateral = lateral_deviation(path, line);
  run.messages().note("generate.approach",
                      fmt::format("{}arrives {:.2f} degrees off the approach and up to {:.2f} mm beside its line over "
                                  "the last 20 mm",
                                  name, angle * 180 / std::numbers::pi, 1e3 * lateral));
  run.figure("approach_angle", angle);
  run.figure("approach_lateral", lateral);
}

void write_covariance_of(const MotionPosterior& posterior, const Motion& motion, const GoalSpread& goal,
                         const Vector& calibration, const FileHeader& header, const MotionRequest& request,
                         Output& out) {
  const Eigen::Index T = motion.times.size();
  const Eigen::Index D = motion.positions.cols();
  CovarianceFile file{
      header,       request.spread(), request.spread() == Spread::latent ? calibration : Vector(),  Vector(D),
      motion.times, motion.positions, motion_covariance(posterior, motion.times, request.spread()), Matrix()};
  for (const auto& block : posterior.blocks) {
    for (const int j : block.outputs) file.degrees_of_freedom[j] = block.degrees_of_freedom;
  }
  if (!goal.factors.empty()) {  // one goal moves all signals at once
    if (file.covariance.size() > 1) {
      Matrix joint = Matrix::Zero(D * T, D * T);
      for (Eigen::Index j = 0; j < D; ++j) {
        joint.block(j * T, j * T, T, T) = file.covariance[static_cast<std::size_t>(j)];
      }
      file.covariance.assign(1, joint);
    }
    Matrix& F = file.goal_factor;
    F.resize(D * T, D);
    for (Eigen::Index j = 0; j < D; ++j) F.middleRows(j * T, T) = goal.factors[static_cast<std::size_t>(j)];
    file.covariance.front() += F * F.transpose();
  }
  write_covariance(file, out);
}

}  // namespace lfd::cli
