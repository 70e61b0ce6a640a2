#include "chances.hpp"

#include <fmt/format.h>

#include "lfdtools/touching.hpp"

namespace lfd::scenes {
namespace {

// How far the goal may be off, in each axis [m].
constexpr double goal_sd = 0.02;
// Of the samples of a path those that are looked at.
constexpr Eigen::Index every = 4;
// Paths a probability.
constexpr std::uint64_t draws = 5;

Vector normals(Eigen::Index n, Random random) {
  Vector z(n);
  for (double& value : z) value = random.normal();
  return z;
}

Samples sparse(const Samples& path) {
  return path(Eigen::seq(0, path.rows() - 1, Eigen::fix<every>), Eigen::all);
}

/// A path of n samples with an error drawn from a spread, n x 3 [m].
Samples drawn(const Samples& path, const HandSpread& spread, const Random& random) {
  const Vector error = spread.factor * normals(spread.factor.cols(), random);
  return path + Samples(error.reshaped<Eigen::RowMajor>(path.rows(), 3));
}

double chance_of_touching(const StudiedScene& scene, const Samples& joints, const HandSpread& spread) {
  std::vector<Solid> solids = scene.task().obstacles;
  solids.insert(solids.end(), scene.task().ground.begin(), scene.task().ground.end());
  const ArmClearance bodies(scene.arm().robot(), solids);
  return touching(bodies, joints, spread, {}, {.self = true, .draws = 2048}).path.probability;
}

/// What becomes, at its samples, of one of the paths that `told`, the probability of touching, speaks of.
void judge_draw(const StudiedScene& scene, const std::string& method, const Hole& hole, const Samples& path,
                double told) {
  Verdict verdict;
  if (const auto joints = scene.joints_of(path)) {
    verdict.clearance = least_distance(scene.fcl(), *joints, 1);
    verdict.outcome = verdict.clearance > 0 ? Outcome::clear : Outcome::collided;
  } else {
    verdict.reason = "unreachable";
  }
  scene.row(method, hole.target, verdict, 0, 0, fmt::format("{:.5f}", told));
}

}  // namespace

void judge_chances(const StudiedScene& scene, const BandedSkill& banded, const Predictor& skill,
                   const std::vector<Samples>& paths, const Random& random) {
  const Task& task = scene.task();
  for (std::size_t i = 0; i < task.new_holes.size(); ++i) {
    const Hole& hole = task.new_holes[i];
    const Samples path = sparse(paths[i]);
    const auto joints = scene.joints_of(path);
    if (!joints) continue;
    const Random of_hole = random.split(i);
    const Vector times = linspace(0, seconds, path.rows());
    Goal goal{{}, hole.position, Vector(task.start), seconds};
    const HandSpread spread = banded.spread(goal, times);
    const double told = chance_of_touching(scene, *joints, spread);
    judge_draw(scene, "skill-itself", hole, path, told);
    for (std::uint64_t k = 0; k < draws; ++k) {
      judge_draw(scene, "skill-drawn", hole, drawn(path, spread, of_hole.split(1).split(k)), told);
    }
    goal.covariance = goal_sd * goal_sd * Matrix3::Identity();
    const double told_of_goal = chance_of_touching(scene, *joints, banded.spread(goal, times));
    for (std::uint64_t k = 0; k < draws; ++k) {
      const Vector3 seen = hole.position + goal_sd * normals(3, of_hole.split(2).split(k));
      const Samples went = sparse(skill({task.start, seen, 1, {}}).path);
      judge_draw(scene, "skill-goal-off", hole, drawn(went, spread, of_hole.split(4).split(k)), told_of_goal);
    }
  }
}

}  // namespace lfd::scenes
