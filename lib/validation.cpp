#include "lfdtools/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <map>
#include <utility>

#include "lfdtools/calibration.hpp"
#include "lfdtools/dtw.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/methods.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/parallel.hpp"

namespace lfd {
namespace {

constexpr std::size_t neighbour_count = 4;

/// Targets by number: those to learn from, and those to be judged on, which are left out of what is learnt.
struct Split {
  std::vector<std::size_t> left_out;
  std::vector<std::size_t> training;
};

/// Who is left out together: the members of a fold, or where there are no folds all that teachers showed of a target.
std::vector<std::vector<std::size_t>> left_out_together(const std::vector<TargetDemonstrations>& targets,
                                                        const std::vector<int>& folds) {
  if (folds.empty()) {
    std::vector<Labels> labels;
    for (const auto& target : targets) labels.push_back(target.labels);
    return target_groups(labels);
  }
  std::map<int, std::vector<std::size_t>> members;  // by fold
  for (std::size_t i = 0; i < targets.size(); ++i) members[folds[i]].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [fold, group] : members) groups.push_back(std::move(group));
  return groups;
}

std::vector<Split> splits(const std::vector<std::vector<std::size_t>>& groups, std::size_t targets) {
  std::vector<Split> result;
  for (const auto& left_out : groups) {
    Split split{left_out, {}};
    for (std::size_t i = 0; i < targets; ++i) {
      if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) split.training.push_back(i);
    }
    if (split.training.size() < 2) {
      throw DataError(
          "validation.too_few_targets",
          fmt::format("a fold of {} of {} targets leaves under two to learn from", left_out.size(), targets));
    }
    result.push_back(std::move(split));
  }
  return result;
}

/// Processor time of this thread [s]: what a method takes, whatever else the machine does.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

using Neighbours = std::vector<const JudgedTarget*>;

ValidationScore score(const Predicted& predicted, const JudgedTarget& target, const Neighbours& training,
                      const std::string& method) {
  const Query& query = target.query;
  ValidationScore result;
  result.labels = target.labels;
  result.method = method;
  result.rmse = rms_distance(predicted.path, target.mean_path);
  result.end_error = (predicted.path.row(phase_count - 1).transpose() - query.goal).norm();
  const DtwPath path = dtw(predicted.path, target.mean_path);
  result.dtw = path.cost / static_cast<double>(path.steps.size());
  result.outside = outside_depth(predicted.path, query, training);
  if (predicted.band) {
    result.band95 = band_score(predicted, 0.95, target.mean_path);
    for (const double level : nominal_levels()) {
      result.bands.push_back(band_score(predicted, level, target.mean_path));
    }
  }
  return result;
}

/// Words for the place of a failure.
std::string describe_fold(const Split& split, const std::vector<JudgedTarget>& judged) {
  std::string words;
  for (const std::size_t i : split.left_out) words += (words.empty() ? "" : "; ") + describe(judged[i].labels);
  return words;
}

/// For each method the first of those chosen that gives the same: itself, or the one that it is by another name.
std::vector<std::size_t> first_of_same(const std::vector<const Method*>& chosen) {
  const auto root = [](const Method* method) { return method->same_as.empty() ? method->name : method->same_as; };
  std::vector<std::size_t> first;
  for (const Method* method : chosen) {
    const auto found =
        std::find_if(chosen.begin(), chosen.end(), [&](const Method* other) { return root(other) == root(method); });
    first.push_back(static_cast<std::size_t>(found - chosen.begin()));
  }
  return first;
}

/// Every method learns from the training targets of each fold and is judged on those left out of it.
/// @param folds  a target is left out of one at most
Validation judge(const std::vector<TargetDemonstrations>& targets, const std::vector<Split>& folds,
                 const ValidationOptions& options) {
  const auto chosen = chosen_methods(options.methods);
  Needs needs;
  for (const Method* method : chosen) {
    needs.primitives = needs.primitives || method->needs.primitives;
    needs.paper = needs.paper || method->needs.paper;
  }
  std::vector<bool> is_left_out(targets.size(), false), is_training(targets.size(), false);
  for (const auto& split : folds) {
    for (const std::size_t i : split.left_out) is_left_out[i] = true;
    for (const std::size_t i : split.training) is_training[i] = true;
  }
  std::vector<JudgedTarget> judged(targets.size());
  std::vector<TrainingTarget> training(targets.size());
  parallel_for(targets.size(), options.jobs, [&](std::size_t i) {
    const auto recordings = recorded(targets[i], options.preparation.alignment);
    judged[i] = judged_target(targets[i].labels, recordings);
    if (targets[i].noise_free) judged[i].query.repetitions = std::numeric_limits<double>::infinity();
    if (is_training[i]) training[i] = training_target(targets[i].labels, recordings, options.preparation, needs, i);
  });

  Validation validation;
  std::vector<std::size_t> place(targets.size());  // of a target left out, among the scores
  for (std::size_t i = 0; i < targets.size(); ++i) {
    place[i] = validation.noise_floor.size();
    if (is_left_out[i]) validation.noise_floor.push_back(judged[i].noise_floor);
  }
  validation.scores.resize(validation.noise_floor.size() * chosen.size());
  std::vector<double> seconds(folds.size() * chosen.size());
  const auto first = first_of_same(chosen);
  parallel_for(seconds.size(), options.jobs, [&](std::size_t job) {
    const Split& split = folds[job / chosen.size()];
    const std::size_t m = job % chosen.size();
    if (first[m] != m) return;
    const Method& method = *chosen[m];
    Fold fold;
    Neighbours neighbours;
    for (const std::size_t i : split.training) {
      fold.push_back(&training[i]);
      neighbours.push_back(&judged[i]);
    }
    std::vector<Predicted> predicted;
    const double begin = processor_time();
    try {
      const Predictor predictor = method.train(fold, options.preparation);
      for (const std::size_t i : split.left_out) predicted.push_back(predictor(judged[i].query));
    } catch (const DataError& error) {
      throw DataError(error.id(), fmt::format("{} (method {}, judged on {})", error.what(), method.name,
                                              describe_fold(split, judged)));
    }
    seconds[job] = processor_time() - begin;
    for (std::size_t k = 0; k < predicted.size(); ++k) {
      const std::size_t i = split.left_out[k];
      const ValidationScore result = score(predicted[k], judged[i], neighbours, method.name);
      for (std::size_t other = m; other < chosen.size(); ++other) {
        if (first[other] != m) continue;
        ValidationScore& own = validation.scores[place[i] * chosen.size() + other];
        own = result;
        own.method = chosen[other]->name;
      }
    }
  });

  for (std::size_t m = 0; m < chosen.size(); ++m) {
    validation.times.push_back({chosen[m]->name, 0});
    for (std::size_t f = 0; f < folds.size(); ++f) validation.times[m].seconds += seconds[f * chosen.size() + first[m]];
  }
  for (const auto& split : folds) {
    for (const std::size_t i : split.training) validation.lifted_gates += training[i].small_change ? 1 : 0;
  }
  return validation;
}

}  // namespace

double outside_depth(const Samples& path, const Query& query, std::vector<const JudgedTarget*> demonstrated) {
  std::stable_sort(demonstrated.begin(), demonstrated.end(), [&](const JudgedTarget* a, const JudgedTarget* b) {
    return (a->query.change() - query.change()).norm() < (b->query.change() - query.change()).norm();
  });
  const Samples deviation = path - straight_line(query.start, query.goal, linspace(0, 1, path.rows()));
  Samples low = Samples::Constant(path.rows(), path.cols(), std::numeric_limits<double>::infinity());
  Samples high = -low;
  for (std::size_t i = 0; i < std::min(neighbour_count, demonstrated.size()); ++i) {
    for (const auto& swept : demonstrated[i]->deviations) {
      low = low.cwiseMin(swept);
      high = high.cwiseMax(swept);
    }
  }
  const Samples beyond = (low - deviation).cwiseMax(deviation - high).cwiseMax(0.0);
  return beyond.rowwise().norm().maxCoeff();
}

BandScore band_score(const Predicted& predicted, double level, const Samples& mean_path) {
  // Both ends are given to the method, so they are no test of its band.
  const Eigen::Index inner = mean_path.rows() - 2;
  const Samples error = (predicted.path - mean_path).cwiseAbs();
  const Samples pointwise = predicted.band(BandKind::pointwise, level);
  const Samples path = predicted.band(BandKind::path, level);
  const auto inside = [&](const Samples& half_width) {
    return (error.array() <= half_width.array()).middleRows(1, inner).cast<double>().eval();
  };
  return {inside(pointwise).mean(), inside(path).minCoeff(), pointwise.middleRows(1, inner).mean()};
}

Validation leave_one_target_out(const std::vector<TargetDemonstrations>& targets, const ValidationOptions& options) {
  if (left_out_together(targets, {}).size() < 3) {
    throw DataError("validation.too_few_targets",
                    fmt::format("leaving one target out needs at least three targets, not {}",
                                left_out_together(targets, {}).size()));
  }
  return judge(targets, splits(left_out_together(targets, options.folds), targets.size()), options);
}

Validation judge_on_test_targets(const std::vector<TargetDemonstrations>& targets,
                                 const std::vector<TargetDemonstrations>& test, const ValidationOptions& options) {
  if (targets.size() < 2) {
    throw DataError("validation.too_few_targets",
                    fmt::format("learning needs at least two targets, not {}", targets.size()));
  }
  if (test.empty()) throw DataError("validation.no_test_target", "there is no target to be judged on");
  auto all = targets;
  all.insert(all.end(), test.begin(), test.end());
  Split split;
  for (std::size_t i = 0; i < all.size(); ++i) (i < targets.size() ? split.training : split.left_out).push_back(i);
  return judge(all, {split}, options);
}

}  // namespace lfd
