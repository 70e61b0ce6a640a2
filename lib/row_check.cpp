#include "lfdtools/row_check.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <iterator>

#include "lfdtools/linalg.hpp"

namespace lfd {
namespace {

bool same_motion(const Dmp& a, const Dmp& b) {
  return a.tau == b.tau && a.start == b.start && a.goal == b.goal && a.weights == b.weights;
}

/// Mean dP and mean start of some rows, 2 D [m].
Vector mean_ends(const std::vector<SkillRow>& rows, const std::vector<std::size_t>& group) {
  const Eigen::Index D = rows.front().primitive.dimensions();
  Vector ends = Vector::Zero(2 * D);
  for (const std::size_t i : group) {
    ends.head(D) += rows[i].change() / static_cast<double>(group.size());
    ends.tail(D) += rows[i].primitive.start / static_cast<double>(group.size());
  }
  return ends;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How far start and goal of each row are from the medians of its repetitions, n [m]; -1 of fewer than three.
Vector distances_of_ends(const std::vector<SkillRow>& rows) {
  Vector distances = Vector::Constant(static_cast<Eigen::Index>(rows.size()), -1);
  for (const auto& group : repetition_groups(labels_of(rows))) {
    if (group.size() < 3) continue;
    const Eigen::Index D = rows.front().primitive.dimensions();
    Matrix ends(static_cast<Eigen::Index>(group.size()), 2 * D);
    for (Eigen::Index k = 0; k < ends.rows(); ++k) {
      const Dmp& primitive = rows[group[static_cast<std::size_t>(k)]].primitive;
      ends.row(k) << primitive.start.transpose(), primitive.goal.transpose();
    }
    for (auto end : ends.colwise()) end.array() -= median({end.begin(), end.end()});
    distances(group) = ends.rowwise().norm();
  }
  return distances;
}

/// @param distances  negative: not known
std::vector<Outlier> far_over_median(const Vector& distances, double limit) {
  std::vector<double> known;
  std::copy_if(distances.begin(), distances.end(), std::back_inserter(known), [](double d) { return d >= 0; });
  if (known.empty()) return {};
  // Where most rows agree to the last digit any other is infinitely far.
  const double middle = std::max(median(std::move(known)), 1e-300);
  std::vector<Outlier> far;
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (distances[i] > limit * middle) far.push_back({static_cast<std::size_t>(i), distances[i] / middle});
  }
  return far;
}

/// Variance of each row given the rows of all other groups, n, relative to Omega, with its noise: the diagonal of
/// ([K'^-1]_gg)^-1.
Vector left_out_variances(const MvgpModel& model, const std::vector<std::vector<std::size_t>>& groups) {
  const Matrix L = cholesky(noisy_covariance(model));
  const Matrix inverse = L.triangularView<Eigen::Lower>().solve(Matrix::Identity(L.rows(), L.cols()));
  Vector variances = Vector::Zero(L.rows());
  for (const auto& group : groups) {
    const auto m = static_cast<Eigen::Index>(group.size());
    const Eigen::HouseholderQR<Matrix> qr(inverse(Eigen::all, group));
    const Matrix R_inverse = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().solve(Matrix::Identity(m, m));
    variances(group) = R_inverse.rowwise().squaredNorm();
  }
  return variances;
}

}  // namespace

std::vector<std::size_t> repeated_rows(const std::vector<SkillRow>& rows) {
  std::vector<std::size_t> repeated;
  for (const auto& group : target_groups(labels_of(rows))) {
    for (auto row = group.begin(); row != group.end(); ++row) {
      const auto same = [&](std::size_t earlier) { return same_motion(rows[earlier].primitive, rows[*row].primitive); };
      if (std::any_of(group.begin(), row, same)) repeated.push_back(*row);
    }
  }
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}

std::vector<Outlier> outlying_rows(const Skill& skill, const std::vector<SkillRow>& rows, double limit) {
  constexpr double smallest = 0.1;  // [m]
  if (rows.size() < 4) return {};
  const auto groups = target_groups(skill.rows);
  const Vector ends = distances_of_ends(rows);
  std::vector<Outlier> outliers;
  for (const auto& outlier : far_over_median(ends, limit)) {
    if (ends[static_cast<Eigen::Index>(outlier.row)] > smallest) outliers.push_back({outlier.row, outlier.ratio, true});
  }
  if (!outliers.empty()) return outliers;

  Vector expected = Vector::Zero(ends.size());  // squares
  for (const auto& model : skill.models) {
    expected += model.process.omega.trace() * left_out_variances(model.process, groups);
  }
  return far_over_median(left_out_residuals(skill).rowwise().norm().array() / expected.array().sqrt(), limit);
}

std::vector<std::pair<std::size_t, std::size_t>> coinciding_targets(const std::vector<SkillRow>& rows) {
  constexpr double near = 1e-3;
  std::vector<Vector> ends;
  for (const auto& group : target_groups(labels_of(rows))) ends.push_back(mean_ends(rows, group));
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t b = 0; b < ends.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if ((ends[a] - ends[b]).norm() < near) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

}  // namespace lfd
