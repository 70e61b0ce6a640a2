#include "lfdtools/opponents.hpp"

#include "lfdtools/dmp_fit.hpp"

namespace lfd {
namespace {

Vector phases() {
  return linspace(0, 1, phase_count);
}

Predicted deviating(const Query& query, const Samples& deviation) {
  return {straight_line(query.start, query.goal, phases()) + deviation, {}};
}

/// The motion of a primitive between the ends of the query. Positions over phase do not depend on tau.
Predicted moved(Dmp primitive, const Query& query) {
  primitive.tau = 1;
  primitive.start = query.start;
  primitive.goal = query.goal;
  return {rollout(primitive, phases()).positions, {}};
}

/// A primitive with the mean weights of a target.
Dmp mean_primitive(const TrainingTarget& target) {
  Dmp mean = target.examples.front().primitive;
  mean.weights.setZero();
  for (const auto& example : target.examples) mean.weights += example.primitive.weights;
  mean.weights /= static_cast<double>(target.examples.size());
  return mean;
}

}  // namespace

std::size_t nearest_target(const Fold& fold, const Query& query) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < fold.size(); ++i) {
    if ((fold[i]->change() - query.change()).norm() < (fold[nearest]->change() - query.change()).norm()) nearest = i;
  }
  return nearest;
}

Samples mean_deviation(const TrainingTarget& target) {
  Samples sum = target.examples.front().deviation();
  for (std::size_t i = 1; i < target.examples.size(); ++i) sum += target.examples[i].deviation();
  return sum / static_cast<double>(target.examples.size());
}

Predictor train_line(const Fold&, const PreparationOptions&) {
  return [](const Query& query) { return Predicted{straight_line(query.start, query.goal, phases()), {}}; };
}

Predictor train_nearest(const Fold& fold, const PreparationOptions&) {
  return [fold](const Query& query) { return moved(mean_primitive(*fold[nearest_target(fold, query)]), query); };
}

Predictor train_mean(const Fold& fold, const PreparationOptions&) {
  Dmp mean = mean_primitive(*fold.front());
  for (std::size_t i = 1; i < fold.size(); ++i) mean.weights += mean_primitive(*fold[i]).weights;
  mean.weights /= static_cast<double>(fold.size());
  return [mean](const Query& query) { return moved(mean, query); };
}

Predictor train_nearest_deviation(const Fold& fold, const PreparationOptions&) {
  return [fold](const Query& query) { return deviating(query, mean_deviation(*fold[nearest_target(fold, query)])); };
}

Predictor train_mean_deviation(const Fold& fold, const PreparationOptions&) {
  Samples sum = mean_deviation(*fold.front());
  for (std::size_t i = 1; i < fold.size(); ++i) sum += mean_deviation(*fold[i]);
  const Samples mean = sum / static_cast<double>(fold.size());
  return [mean](const Query& query) { return deviating(query, mean); };
}

Predictor train_moved_goal(const Fold& fold, const PreparationOptions& options) {
  DmpFitOptions fit;
  fit.bases = options.bases;
  fit.scaling = DmpScaling::goal;
  fit.allow_small_scale = true;
  return [fold, fit](const Query& query) {
    const TrainingTarget& target = *fold[nearest_target(fold, query)];
    Trajectory mean{phases(), Samples::Zero(phase_count, query.start.size())};
    for (const auto& example : target.examples) {
      mean.positions += example.path / static_cast<double>(target.examples.size());
    }
    return moved(fit_dmp(mean, fit), query);
  };
}

}  // namespace lfd
