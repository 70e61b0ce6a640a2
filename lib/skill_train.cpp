#include "lfdtools/skill_train.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/tempo.hpp"

namespace lfd {
namespace {

Matrix changes(const std::vector<SkillRow>& rows) {
  Matrix X(static_cast<Eigen::Index>(rows.size()), rows.front().primitive.dimensions());
  for (std::size_t i = 0; i < rows.size(); ++i) X.row(static_cast<Eigen::Index>(i)) = rows[i].change().transpose();
  return X;
}

void check_rows(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows) {
  if (rows.size() < 2) throw DataError("skill.too_few_rows", "a skill needs primitives of at least two targets");
  const Dmp& first = rows.front().primitive;
  for (const auto& row : rows) {
    check(row.primitive);
    if (row.primitive.dimensions() != static_cast<Eigen::Index>(columns.size()) ||
        !(row.primitive.settings == first.settings)) {
      throw DataError("skill.mixed_settings",
                      "primitives of different columns, scaling, alpha_z, beta_z, alpha_x, centers or widths make no "
                      "skill together (" +
                          describe(row.labels) + " differs from " + describe(rows.front().labels) + ")");
    }
  }
  if (!is_trainable(rows)) {
    throw DataError("skill.one_target",
                    "every primitive is of one target or has the same goal - start: nothing to generalise from");
  }
}

std::vector<SkillModel> structure(SkillStructure wanted, bool paper, bool starts, bool teachers, int D) {
  if (wanted == SkillStructure::automatic) wanted = paper ? SkillStructure::axis : SkillStructure::full;
  std::vector<int> outputs(static_cast<std::size_t>(D));
  std::iota(outputs.begin(), outputs.end(), 0);
  std::vector<int> inputs(static_cast<std::size_t>(starts ? 2 * D : D));
  std::iota(inputs.begin(), inputs.end(), 0);
  if (teachers) inputs.push_back(2 * D);
  std::vector<SkillModel> models;
  if (wanted == SkillStructure::joint) {
    models.push_back({inputs, outputs, {}});
    return models;
  }
  for (const int j : outputs) {
    std::vector<int> own{j};
    if (starts) own.push_back(D + j);
    if (teachers) own.push_back(2 * D);
    models.push_back({wanted == SkillStructure::axis ? own : inputs, {j}, {}});
  }
  return models;
}

/// @throws UsageError [skill.teachers]
bool tells_teachers_apart(const std::vector<Labels>& rows, const SkillOptions& options) {
  if (options.hyperparameters != nullptr) return sees_teachers(*options.hyperparameters);
  const bool sum = options.kernel == SkillKernel::automatic || options.kernel == SkillKernel::sum ||
                   options.kernel == SkillKernel::additive;
  const bool known =
      options.mean == SkillMean::automatic || options.mean == SkillMean::line || options.mean == SkillMean::zero;
  const bool possible = !options.paper && sum && known;
  if (options.teachers == SkillTeachers::apart && !possible) {
    throw UsageError(
        "skill.teachers",
        "teachers can be told apart with kernel sum or additive and mean line or zero, not with the paper's process");
  }
  const auto other = [&](const Labels& row) { return row.teacher != rows.front().teacher; };
  return possible && (options.teachers == SkillTeachers::apart ||
                      (options.teachers == SkillTeachers::automatic && std::any_of(rows.begin(), rows.end(), other)));
}

/// Inputs of a model, changes and starts apart: their ranges have nothing to do with each other.
std::vector<std::vector<int>> input_groups(const SkillModel& model, int D) {
  std::vector<std::vector<int>> groups(1);
  for (int i = 0; i < static_cast<int>(model.inputs.size()); ++i) {
    if (model.inputs[static_cast<std::size_t>(i)] == 2 * D) continue;
    const bool start = model.inputs[static_cast<std::size_t>(i)] >= D;
    if (start && groups.size() == 1) groups.emplace_back();
    groups[start ? 1 : 0].push_back(i);
  }
  return groups;
}

MvgpOptions process_options(const SkillOptions& options, const SkillModel& model, int D) {
  const int p = static_cast<int>(model.inputs.size());
  MvgpOptions process = options.paper ? paper_mvgp_options(p) : default_mvgp_options(p);
  SkillKernel wanted = options.kernel;
  if (wanted == SkillKernel::automatic) wanted = options.paper ? SkillKernel::se_ard : SkillKernel::sum;
  if (wanted == SkillKernel::sum) {
    process.kernel = sum_kernel(input_groups(model, D));
  } else if (wanted == SkillKernel::additive) {
    process.kernel = additive_kernel(input_groups(model, D));
  } else {
    process.kernel = se_ard_kernel(p);
    if (wanted == SkillKernel::matern32) process.kernel.terms.front().type = KernelType::matern32;
    if (wanted == SkillKernel::matern52) process.kernel.terms.front().type = KernelType::matern52;
  }
  if (model.inputs.back() == 2 * D) {
    process.kernel = with_own_part(std::move(process.kernel), input_groups(model, D), p - 1);
  }
  process.omega = options.omega;
  process.process = options.process;
  process.starts = options.starts;
  process.seed = options.seed;
  process.jobs = options.jobs;
  return process;
}

/// Weights of some signals, n x (N outputs): by signal, then by basis.
Matrix weights_of(const std::vector<SkillRow>& rows, const std::vector<int>& outputs) {
  const Eigen::Index N = rows.front().primitive.settings.bases();
  Matrix W(static_cast<Eigen::Index>(rows.size()), N * static_cast<Eigen::Index>(outputs.size()));
  for (Eigen::Index i = 0; i < W.rows(); ++i) {
    for (std::size_t j = 0; j < outputs.size(); ++j) {
      W.row(i).segment(static_cast<Eigen::Index>(j) * N, N) =
          rows[static_cast<std::size_t>(i)].primitive.weights.row(outputs[j]);
    }
  }
  return W;
}

Matrix block_diagonal(const Matrix& block, std::size_t count) {
  const Eigen::Index N = block.rows();
  Matrix A = Matrix::Zero(N * static_cast<Eigen::Index>(count), N * static_cast<Eigen::Index>(count));
  for (Eigen::Index from = 0; from < A.rows(); from += N) A.block(from, from, N, N) = block;
  return A;
}

/// The mean function of a model; coefficients (in the space of weights) where they are known beforehand.
struct KnownMean {
  MeanType type = MeanType::zero;
  Matrix coefficients;
};

KnownMean known_mean(const SkillOptions& options, const DmpSettings& settings, const SkillModel& model) {
  SkillMean wanted = options.mean;
  if (wanted == SkillMean::automatic) wanted = options.paper ? SkillMean::zero : SkillMean::line;
  if (wanted == SkillMean::zero) return {};
  if (wanted == SkillMean::constant) return {MeanType::constant, {}};
  if (wanted == SkillMean::linear) return {MeanType::linear, {}};
  const Eigen::RowVectorXd line = line_weights(settings).transpose();
  const Eigen::Index N = line.size();
  const bool constant = settings.scaling == DmpScaling::goal;
  KnownMean mean{constant ? MeanType::constant : MeanType::linear,
                 Matrix::Zero(constant ? 1 : 1 + static_cast<Eigen::Index>(model.inputs.size()),
                              N * static_cast<Eigen::Index>(model.outputs.size()))};
  for (std::size_t j = 0; j < model.outputs.size(); ++j) {
    const auto input = std::find(model.inputs.begin(), model.inputs.end(), model.outputs[j]) - model.inputs.begin();
    mean.coefficients.row(constant ? 0 : 1 + input).segment(static_cast<Eigen::Index>(j) * N, N) = line;
  }
  return mean;
}

/// What rows count for in the evidence: a target of a teacher once.
double evidence_power(const std::vector<SkillRow>& rows) {
  return static_cast<double>(repetition_groups(labels_of(rows)).size()) / static_cast<double>(rows.size());
}

/// The line through the durations, with a proper prior: the posterior mean of constant + linear kernel terms is a line,
/// so its values at 0 and at the unit vectors give the coefficients.
DurationModel duration_model(const std::vector<SkillRow>& rows, const SkillOptions& options) {
  const Matrix X = changes(rows);
  Matrix tau(X.rows(), 1);
  // Deviations from the mean duration, so that the prior draws towards that and not towards zero.
  for (std::size_t i = 0; i < rows.size(); ++i) tau(static_cast<Eigen::Index>(i), 0) = rows[i].primitive.tau;
  DurationModel model;
  model.range[0] = tau.minCoeff();
  model.range[1] = tau.maxCoeff();
  const double mean = tau.mean();
  tau.array() -= mean;
  MvgpOptions process = default_mvgp_options(static_cast<int>(X.cols()));
  process.kernel.terms.resize(2);  // constant, linear
  process.starts = 1;
  process.seed = options.seed;
  process.evidence_power = evidence_power(rows);
  const MvgpPredictor line(train_mvgp(X, tau, {}, process));
  model.mean = line.predict(Vector::Zero(X.cols())).mean[0];
  model.coefficients.resize(X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    model.coefficients[j] = line.predict(Vector::Unit(X.cols(), j)).mean[0] - model.mean;
  }
  const Vector residual = tau - ((X * model.coefficients).array() + model.mean).matrix();
  model.mean += mean;
  model.sd = std::sqrt(residual.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, X.rows() - 1)));
  return model;
}

/// All but the processes.
Skill untrained(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
                const SkillOptions& options) {
  const Dmp& any = rows.front().primitive;
  const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index D = any.dimensions();

  Skill skill;
  skill.columns = columns;
  skill.dmp = any.settings;
  skill.start = Vector::Zero(D);
  for (const auto& row : rows) {
    skill.rows.push_back(row.labels);
    skill.start += row.primitive.start / static_cast<double>(n);
  }
  for (const auto& a : rows) {
    for (const auto& b : rows) {
      skill.start_spread = std::max(skill.start_spread, (a.primitive.start - b.primitive.start).norm());
    }
  }
  skill.duration = duration_model(rows, options);
  const bool starts = options.hyperparameters != nullptr ? sees_starts(*options.hyperparameters)
                      : options.inputs == SkillInputs::automatic
                          ? !options.paper && skill.start_spread > start_tolerance
                          : options.inputs == SkillInputs::change_and_start;
  skill.models = structure(options.structure, options.paper, starts, tells_teachers_apart(skill.rows, options),
                           static_cast<int>(D));
  return skill;
}

void train_processes(Skill& skill, const std::vector<SkillRow>& rows, const SkillOptions& options) {
  const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index D = rows.front().primitive.dimensions();
  const Matrix metric = options.paper ? Matrix() : trajectory_metric(skill.dmp);
  const bool shared = !options.paper && skill.models.size() > 1 && skill.models[0].inputs == skill.models[1].inputs;
  for (std::size_t first = 0; first < skill.models.size(); first += shared ? skill.models.size() : 1) {
    const std::size_t last = shared ? skill.models.size() : first + 1;
    const SkillModel& model = skill.models[first];
    Matrix X(n, static_cast<Eigen::Index>(model.inputs.size()));
    for (Eigen::Index i = 0; i < n; ++i) {
      const SkillRow& row = rows[static_cast<std::size_t>(i)];
      Reach reach(row.change(), row.primitive.start - skill.start);
      reach.teacher = teacher_number(skill.rows, row.labels.teacher);
      X.row(i) = inputs_of(model, reach).transpose();
    }
    MvgpOptions process = process_options(options, model, static_cast<int>(D));
    if (!options.paper) process.evidence_power = evidence_power(rows);
    if (options.hyperparameters != nullptr) {
      const MvgpModel& known = options.hyperparameters->models.at(first).process;
      process.kernel = known.kernel;
      process.noise_variance = known.noise_variance;
      process.nu = known.nu;
      process.optimise = false;
    }
    std::vector<Matrix> weights, coefficients;
    for (std::size_t m = first; m < last; ++m) {
      weights.push_back(weights_of(rows, skill.models[m].outputs));
      KnownMean mean = known_mean(options, skill.dmp, skill.models[m]);
      process.mean = mean.type;
      if (mean.coefficients.size() > 0) coefficients.push_back(std::move(mean.coefficients));
    }
    std::vector<MvgpModel> trained = train_mvgp(
        X, weights, options.paper ? Matrix() : block_diagonal(metric, model.outputs.size()), process, coefficients);
    for (std::size_t m = first; m < last; ++m) skill.models[m].process = std::move(trained[m - first]);
  }
}

}  // namespace

Matrix trajectory_metric(const DmpSettings& settings) {
  const Eigen::Index N = settings.bases();
  const Matrix R =
      response_matrix(settings, 1.0, linspace(0, 1, phase_count)) / std::sqrt(static_cast<double>(phase_count));
  const double largest = Eigen::JacobiSVD<Matrix>(R).singularValues()[0];
  // QR of R over the floor: A A^T without squaring the condition of R.
  Matrix stacked(phase_count + N, N);
  stacked << R, 1e-6 * largest * Matrix::Identity(N, N);
  Matrix upper = Eigen::HouseholderQR<Matrix>(stacked).matrixQR().topRows(N).triangularView<Eigen::Upper>();
  for (Eigen::Index i = 0; i < N; ++i) {
    if (upper(i, i) < 0) upper.row(i) *= -1;
  }
  return upper.transpose();
}

Vector line_weights(const DmpSettings& settings) {
  const Vector s = linspace(0, 1, std::max<Eigen::Index>(400, 4 * settings.bases()));
  const Vector position = s.array().cube() * (10 + s.array() * (-15 + 6 * s.array()));
  DmpFitOptions fit;
  fit.settings = settings;
  return fit_dmp({s, position}, fit).weights.row(0).transpose();
}

Skill train_skill(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
                  const SkillOptions& options) {
  check_rows(columns, rows);
  const bool metric = !options.paper && rows.front().primitive.settings.scaling == DmpScaling::none;
  if (options.tempo == SkillTempo::shared && !metric) {
    throw DataError("skill.tempo", "a tempo can be shared by primitives of scaling none without the paper's process");
  }
  Skill skill = untrained(columns, rows, options);
  train_processes(skill, rows, options);
  if (metric && options.tempo != SkillTempo::own) train_processes(skill, with_shared_tempo(skill, rows), options);
  return skill;
}

SkillKernel choose_kernel(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
                          const SkillOptions& options) {
  if (options.kernel != SkillKernel::automatic || options.paper) return options.kernel;
  const auto missed = [&](SkillKernel kernel) {
    SkillOptions one = options;
    one.kernel = kernel;
    one.tempo = SkillTempo::own;
    one.starts = 1;
    const Skill skill = train_skill(columns, rows, one);
    const Matrix residuals = left_out_residuals(skill);
    double sum = 0;
    for (const auto& group : repetition_groups(skill.rows))
      sum += residuals(group, Eigen::all).colwise().mean().squaredNorm();
    return sum;
  };
  check_rows(columns, rows);
  if (target_groups(labels_of(rows)).size() < 4) return SkillKernel::sum;
  return missed(SkillKernel::additive) < missed(SkillKernel::sum) ? SkillKernel::additive : SkillKernel::sum;
}

bool is_trainable(const std::vector<SkillRow>& rows) {
  if (rows.size() < 2) return false;
  const auto& name = rows.front().labels.target;
  if (name && std::all_of(rows.begin(), rows.end(), [&](const auto& row) { return row.labels.target == name; })) {
    return false;
  }
  const Matrix X = changes(rows);
  const Eigen::RowVectorXd first = X.row(0);
  return (X.rowwise() - first).rowwise().norm().maxCoeff() >= 1e-6;
}

}  // namespace lfd
