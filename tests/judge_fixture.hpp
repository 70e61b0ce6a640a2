// Targets for tests of methods and of the judge.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/fold.hpp"
#include "lfdtools/synthesis.hpp"

namespace lfd {

/// Six holes, three demonstrations each, a bump in z.
inline Experiment small_experiment() {
  Experiment experiment;
  experiment.start = Vector::Zero(3);
  for (const double x : {0.2, 0.3, 0.4}) {
    for (const double y : {0.1, 0.25}) {
      Vector hole(3);
      hole << x, y, 0.3;
      experiment.holes.push_back({std::to_string(experiment.holes.size() + 1), hole});
    }
  }
  experiment.repetitions = 3;
  experiment.rate = 50;
  Bump bump;
  bump.constant = 0.05;
  experiment.bumps = {Bump{}, Bump{}, bump};
  return experiment;
}

inline std::vector<TargetDemonstrations> by_target(const DemonstrationSet& set) {
  std::vector<TargetDemonstrations> targets;
  for (const auto& demonstration : set.demonstrations) {
    if (targets.empty() || targets.back().labels.target != demonstration.labels.target) {
      targets.push_back({{demonstration.labels.target, {}, {}, {}}, {}});
    }
    targets.back().demonstrations.push_back(demonstration.trajectory);
  }
  return targets;
}

inline std::vector<TargetDemonstrations> small_targets() {
  return by_target(synthesize(small_experiment()));
}

/// Training targets with everything that any method needs.
inline std::vector<TrainingTarget> small_training(const PreparationOptions& options = {}) {
  std::vector<TrainingTarget> training;
  const auto targets = small_targets();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    training.push_back(training_target(targets[i].labels, recorded(targets[i], options.alignment), options,
                                       {.primitives = true, .paper = false}, i));
  }
  return training;
}

inline Fold all_of(const std::vector<TrainingTarget>& training) {
  Fold fold;
  for (const auto& target : training) fold.push_back(&target);
  return fold;
}

/// A place between the holes.
inline Query small_query() {
  Query query{Vector(3), Vector(3), 3};
  query.start << 0.01, -0.005, 0.002;
  query.goal << 0.27, 0.2, 0.31;
  return query;
}

}  // namespace lfd
