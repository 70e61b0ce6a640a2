#include "lfdtools/ways.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lfdtools/kmeans.hpp"
#include "lfdtools/skill_train.hpp"

namespace lfd {
namespace {

constexpr double least_separation = 7;      // in a target; six normal values part so by chance once in twenty
constexpr std::size_t least_of_target = 6;  // rows
constexpr double least_separation_of_all = 5;
constexpr double least_share = 0.05;
constexpr Eigen::Index least_rows = 20;

using Group = std::vector<std::size_t>;

/// The direction in which rows of one target and teacher differ most, unit.
Vector widest_direction(const Matrix& residuals, const std::vector<Group>& groups) {
  Matrix centred = residuals;
  for (const auto& group : groups) {
    const Eigen::RowVectorXd mean = residuals(group, Eigen::all).colwise().mean();
    for (const std::size_t i : group) centred.row(static_cast<Eigen::Index>(i)) -= mean;
  }
  return Eigen::SelfAdjointEigenSolver<Matrix>(centred.transpose() * centred).eigenvectors().rightCols(1);
}

/// Values of one group, sorted, in their two parts of least squared scatter.
struct Parting {
  Group low, high;
  double gap = 0;      // between the means of both
  double scatter = 0;  // sum of squares about them
};

Parting parted(const Vector& values, Group group) {
  std::stable_sort(group.begin(), group.end(), [&](std::size_t a, std::size_t b) {
    return values[static_cast<Eigen::Index>(a)] < values[static_cast<Eigen::Index>(b)];
  });
  Parting best{group, {}, 0, std::numeric_limits<double>::infinity()};
  for (std::size_t cut = 1; cut < group.size(); ++cut) {
    const Group low(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(cut));
    const Group high(group.begin() + static_cast<std::ptrdiff_t>(cut), group.end());
    const Vector a = values(low), b = values(high);
    const double scatter = (a.array() - a.mean()).square().sum() + (b.array() - b.mean()).square().sum();
    if (scatter < best.scatter) best = {low, high, b.mean() - a.mean(), scatter};
  }
  return best;
}

/// Way of targets that were reached one way alone: whose rows tell them better.
void tell_the_others(const Skill& skill, const std::vector<SkillRow>& rows, const std::vector<Group>& groups,
                     std::vector<int>& of_row) {
  SkillOptions options;
  options.hyperparameters = &skill;
  options.tempo = SkillTempo::own;
  std::vector<SkillPredictor> ways;
  for (const int way : {0, 1}) {
    std::vector<SkillRow> known;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (of_row[i] == way) known.push_back(rows[i]);
    }
    ways.emplace_back(train_skill(skill.columns, known, options));
  }
  const Matrix A = trajectory_metric(skill.dmp);
  for (const auto& group : groups) {
    if (of_row[group.front()] >= 0) continue;
    double missed[2] = {0, 0};
    for (const std::size_t i : group) {
      const Dmp& row = rows[i].primitive;
      for (const int way : {0, 1}) {
        const SkillPredictor& predictor = ways[static_cast<std::size_t>(way)];
        const Reach reach(rows[i].change(), row.start - predictor.skill().start);
        missed[way] += ((predictor.weights(reach).mean - row.weights) * A).squaredNorm();
      }
    }
    for (const std::size_t i : group) of_row[i] = missed[1] < missed[0] ? 1 : 0;
  }
}

/// Where no target has rows enough to part: the best split of all rows in two, along the line between the means.
std::optional<Ways> two_ways_of_all(const Matrix& residuals, const std::vector<Group>& groups, double reach) {
  Random random(1);
  KMeans split = kmeans(residuals, 2, random, 100);
  for (int k = 1; k < 10; ++k) {
    KMeans other = kmeans(residuals, 2, random, 100);
    if (other.inertia < split.inertia) split = std::move(other);
  }
  const Eigen::RowVectorXd between = split.centers.row(1) - split.centers.row(0);
  Ways ways{std::move(split.labels), between.norm(), 0};
  if (!(ways.distance >= least_share * reach)) return {};
  const Vector along = residuals * between.transpose() / ways.distance;
  Group sides[2];
  for (std::size_t i = 0; i < ways.of_row.size(); ++i) sides[ways.of_row[i]].push_back(i);
  const std::size_t least = (ways.of_row.size() + 9) / 10;
  if (std::min(sides[0].size(), sides[1].size()) < least) return {};
  double variance = 0;
  for (const auto& side : sides) {
    const Vector values = along(side);
    variance += (values.array() - values.mean()).square().mean() / 2;
  }
  ways.separation = variance > 0 ? ways.distance / std::sqrt(variance) : std::numeric_limits<double>::infinity();
  const bool mixed = std::any_of(groups.begin(), groups.end(), [&](const Group& group) {
    return std::any_of(group.begin(), group.end(),
                       [&](std::size_t i) { return ways.of_row[i] != ways.of_row[group[0]]; });
  });
  if (!mixed || !(ways.separation >= least_separation_of_all)) return {};
  return ways;
}

/// Way 0 is that of the first row.
Ways numbered(Ways ways) {
  if (ways.of_row.front() == 1) {
    for (int& way : ways.of_row) way = 1 - way;
  }
  return ways;
}

}  // namespace

std::optional<Ways> two_ways(const Skill& skill, const std::vector<SkillRow>& rows) {
  const Matrix residuals = left_out_residuals(skill);
  const Eigen::Index n = residuals.rows();
  if (n < least_rows || skill.dmp.scaling == DmpScaling::goal) return {};
  const auto groups = repetition_groups(skill.rows);
  const Vector along = residuals * widest_direction(residuals, groups);
  double reach = 0, scatter = 0;
  for (const auto& row : rows) reach += row.change().norm() / static_cast<double>(n);
  Eigen::Index degrees = n;
  std::vector<Parting> partings;
  for (const auto& group : groups) {
    partings.push_back({group, {}, 0, 0});
    if (group.size() < least_of_target) {
      degrees -= static_cast<Eigen::Index>(group.size());
      continue;
    }
    partings.back() = parted(along, group);
    scatter += partings.back().scatter;
    degrees -= 2;
  }
  if (std::none_of(groups.begin(), groups.end(), [](const Group& g) { return g.size() >= least_of_target; })) {
    auto ways = two_ways_of_all(residuals, groups, reach);
    return ways ? std::optional(numbered(std::move(*ways))) : std::nullopt;
  }
  const double sd = std::sqrt(scatter / static_cast<double>(degrees));

  Ways ways{std::vector<int>(static_cast<std::size_t>(n), -1), 0, 0};
  double both = 0;  // targets reached both ways
  for (const auto& [low, high, gap, rest] : partings) {
    if (high.empty() || gap < least_share * reach || !(gap >= least_separation * sd)) continue;
    for (const std::size_t i : low) ways.of_row[i] = 0;
    for (const std::size_t i : high) ways.of_row[i] = 1;
    ways.distance += gap * gap;
    both += 1;
  }
  const auto first_way = std::count(ways.of_row.begin(), ways.of_row.end(), 0);
  const auto second_way = std::count(ways.of_row.begin(), ways.of_row.end(), 1);
  if (both == 0 || std::min(first_way, second_way) < (n + 9) / 10) return {};
  ways.distance = std::sqrt(ways.distance / both);
  ways.separation = sd > 0 ? ways.distance / sd : std::numeric_limits<double>::infinity();
  if (first_way + second_way < n) {
    if (both < 2) return {};
    tell_the_others(skill, rows, groups, ways.of_row);
  }
  return numbered(std::move(ways));
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
