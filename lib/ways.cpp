#include "lfdtools/ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lfdtools/kmeans.hpp"

namespace lfd {
namespace {

constexpr int tries = 10;
constexpr int max_iterations = 100;
constexpr double least_separation = 5;
constexpr double least_share = 0.05;
constexpr Eigen::Index least_rows = 20;

KMeans best_split(const Matrix& residuals) {
  Random random(1);
  KMeans best = kmeans(residuals, 2, random, max_iterations);
  for (int k = 1; k < tries; ++k) {
    KMeans other = kmeans(residuals, 2, random, max_iterations);
    if (other.inertia < best.inertia) best = std::move(other);
  }
  return best;
}

}  // namespace

std::optional<Ways> two_ways(const Skill& skill, const std::vector<SkillRow>& rows) {
  const Matrix residuals = left_out_residuals(skill);
  const Eigen::Index n = residuals.rows();
  if (n < least_rows || skill.dmp.scaling == DmpScaling::goal) return {};
  KMeans split = best_split(residuals);
  const int first = split.labels.front();
  for (int& label : split.labels) label = label == first ? 0 : 1;
  const auto second = static_cast<Eigen::Index>(std::count(split.labels.begin(), split.labels.end(), 1));
  if (std::min(second, n - second) < (n + 9) / 10) return {};
  const Eigen::RowVectorXd between = split.centers.row(1 - first) - split.centers.row(first);
  Ways ways{std::move(split.labels), between.norm(), 0};
  if (!(ways.distance > 0)) return {};
  const Vector along = residuals * between.transpose() / ways.distance;
  double mean[2] = {0, 0}, squares[2] = {0, 0},
         count[2] = {static_cast<double>(n - second), static_cast<double>(second)};
  for (Eigen::Index i = 0; i < n; ++i) mean[ways.of_row[static_cast<std::size_t>(i)]] += along[i];
  for (const int k : {0, 1}) mean[k] /= count[k];
  for (Eigen::Index i = 0; i < n; ++i) {
    const int k = ways.of_row[static_cast<std::size_t>(i)];
    squares[k] += std::pow(along[i] - mean[k], 2);
  }
  const double sd = std::sqrt((squares[0] / count[0] + squares[1] / count[1]) / 2);
  ways.separation = sd > 0 ? ways.distance / sd : std::numeric_limits<double>::infinity();
  double reach = 0;
  for (const auto& row : rows) reach += row.change().norm() / static_cast<double>(rows.size());
  const auto groups = target_groups(skill.rows);
  const bool mixed = std::any_of(groups.begin(), groups.end(), [&](const auto& group) {
    return std::any_of(group.begin(), group.end(),
                       [&](std::size_t i) { return ways.of_row[i] != ways.of_row[group[0]]; });
  });
  if (!mixed || ways.distance < least_share * reach || !(ways.separation >= least_separation)) return {};
  return ways;
}

int nearest_way(const std::vector<SkillRow>& rows, const Ways& ways, const Vector& change) {
  double nearest = std::numeric_limits<double>::infinity();
  int way = 0;
  for (const auto& group : target_groups(labels_of(rows))) {
    const double distance = (rows[group.front()].change() - change).norm();
    if (!(distance < nearest)) continue;
    nearest = distance;
    const auto second = std::count_if(group.begin(), group.end(), [&](std::size_t i) { return ways.of_row[i] == 1; });
    way = 2 * static_cast<std::size_t>(second) > group.size() ? 1 : 0;
  }
  return way;
}

std::vector<SkillRow> rows_of_way(const std::vector<SkillRow>& rows, const Ways& ways, int way) {
  std::vector<SkillRow> of_way;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (ways.of_row[i] == way) of_way.push_back(rows[i]);
  }
  return of_way;
}

}  // namespace lfd
