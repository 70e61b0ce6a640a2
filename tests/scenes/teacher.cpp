#include "teacher.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "lfdtools/box_minimum.hpp"
#include "lfdtools/fold.hpp"
#include "planner.hpp"

namespace lfd::scenes {
namespace {

constexpr Eigen::Index bumps = 5;
constexpr Eigen::Index checked = 41;
constexpr double unreachable = -0.3;  // stands for the clearance of a hand out of reach [m]
constexpr double stiffness = 3e3;     // of the margin, beside a mean square speed in m^2
constexpr double worst_condition = 25;

/// n x K: sin(pi s) sin(k pi s).
Matrix bump_values(const Vector& phases) {
  Matrix values(phases.size(), bumps);
  for (Eigen::Index k = 0; k < bumps; ++k) {
    values.col(k) = (std::numbers::pi * phases).array().sin() *
                    (static_cast<double>(k + 1) * std::numbers::pi * phases).array().sin();
  }
  return values;
}

std::optional<Joints> joints_at(const InverseKinematics& arm, const Matrix3& orientation, int branch,
                                const Vector3& position) {
  for (const auto& solution : arm({orientation, position})) {
    if (solution.branch == branch) return solution.joints;
  }
  return {};
}

}  // namespace

Samples Meant::positions(const Vector& phases) const {
  return straight_line(start, goal, phases) + Samples(bump_values(phases) * coefficients.transpose());
}

std::optional<Samples> joints_along(const InverseKinematics& arm, const Matrix3& orientation, int branch,
                                    const Samples& positions) {
  Samples joints(positions.rows(), 6);
  for (Eigen::Index t = 0; t < positions.rows(); ++t) {
    auto q = joints_at(arm, orientation, branch, positions.row(t).transpose());
    if (!q) return {};
    for (Eigen::Index j = 0; t > 0 && j < 6; ++j) (*q)[j] = joints(t - 1, j) + wrap_angle((*q)[j] - joints(t - 1, j));
    joints.row(t) = q->transpose();
  }
  return joints;
}

Teacher::Teacher(const Robot& robot, const Task& task, double margin)
    : task_(task), arm_(robot), bodies_(robot, task.obstacles), ground_(robot, task.ground), margin_(margin) {}

double Teacher::to_ground(const Joints& q) const {
  double nearest = 1e3;
  for (const auto& pair : ground_.pairs(q)) {
    const bool base = ground_.bodies()[static_cast<std::size_t>(pair.link)].frame <= 1;
    if (!base) nearest = std::min(nearest, pair.distance);
  }
  return nearest;
}

double Teacher::missing(const Joints& q) const {
  return std::max({0.0, margin_ - bodies_.least(q), 0.2 * margin_ - to_ground(q), -ground_.least_of_arm_itself(q)});
}

double Teacher::least(const Joints& q) const {
  return std::min({bodies_.least(q), to_ground(q), ground_.least_of_arm_itself(q)});
}

std::vector<int> Teacher::branches() const {
  std::vector<std::pair<double, int>> clear;
  for (int branch = 0; branch < 8; ++branch) {
    std::vector<Hole> places = task_.holes;
    places.push_back({"start", task_.start});
    double nearest = 1;
    bool stands = true;
    for (const auto& place : places) {
      const auto q = joints_at(arm_, task_.orientation, branch, place.position);
      stands = stands && q && missing(*q) == 0;
      if (stands) nearest = std::min(nearest, bodies_.least(*q));
    }
    if (stands) clear.emplace_back(-nearest, branch);
  }
  std::stable_sort(clear.begin(), clear.end());
  std::vector<int> branches;
  for (const auto& [negative, branch] : clear) branches.push_back(branch);
  return branches;
}

std::optional<double> Teacher::clearance(const Samples& positions, int branch) const {
  double nearest = 1e3;
  for (Eigen::Index t = 0; t < positions.rows(); ++t) {
    const auto q = joints_at(arm_, task_.orientation, branch, positions.row(t).transpose());
    if (!q) return {};
    nearest = std::min(nearest, least(*q));
  }
  return nearest;
}

Meant Teacher::shortened(Meant meant, int branch) const {
  const Vector phases = linspace(0, 1, checked);
  const Matrix B = bump_values(phases);
  const Samples line = straight_line(meant.start, meant.goal, phases);
  const double h = 1.0 / static_cast<double>(checked - 1);
  const Matrix slopes = (B.bottomRows(checked - 1) - B.topRows(checked - 1)) / h;
  const Samples line_slopes = (line.bottomRows(checked - 1) - line.topRows(checked - 1)) / h;
  const auto hinge = [&](const Vector3& position) {
    const auto q = joints_at(arm_, task_.orientation, branch, position);
    const double short_of = q ? missing(*q) : margin_ - unreachable;
    return short_of * short_of;
  };
  const Objective cost = [&](const Vector& x, Vector& gradient) {
    const Eigen::Map<const Matrix> C(x.data(), 3, bumps);
    Eigen::Map<Matrix> G(gradient.data(), 3, bumps);
    const Samples speed = line_slopes + Samples(slopes * C.transpose());
    double value = h * speed.squaredNorm();
    G = 2 * h * speed.transpose() * slopes;
    const Samples path = line + Samples(B * C.transpose());
    for (Eigen::Index t = 1; t + 1 < checked; ++t) {
      const Vector3 p = path.row(t).transpose();
      const double missed = hinge(p);
      if (missed == 0) continue;
      value += stiffness * h * missed;
      constexpr double step = 1e-5;
      for (int j = 0; j < 3; ++j) {
        const Vector3 e = step * Vector3::Unit(j);
        G.row(j) += stiffness * h * (hinge(p + e) - hinge(p - e)) / (2 * step) * B.row(t);
      }
    }
    return value;
  };
  const Vector bound = Vector::Constant(3 * bumps, 1.5);
  const Vector x = Eigen::Map<const Vector>(meant.coefficients.data(), 3 * bumps);
  const BoxMinimum least = minimize_in_box(cost, x, -bound, bound, {120, 1e-4});
  meant.coefficients = Eigen::Map<const Matrix>(least.x.data(), 3, bumps);
  return meant;
}

bool Teacher::holds(const Meant& meant, std::size_t way, int branch) const {
  const Samples path = meant.positions(linspace(0, 1, 161));
  const auto joints = joints_along(arm_, task_.orientation, branch, path);
  if (!joints) return false;
  for (Eigen::Index t = 0; t < path.rows(); ++t) {
    if (t > 0 && (joints->row(t) - joints->row(t - 1)).cwiseAbs().maxCoeff() > 0.3) return false;
    if (missing(joints->row(t).transpose()) > 0.25 * margin_ || least(joints->row(t).transpose()) < 0) return false;
    if (condition_number(jacobian(arm_.robot(), joints->row(t).transpose())) > worst_condition) return false;
  }
  // On its side: where the hand passes the middle of the obstacle, along the straight way.
  const Pose& box = task_.obstacles.front().pose;
  const Vector ahead = (path.rowwise() - box.position.transpose()) * box.rotation.col(0);
  Eigen::Index passing = 0;
  (void)ahead.cwiseAbs().minCoeff(&passing);
  return (path.row(passing).transpose() - box.position).dot(task_.ways[way]) > 0;
}

std::optional<Meant> Teacher::planned(const Vector3& goal, int branch) const {
  const auto free = [&](const Vector3& position) {
    const auto q = joints_at(arm_, task_.orientation, branch, position);
    return q && missing(*q) < 0.5 * margin_;
  };
  const auto points = plan_hand(task_.start, goal, free);
  if (!points) return {};
  // The bumps nearest to the planned path, taken at a speed like that of minimum jerk.
  Vector length = Vector::Zero(points->rows());
  for (Eigen::Index i = 1; i < points->rows(); ++i) {
    length[i] = length[i - 1] + (points->row(i) - points->row(i - 1)).norm();
  }
  const Vector phases = linspace(0, 1, checked);
  const Vector mj = phases.array().cube() * (10 + phases.array() * (-15 + 6 * phases.array()));
  Samples path(checked, 3);
  for (Eigen::Index t = 0, i = 1; t < checked; ++t) {
    const double along = mj[t] * length[length.size() - 1];
    while (i + 1 < points->rows() && length[i] < along) ++i;
    const double share = std::clamp((along - length[i - 1]) / std::max(length[i] - length[i - 1], 1e-12), 0.0, 1.0);
    path.row(t) = (1 - share) * points->row(i - 1) + share * points->row(i);
  }
  Meant meant{task_.start, goal, Matrix::Zero(3, bumps)};
  const Matrix B = bump_values(phases);
  meant.coefficients =
      B.colPivHouseholderQr().solve(Matrix(path - straight_line(task_.start, goal, phases))).transpose();
  return meant;
}

std::optional<Meant> Teacher::plan(const Vector3& goal, std::size_t way, int branch, const Meant* like) const {
  if (like != nullptr) {
    Meant meant = shortened({task_.start, goal, like->coefficients}, branch);
    if (holds(meant, way, branch)) return meant;
  }
  for (const double size : {1.0, 2.0}) {
    Meant bump{task_.start, goal, Matrix::Zero(3, bumps)};
    bump.coefficients.col(0) = size * (task_.berth + margin_ + 0.1) * task_.ways[way];
    Meant meant = shortened(std::move(bump), branch);
    if (holds(meant, way, branch)) return meant;
  }
  if (auto start = planned(goal, branch)) {
    Meant meant = shortened(std::move(*start), branch);
    if (holds(meant, way, branch)) return meant;
  }
  return {};
}

}  // namespace lfd::scenes
