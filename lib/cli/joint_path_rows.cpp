#include "joint_path_rows.hpp"

#include "lfdtools/interpolation.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/singularity.hpp"

namespace lfd::cli {
namespace {

const std::vector<std::string> speed_names = {"qd1", "qd2", "qd3", "qd4", "qd5", "qd6"};
const std::vector<std::string> acceleration_names = {"qdd1", "qdd2", "qdd3", "qdd4", "qdd5", "qdd6"};

Samples diagnostics(const JointPath& path) {
  Samples figures(path.times.size(), 3);
  for (Eigen::Index t = 0; t < figures.rows(); ++t) {
    figures.row(t) << path.branch[static_cast<std::size_t>(t)], path.residual[t], path.condition[t];
  }
  return figures;
}

Eigen::RowVector4d singularities(const InverseKinematics& arm, const Joints& q) {
  const SingularityDistances d = singularity_distances(arm.geometry(), q);
  return {manipulability(jacobian(arm.robot(), q)), d.shoulder, d.elbow, d.wrist};
}

Samples singularities(const InverseKinematics& arm, const JointPath& path) {
  Samples figures(path.times.size(), 4);
  for (Eigen::Index t = 0; t < figures.rows(); ++t) {
    figures.row(t) = singularities(arm, Joints(path.joints.row(t).transpose()));
  }
  return figures;
}

}  // namespace

std::vector<std::string> joint_path_columns(const JointPathRequest& request, const std::vector<std::string>& passed) {
  auto columns =
      joined(request.all ? std::vector<std::string>{"t", "solution"} : std::vector<std::string>{"t"}, joint_columns());
  if (request.speeds) columns = joined(columns, speed_names);
  if (request.accelerations) columns = joined(columns, acceleration_names);
  if (request.diagnostics) columns = joined(columns, {"branch", "residual", "condition"});
  if (request.singularities) columns = joined(columns, {"manipulability", "shoulder", "elbow", "wrist"});
  return request.all ? columns : joined(columns, passed);
}

Samples solution_row(const InverseKinematics& arm, const IkSolution& solution, std::size_t number, double time,
                     const JointPathRequest& request) {
  Samples row(1, 8);
  const Joints& q = solution.joints;
  row << time, static_cast<double>(number), q.transpose();
  if (request.diagnostics) {
    const double condition = condition_number(jacobian(arm.robot(), q));
    row = beside(row, Eigen::RowVector3d(solution.branch, solution.residual, condition));
  }
  if (request.singularities) row = beside(row, singularities(arm, q));
  return row;
}

Samples path_rows(const InverseKinematics& arm, const JointPath& path, const JointRates& rates,
                  const JointPathRequest& request) {
  Samples rows = beside(path.times, path.joints);
  if (request.speeds) rows = beside(rows, rates.speeds);
  if (request.accelerations) rows = beside(rows, rates.accelerations);
  if (request.diagnostics) rows = beside(rows, diagnostics(path));
  if (request.singularities) rows = beside(rows, singularities(arm, path));
  return rows;
}

JointRates rates_along(const JointPath& path) {
  const Eigen::Index T = path.joints.rows();
  if (T < 2) return {Samples::Zero(T, 6), Samples::Zero(T, 6)};
  const CubicSpline spline(path.times, path.joints);
  return {spline.derivative(path.times), spline.second_derivatives()};
}

Samples between(const Vector& given, const Samples& values, const Vector& times) {
  Samples rows(times.size(), values.cols());
  Eigen::Index k = 0;
  for (Eigen::Index t = 0; t < times.size(); ++t) {
    while (given[k] < times[t]) ++k;
    rows.row(t) = values.row(k);
    if (given[k] == times[t]) continue;
    const double share = (times[t] - given[k - 1]) / (given[k] - given[k - 1]);
    rows.row(t) = (1.0 - share) * values.row(k - 1) + share * values.row(k);
  }
  return rows;
}

}  // namespace lfd::cli
