#include "lfdtools/io/skill_file.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <utility>

#include "json_check.hpp"
#include "lfdtools/io/dmp_file.hpp"

namespace lfd {
namespace {

constexpr std::array<std::pair<MeanType, std::string_view>, 3> mean_names{
    {{MeanType::zero, "zero"}, {MeanType::constant, "constant"}, {MeanType::linear, "linear"}}};
constexpr std::array<std::pair<OmegaRule, std::string_view>, 2> omega_names{
    {{OmegaRule::integrated, "integrated"}, {OmegaRule::ml, "ml"}}};

template <typename Value, std::size_t n>
std::string_view name_of(const std::array<std::pair<Value, std::string_view>, n>& names, Value value) {
  return std::find_if(names.begin(), names.end(), [&](const auto& entry) { return entry.first == value; })->second;
}

template <typename Value, std::size_t n>
Value value_of(const std::array<std::pair<Value, std::string_view>, n>& names, const JsonView& view) {
  const std::string name = view.string();
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& entry) { return entry.second == name; });
  if (found == names.end()) view.fail("skill.unknown_name", fmt::format("'{}' is not known here", name));
  return found->first;
}

/// Positions of names in a list of names.
std::vector<int> indices(const JsonView& view, const std::vector<std::string>& among) {
  std::vector<int> result;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::string name = view.at(i).string();
    const auto found = std::find(among.begin(), among.end(), name);
    if (found == among.end())
      view.at(i).fail("skill.unknown_signal", fmt::format("there is no signal '{}' here", name));
    const int index = static_cast<int>(found - among.begin());
    if (std::find(result.begin(), result.end(), index) != result.end()) {
      view.at(i).fail("skill.repeated_signal", fmt::format("signal '{}' stands twice", name));
    }
    result.push_back(index);
  }
  return result;
}

std::vector<std::string> names(const std::vector<int>& positions, const std::vector<std::string>& among) {
  std::vector<std::string> result;
  for (const int position : positions) result.push_back(among[static_cast<std::size_t>(position)]);
  return result;
}

/// Omega and Psi are covariances; outputs in proportion may leave them without extent in some directions.
void check_covariance(const JsonView& view, const Matrix& A) {
  require_symmetric(view, A, "skill.not_symmetric");
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(A, Eigen::EigenvaluesOnly);
  const Vector& values = solver.eigenvalues();
  if (solver.info() != Eigen::Success || values[0] < -1e-9 * std::max(values[values.size() - 1], 0.0)) {
    view.fail("skill.not_positive_definite", "the covariance has a negative direction");
  }
}

/// What inputs of models may be called: each signal (its goal - start), then start_ and each signal, then teacher.
std::vector<std::string> input_names(std::vector<std::string> columns) {
  for (std::size_t j = 0, D = columns.size(); j < D; ++j) columns.push_back("start_" + columns[j]);
  columns.push_back("teacher");
  return columns;
}

KernelTerm read_term(const JsonView& view, const std::vector<std::string>& inputs, bool term_of_sum) {
  view.only({"type", "variance", "inputs", "length_scales", "within"});
  KernelTerm term;
  checked(view.at("type"), [&] { term.type = kernel_type_from_name(view.at("type").string()); });
  term.variance = view.at("variance").positive();
  if (term_of_sum || view.has("inputs")) {
    term.inputs = indices(view.at("inputs"), inputs);
  } else if (term.type != KernelType::constant) {
    for (int j = 0; j < static_cast<int>(inputs.size()); ++j) term.inputs.push_back(j);
  }
  term.length_scales = view.at("length_scales").vector(static_cast<Eigen::Index>(term.inputs.size()));
  if (const auto within = view.find("within")) {
    const auto found = std::find(inputs.begin(), inputs.end(), within->string());
    if (found == inputs.end())
      within->fail("skill.unknown_signal", fmt::format("there is no input '{}' here", within->string()));
    term.within = static_cast<int>(found - inputs.begin());
  }
  return term;
}

Kernel read_kernel(const JsonView& view, const std::vector<std::string>& inputs) {
  Kernel kernel;
  if (view.at("type").string() == "sum") {
    view.only({"type", "terms"});
    const JsonView terms = view.at("terms");
    for (std::size_t i = 0; i < terms.size(); ++i) kernel.terms.push_back(read_term(terms.at(i), inputs, true));
  } else {
    kernel.terms.push_back(read_term(view, inputs, false));
  }
  checked(view, [&] { check_kernel(kernel, static_cast<int>(inputs.size())); });
  return kernel;
}

SkillModel read_model(const JsonView& view, const std::vector<std::string>& columns, Eigen::Index n, Eigen::Index N) {
  view.only({"inputs", "outputs", "kernel", "noise_variance", "noise", "mean", "X", "Y", "output_transform",
             "omega_rule", "omega", "nu", "psi", "log_marginal_likelihood"});
  SkillModel model;
  model.inputs = indices(view.at("inputs"), input_names(columns));
  model.outputs = indices(view.at("outputs"), columns);
  const auto p = static_cast<Eigen::Index>(model.inputs.size());
  const auto d = static_cast<Eigen::Index>(model.outputs.size()) * N;
  if (p == 0) view.at("inputs").fail("skill.shape", "a model needs an input");
  if (d == 0) view.at("outputs").fail("skill.shape", "a model needs an output");
  MvgpModel& process = model.process;
  process.kernel = read_kernel(view.at("kernel"), names(model.inputs, input_names(columns)));
  process.noise_variance = view.at("noise_variance").number(0, 1e300);
  if (const auto noise = view.find("noise")) process.noise = noise->vector(n);
  const JsonView mean = view.at("mean");
  mean.only({"type", "coefficients"});
  process.mean = value_of(mean_names, mean.at("type"));
  const Eigen::Index rows = process.mean == MeanType::zero ? 0 : process.mean == MeanType::constant ? 1 : 1 + p;
  if (rows == 0 && mean.has("coefficients") && mean.at("coefficients").size() > 0) {
    mean.at("coefficients").fail("json.wrong_length", "a zero mean has no coefficients");
  }
  process.coefficients = rows == 0 ? Matrix(0, d) : mean.at("coefficients").matrix(rows, d);
  process.X = view.at("X").matrix(n, p);
  process.Y = view.at("Y").matrix(n, d);
  if (const auto transform = view.find("output_transform"); transform && !transform->is_null())
    process.output_transform = transform->matrix(d, d);
  if (const auto rule = view.find("omega_rule")) process.omega_rule = value_of(omega_names, *rule);
  process.omega = view.at("omega").matrix(d, d);
  if (process.omega_rule == OmegaRule::integrated) {
    process.nu = view.at("nu").number(0, 1e300);
    const JsonView psi = view.at("psi");
    process.psi = psi.is_array() ? psi.matrix(d, d) : Matrix::Constant(1, 1, psi.positive());
  }
  process.log_marginal_likelihood = view.at("log_marginal_likelihood").number();
  if (process.omega_rule == OmegaRule::integrated && process.psi.size() > 1)
    check_covariance(view.at("psi"), process.psi);
  check_covariance(view.at("omega"), process.omega);
  checked(view, [&] { (void)MvgpPredictor(process); });
  return model;
}

void write_term(JsonWriter& json, const KernelTerm& term, const std::vector<std::string>& inputs, bool term_of_sum) {
  json.begin_object().member("type", kernel_type_name(term.type)).member("variance", term.variance);
  if (term_of_sum) json.member("inputs", names(term.inputs, inputs));
  if (term.within >= 0) json.member("within", inputs[static_cast<std::size_t>(term.within)]);
  json.key("length_scales").vector(term.length_scales).end_object();
}

void write_model(JsonWriter& json, const SkillModel& model, const std::vector<std::string>& columns) {
  const MvgpModel& process = model.process;
  const auto inputs = names(model.inputs, input_names(columns));
  json.begin_object().member("inputs", inputs).member("outputs", names(model.outputs, columns));
  json.key("kernel");
  if (process.kernel.terms.size() == 1) {
    write_term(json, process.kernel.terms.front(), inputs, false);
  } else {
    json.begin_object().member("type", "sum").key("terms").begin_array();
    for (const auto& term : process.kernel.terms) write_term(json, term, inputs, true);
    json.end_array().end_object();
  }
  json.member("noise_variance", process.noise_variance);
  if (process.noise.size() > 0) json.member("noise", process.noise);
  json.key("mean").begin_object().member("type", name_of(mean_names, process.mean));
  json.key("coefficients").matrix(process.coefficients).end_object();
  json.member("X", process.X).member("Y", process.Y).key("output_transform");
  if (process.output_transform.size() > 0) {
    json.matrix(process.output_transform);
  } else {
    json.null();
  }
  json.member("omega_rule", name_of(omega_names, process.omega_rule)).member("omega", process.omega);
  if (process.omega_rule == OmegaRule::integrated) {
    json.member("nu", process.nu).key("psi");
    if (process.psi.size() == 1) {
      json.number(process.psi(0, 0));
    } else {
      json.matrix(process.psi);
    }
  }
  json.member("log_marginal_likelihood", process.log_marginal_likelihood).end_object();
}

Calibration read_calibration(const JsonView& view, Eigen::Index D) {
  view.only({"targets", "target_variance", "reproduction", "levels", "pointwise", "path"});
  Calibration calibration;
  calibration.targets = static_cast<int>(view.at("targets").integer(1, 1'000'000));
  calibration.target_variance = view.at("target_variance").vector(D);
  calibration.reproduction = view.at("reproduction").vector(D);
  const auto L = static_cast<Eigen::Index>(view.at("levels").size());
  if (L == 0) view.at("levels").fail("skill.shape", "a calibration needs a level");
  calibration.levels = view.at("levels").vector(L);
  calibration.pointwise = view.at("pointwise").vector(L);
  calibration.path = view.at("path").vector(L);
  double last = 0;
  for (const double level : calibration.levels) {
    if (!(level > last && level < 1)) view.at("levels").fail("skill.levels", "levels must rise inside (0, 1)");
    last = level;
  }
  if (calibration.pointwise.minCoeff() < 0 || calibration.path.minCoeff() < 0 ||
      calibration.reproduction.minCoeff() < 0 || calibration.target_variance.minCoeff() < 0) {
    view.fail("skill.calibration", "factors and distances must not be negative");
  }
  return calibration;
}

void write_calibration(JsonWriter& json, const Calibration& calibration) {
  json.key("calibration").begin_object().member("targets", calibration.targets);
  json.member("target_variance", calibration.target_variance).member("reproduction", calibration.reproduction);
  json.member("levels", calibration.levels).member("pointwise", calibration.pointwise);
  json.member("path", calibration.path).end_object();
}

}  // namespace

SkillFile read_skill(const JsonDocument& document) {
  SkillFile file;
  file.header = read_header(document, skill_format);
  const JsonView root = document.root();
  root.only({"format", "version", "columns", "target", "demo", "teacher", "provenance", "dmp", "start", "start_spread",
             "rows", "duration", "models", "calibration"});
  Skill& skill = file.skill;
  skill.columns = file.header.columns;
  const auto D = static_cast<Eigen::Index>(skill.columns.size());
  root.at("dmp").only({"scaling", "alpha_z", "beta_z", "alpha_x", "centers", "widths"});
  skill.dmp = read_dmp_settings(root.at("dmp"));
  skill.start = root.at("start").vector(D);
  skill.start_spread = root.at("start_spread").number(0, 1e300);
  const JsonView rows = root.at("rows");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.at(i).only({"target", "demo", "teacher"});
    skill.rows.push_back(read_labels(rows.at(i)));
  }
  const JsonView duration = root.at("duration");
  duration.only({"mean", "coefficients", "sd", "range"});
  skill.duration.mean = duration.at("mean").number();
  skill.duration.coefficients = duration.at("coefficients").vector(D);
  if (const auto sd = duration.find("sd")) skill.duration.sd = sd->number(0, 1e300);
  const Vector range = duration.at("range").vector(2);
  if (!(range[0] > 0) || range[1] < range[0]) {
    duration.at("range").fail("skill.duration", "the range of durations is not positive and rising");
  }
  std::copy_n(range.data(), 2, skill.duration.range);
  if (const auto calibration = root.find("calibration")) skill.calibration = read_calibration(*calibration, D);
  const JsonView models = root.at("models");
  std::vector<int> given(skill.columns.size(), 0);
  for (std::size_t i = 0; i < models.size(); ++i) {
    skill.models.push_back(
        read_model(models.at(i), skill.columns, static_cast<Eigen::Index>(skill.rows.size()), skill.dmp.bases()));
    for (const int output : skill.models.back().outputs) ++given[static_cast<std::size_t>(output)];
  }
  for (std::size_t j = 0; j < given.size(); ++j) {
    if (given[j] != 1) {
      models.fail("skill.outputs", fmt::format("signal '{}' is the output of {} models", skill.columns[j], given[j]));
    }
  }
  return file;
}

void write_skill(const SkillFile& file, Output& out) {
  const Skill& skill = file.skill;
  JsonWriter json;
  write_header(json, skill_format, file.header);
  json.key("dmp").begin_object();
  write_dmp_settings(json, skill.dmp);
  json.end_object();
  json.member("start", skill.start).member("start_spread", skill.start_spread).key("rows").begin_array();
  for (const auto& row : skill.rows) {
    json.begin_object();
    write_labels(json, row);
    json.end_object();
  }
  json.end_array().key("duration").begin_object().member("mean", skill.duration.mean);
  json.member("coefficients", skill.duration.coefficients).member("sd", skill.duration.sd);
  json.key("range").begin_array().number(skill.duration.range[0]).number(skill.duration.range[1]).end_array();
  json.end_object().key("models").begin_array();
  for (const auto& model : skill.models) write_model(json, model, skill.columns);
  json.end_array();
  if (skill.calibration) write_calibration(json, *skill.calibration);
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
