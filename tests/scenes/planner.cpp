#include "planner.hpp"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <numbers>

#include "processor_time.hpp"

namespace lfd::scenes {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr unsigned iterations = 20000;

Vector values(const ob::State* state, unsigned n) {
  const double* v = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return Eigen::Map<const Vector>(v, n);
}

/// @param resolution  of the checks, as a share of the space's extent   @param step  between the points returned
std::optional<Samples> plan(Planner which, const Vector& start, const Vector& goal, const Vector& low,
                            const Vector& high, const std::function<bool(const Vector&)>& free, double resolution,
                            double step) {
  const auto n = static_cast<unsigned>(start.size());
  const auto space = std::make_shared<ob::RealVectorStateSpace>(n);
  ob::RealVectorBounds bounds(n);
  for (unsigned i = 0; i < n; ++i) {
    bounds.setLow(i, low[i]);
    bounds.setHigh(i, high[i]);
  }
  space->setBounds(bounds);
  og::SimpleSetup setup(space);
  setup.setStateValidityChecker([&](const ob::State* state) { return free(values(state, n)); });
  setup.getSpaceInformation()->setStateValidityCheckingResolution(resolution);
  ob::ScopedState<ob::RealVectorStateSpace> from(space), to(space);
  for (unsigned i = 0; i < n; ++i) {
    from[i] = start[i];
    to[i] = goal[i];
  }
  setup.setStartAndGoalStates(from, to);
  if (which == Planner::rrt_connect) setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
  if (which == Planner::prm) setup.setPlanner(std::make_shared<og::LazyPRM>(setup.getSpaceInformation()));
  ob::IterationTerminationCondition enough(iterations);
  if (setup.solve(ob::PlannerTerminationCondition(enough)) != ob::PlannerStatus::EXACT_SOLUTION) return {};
  og::PathGeometric& path = setup.getSolutionPath();
  og::PathSimplifier simplifier(setup.getSpaceInformation());
  simplifier.reduceVertices(path);
  simplifier.shortcutPath(path);
  path.interpolate(static_cast<unsigned>(path.length() / step) + 2);
  Samples points(static_cast<Eigen::Index>(path.getStateCount()), start.size());
  for (std::size_t i = 0; i < path.getStateCount(); ++i) {
    points.row(static_cast<Eigen::Index>(i)) = values(path.getState(static_cast<unsigned>(i)), n).transpose();
  }
  return points;
}

}  // namespace

void seed_planners(unsigned seed) {
  ompl::RNG::setSeed(seed);
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
}

std::optional<Samples> plan_hand(const Vector3& start, const Vector3& goal,
                                 const std::function<bool(const Vector3&)>& free) {
  const Vector3 room(0.6, 0.4, 0.6);
  return plan(
      Planner::rrt_connect, start, goal, start.cwiseMin(goal) - room, start.cwiseMax(goal) + room,
      [&](const Vector& p) { return free(p); }, 0.004, 0.01);
}

std::optional<PlannedJoints> plan_joints(Planner planner, const Joints& start, const Joints& goal,
                                         const std::function<bool(const Joints&)>& free) {
  const double begin = processor_time();
  const Vector half = Vector::Constant(6, std::numbers::pi);
  const auto path = plan(
      planner, start, goal, start - half, start + half, [&](const Vector& q) { return free(q); }, 0.0015, 0.02);
  if (!path) return {};
  return PlannedJoints{*path, processor_time() - begin};
}

}  // namespace lfd::scenes
