#include "lfdtools/validation.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <functional>
#include <numeric>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/dtw.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"
#include "lfdtools/gmm.hpp"
#include "lfdtools/gmr.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/parallel.hpp"

namespace lfd {
namespace {

constexpr Eigen::Index phase_count = 200;
constexpr Eigen::Index reference_samples = 200;
constexpr std::size_t neighbour_count = 4;

/// What is known of one target, whatever is left out: none of it looks at other targets.
struct Prepared {
  Labels labels;
  std::size_t repetitions = 0;
  Vector start, goal;                    // means of the measured ends
  Samples mean_path;                     // phase_count x D
  std::vector<Samples> deviations;       // of each demonstration from its straight line, phase_count x D
  std::vector<SkillRow> demonstrations;  // fit trajectory, scaling none
  std::optional<SkillRow> reference;     // the same fit of the GMR reference
  std::optional<SkillRow> paper;         // fit lwr, scaling goal
  bool small_change = false;             // the gate of the paper's scaling would refuse it

  [[nodiscard]] Vector change() const { return goal - start; }
};

/// A predicted motion on the phases, and the 95 % band about it if the method has one.
struct Predicted {
  Samples path;
  Samples band;  // half-width, phase_count x D, or empty
};

using Fold = std::vector<const Prepared*>;
using Predictor = std::function<Predicted(const Fold&, const Prepared&, const ValidationOptions&)>;

Samples path_of(const Dmp& dmp) {
  return rollout(dmp, linspace(0, dmp.tau, phase_count)).positions;
}

std::vector<SkillRow> rows_of(const Fold& fold, bool paper, Road road) {
  std::vector<SkillRow> rows;
  for (const auto* target : fold) {
    if (paper) {
      rows.push_back(*target->paper);
    } else if (road == Road::references) {
      rows.push_back(*target->reference);
    } else {
      rows.insert(rows.end(), target->demonstrations.begin(), target->demonstrations.end());
    }
  }
  return rows;
}

std::vector<std::string> signal_names(Eigen::Index D) {
  std::vector<std::string> names;
  for (Eigen::Index j = 0; j < D; ++j) names.push_back(fmt::format("s{}", j + 1));
  return names;
}

/// Half-width of the band on the mean of `repetitions` demonstrations: Student-t quantile times the predictive sd.
Samples band_of(const Skill& skill, const Dmp& dmp, std::size_t repetitions, Road road) {
  const Matrix R = response_matrix(skill.dmp, dmp.tau, linspace(0, dmp.tau, phase_count));
  const Vector scale = dmp.scale();
  const Eigen::Index N = skill.dmp.bases();
  Samples band = Samples::Zero(phase_count, dmp.dimensions());
  for (const auto& model : skill.models) {
    const MvgpPredictor predictor(model.process);
    Vector x(static_cast<Eigen::Index>(model.inputs.size()));
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const int input = model.inputs[static_cast<std::size_t>(j)];
      x[j] = dmp.goal[input] - dmp.start[input];
    }
    const MvgpPrediction w = predictor.predict(x);
    const double share = road == Road::demonstrations ? static_cast<double>(repetitions) : 1.0;
    const Matrix covariance = predictor.weight_covariance(w.variance + model.process.noise_variance / share);
    // Student-t: the covariance is nu / (nu - 2) times the squared scale that the quantile multiplies.
    const double nu = w.degrees_of_freedom;
    const double factor = student_t_quantile(0.975, nu) * (std::isfinite(nu) ? std::sqrt((nu - 2) / nu) : 1.0);
    for (std::size_t j = 0; j < model.outputs.size(); ++j) {
      const Eigen::Index axis = model.outputs[j];
      const Eigen::Index from = static_cast<Eigen::Index>(j) * N;
      const Matrix block = covariance.block(from, from, N, N);
      const Vector variance = ((R * block).array() * R.array()).rowwise().sum().max(0.0);
      band.col(axis) = factor * std::abs(scale[axis]) * variance.cwiseSqrt();
    }
  }
  return band;
}

Predicted predict_by_skill(const Fold& fold, const Prepared& query, const ValidationOptions& options, bool paper,
                           SkillStructure structure) {
  SkillOptions learning;
  learning.paper = paper;
  learning.structure = structure;
  learning.seed = options.seed;
  const auto rows = rows_of(fold, paper, options.road);
  const SkillPredictor predictor(train_skill(signal_names(query.start.size()), rows, learning));
  const Dmp dmp = predictor.primitive({query.labels, query.goal, query.start, {}});
  return {path_of(dmp), band_of(predictor.skill(), dmp, query.repetitions, paper ? Road::references : options.road)};
}

/// A motion from weights of the default fit.
Predicted with_weights(const Fold& fold, const Prepared& query, const Matrix& weights) {
  Dmp dmp = fold.front()->demonstrations.front().primitive;
  dmp.tau = 1;
  dmp.start = query.start;
  dmp.goal = query.goal;
  dmp.weights = weights;
  return {path_of(dmp), {}};
}

Matrix mean_weights(const Prepared& target) {
  Matrix sum = Matrix::Zero(target.demonstrations.front().primitive.weights.rows(),
                            target.demonstrations.front().primitive.weights.cols());
  for (const auto& row : target.demonstrations) sum += row.primitive.weights;
  return sum / static_cast<double>(target.demonstrations.size());
}

/// Weights = B (1, dP), ordinary least squares with the smallest coefficients where the rows leave some open.
Predicted predict_affine(const Fold& fold, const Prepared& query, bool means) {
  std::vector<std::pair<Vector, Matrix>> rows;
  for (const auto* target : fold) {
    if (means) {
      rows.emplace_back(target->change(), mean_weights(*target));
    } else {
      for (const auto& row : target->demonstrations) rows.emplace_back(row.change(), row.primitive.weights);
    }
  }
  const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index D = query.start.size();
  const Eigen::Index N = rows.front().second.cols();
  Matrix inputs(n, 1 + D);
  Matrix outputs(n, D * N);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [change, weights] = rows[static_cast<std::size_t>(i)];
    inputs.row(i) << 1.0, change.transpose();
    for (Eigen::Index j = 0; j < D; ++j) outputs.row(i).segment(j * N, N) = weights.row(j);
  }
  const Matrix B = inputs.completeOrthogonalDecomposition().solve(outputs);
  Vector x(1 + D);
  x << 1.0, query.change();
  const Eigen::RowVectorXd flat = x.transpose() * B;
  Matrix weights(D, N);
  for (Eigen::Index j = 0; j < D; ++j) weights.row(j) = flat.segment(j * N, N);
  return with_weights(fold, query, weights);
}

/// Training targets, the nearest first.
Fold by_distance(Fold fold, const Prepared& query) {
  std::stable_sort(fold.begin(), fold.end(), [&](const Prepared* a, const Prepared* b) {
    return (a->change() - query.change()).norm() < (b->change() - query.change()).norm();
  });
  return fold;
}

struct Method {
  MethodDescription description;
  bool needs_references = false;
  Predictor predict;
};

const std::vector<Method>& methods() {
  static const std::vector<Method> all = {
      {{"skill", "the default skill"},
       false,
       [](const Fold& fold, const Prepared& query, const ValidationOptions& options) {
         return predict_by_skill(fold, query, options, false, SkillStructure::automatic);
       }},
      {{"paper", "--paper on dmp-fit and mvgpr-train: one model an axis (Sec. III-C)"},
       true,
       [](const Fold& fold, const Prepared& query, const ValidationOptions& options) {
         return predict_by_skill(fold, query, options, true, SkillStructure::axis);
       }},
      {{"paper-full", "--paper with all of dP as input (Table 1)"},
       true,
       [](const Fold& fold, const Prepared& query, const ValidationOptions& options) {
         return predict_by_skill(fold, query, options, true, SkillStructure::full);
       }},
      {{"line", "straight minimum-jerk line"},
       false,
       [](const Fold&, const Prepared& query, const ValidationOptions&) {
         return Predicted{straight_line(query.start, query.goal, linspace(0, 1, phase_count)), {}};
       }},
      {{"nearest", "weights of the target with the nearest goal - start"},
       false,
       [](const Fold& fold, const Prepared& query, const ValidationOptions&) {
         return with_weights(fold, query, mean_weights(*by_distance(fold, query).front()));
       }},
      {{"mean", "mean weights of all targets"},
       false,
       [](const Fold& fold, const Prepared& query, const ValidationOptions&) {
         Matrix sum = mean_weights(*fold.front());
         for (std::size_t i = 1; i < fold.size(); ++i) sum += mean_weights(*fold[i]);
         return with_weights(fold, query, sum / static_cast<double>(fold.size()));
       }},
      {{"affine", "weights affine in goal - start, least squares on all demonstrations"},
       false,
       [](const Fold& fold, const Prepared& query, const ValidationOptions&) {
         return predict_affine(fold, query, false);
       }},
      {{"affine-means", "the same on one mean a target"},
       false,
       [](const Fold& fold, const Prepared& query, const ValidationOptions&) {
         return predict_affine(fold, query, true);
       }},
  };
  return all;
}

std::vector<const Method*> chosen_methods(const std::vector<std::string>& names) {
  std::vector<const Method*> chosen;
  if (names.empty()) {
    for (const auto& method : methods()) chosen.push_back(&method);
  }
  for (const auto& name : names) {
    const auto found = std::find_if(methods().begin(), methods().end(),
                                    [&](const Method& method) { return method.description.name == name; });
    if (found == methods().end()) {
      std::string known;
      for (const auto& method : methods()) known += (known.empty() ? "" : ", ") + method.description.name;
      throw UsageError("validation.method", fmt::format("there is no method '{}'; methods: {}", name, known));
    }
    chosen.push_back(&*found);
  }
  return chosen;
}

Prepared prepare(const TargetDemonstrations& target, const ValidationOptions& options, bool references) {
  Prepared prepared;
  prepared.labels = target.labels;
  const GroupAlignment group = align(target.demonstrations, options.alignment);
  std::vector<Trajectory> recorded;  // trimmed, as those aligned
  for (const Eigen::Index i : group.kept) recorded.push_back(group.trimmed[static_cast<std::size_t>(i)].trajectory);
  prepared.repetitions = recorded.size();
  prepared.mean_path = mean_path(recorded, phase_count);
  prepared.start = prepared.mean_path.row(0).transpose();
  prepared.goal = prepared.mean_path.row(phase_count - 1).transpose();
  const Vector phases = linspace(0, 1, phase_count);
  for (const auto& demonstration : recorded) {
    prepared.deviations.push_back(at_phases(demonstration, phase_count) -
                                  straight_line(demonstration.start(), demonstration.goal(), phases));
  }
  DmpFitOptions fit;
  fit.bases = options.bases;
  for (const auto& aligned : group.aligned) prepared.demonstrations.push_back({target.labels, fit_dmp(aligned, fit)});
  if (!references) return prepared;
  const ReferencePath reference = reference_path(group.aligned, options);
  fit.start = reference.start;
  fit.goal = reference.goal;
  prepared.reference = SkillRow{target.labels, fit_dmp(reference.path, fit)};
  fit.fit = DmpFitMethod::lwr;
  fit.scaling = DmpScaling::goal;
  fit.allow_small_scale = true;
  prepared.paper = SkillRow{target.labels, fit_dmp(reference.path, fit)};
  for (const bool small : small_goal_change(reference.path, reference.start, reference.goal)) {
    prepared.small_change = prepared.small_change || small;
  }
  return prepared;
}

double outside_depth(const Samples& path, const Fold& neighbours, const Prepared& query) {
  const Samples deviation = path - straight_line(query.start, query.goal, linspace(0, 1, path.rows()));
  Samples low = Samples::Constant(path.rows(), path.cols(), std::numeric_limits<double>::infinity());
  Samples high = -low;
  for (std::size_t i = 0; i < std::min(neighbour_count, neighbours.size()); ++i) {
    for (const auto& swept : neighbours[i]->deviations) {
      low = low.cwiseMin(swept);
      high = high.cwiseMax(swept);
    }
  }
  const Samples beyond = (low - deviation).cwiseMax(deviation - high).cwiseMax(0.0);
  return beyond.rowwise().norm().maxCoeff();
}

ValidationScore score(const Predicted& predicted, const Fold& fold, const Prepared& query, const std::string& method) {
  ValidationScore result;
  result.labels = query.labels;
  result.method = method;
  result.rmse = rms_distance(predicted.path, query.mean_path);
  result.end_error = (predicted.path.row(phase_count - 1).transpose() - query.goal).norm();
  const DtwPath path = dtw(predicted.path, query.mean_path);
  result.dtw = path.cost / static_cast<double>(path.steps.size());
  result.outside = outside_depth(predicted.path, by_distance(fold, query), query);
  if (predicted.band.size() > 0) {
    // Both ends are given to the method, so they are no test of its band.
    const Eigen::Index inner = phase_count - 2;
    const Vector inside = ((predicted.path - query.mean_path).cwiseAbs().array() <= predicted.band.array())
                              .middleRows(1, inner)
                              .rowwise()
                              .all()
                              .cast<double>();
    result.coverage95 = inside.mean();
    result.path95 = inside.minCoeff();
  }
  return result;
}

}  // namespace

const std::vector<MethodDescription>& validation_methods() {
  static const std::vector<MethodDescription> descriptions = [] {
    std::vector<MethodDescription> list;
    for (const auto& method : methods()) list.push_back(method.description);
    return list;
  }();
  return descriptions;
}

Samples straight_line(const Vector& start, const Vector& goal, const Vector& phases) {
  const Vector mj = phases.array().cube() * (10 + phases.array() * (-15 + 6 * phases.array()));
  return (mj * (goal - start).transpose()).rowwise() + start.transpose();
}

ReferencePath reference_path(const std::vector<Trajectory>& aligned, const ValidationOptions& options) {
  const Eigen::Index T = aligned.front().samples();
  const Eigen::Index D = aligned.front().dimensions();
  Samples pooled(T * static_cast<Eigen::Index>(aligned.size()), 1 + D);
  ReferencePath reference{{}, Vector::Zero(D), Vector::Zero(D)};
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    pooled.middleRows(static_cast<Eigen::Index>(i) * T, T) << aligned[i].times, aligned[i].positions;
    reference.start += aligned[i].start() / static_cast<double>(aligned.size());
    reference.goal += aligned[i].goal() / static_cast<double>(aligned.size());
  }
  EmOptions em;
  em.seed = options.seed;
  const auto selection = select_components(pooled, options.k_from, options.k_to, {}, em);
  const Vector times = linspace(pooled.col(0).minCoeff(), pooled.col(0).maxCoeff(), reference_samples);
  GmrOptions mean_alone;
  mean_alone.covariance = false;
  reference.path = {times, gmr(selection.fit.gmm, times, mean_alone).mean};
  return reference;
}

Validation leave_one_target_out(const std::vector<TargetDemonstrations>& targets, const ValidationOptions& options) {
  const auto chosen = chosen_methods(options.methods);
  if (targets.size() < 3) {
    throw DataError("validation.too_few_targets",
                    fmt::format("leaving one target out needs at least three targets, not {}", targets.size()));
  }
  const bool paper = std::any_of(chosen.begin(), chosen.end(), [](const Method* m) { return m->needs_references; });
  const bool references = paper || options.road == Road::references;
  std::vector<Prepared> prepared(targets.size());
  parallel_for(targets.size(), options.jobs,
               [&](std::size_t i) { prepared[i] = prepare(targets[i], options, references); });

  Validation validation;
  validation.scores.resize(targets.size() * chosen.size());
  parallel_for(validation.scores.size(), options.jobs, [&](std::size_t job) {
    const std::size_t left_out = job / chosen.size();
    const Method& method = *chosen[job % chosen.size()];
    Fold fold;
    for (std::size_t i = 0; i < prepared.size(); ++i) {
      if (i != left_out) fold.push_back(&prepared[i]);
    }
    const Prepared& query = prepared[left_out];
    validation.scores[job] = score(method.predict(fold, query, options), fold, query, method.description.name);
  });
  for (const auto& target : prepared) {
    if (paper && target.small_change) validation.lifted_gates += static_cast<int>(targets.size() - 1);
  }
  return validation;
}

}  // namespace lfd
