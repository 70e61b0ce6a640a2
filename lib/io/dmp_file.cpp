#include "lfdtools/io/dmp_file.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "json_check.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.dmp";
constexpr Eigen::Index most_bases = 1000;

template <class Value>
Value read_word(const JsonView& view, std::initializer_list<Value> values) {
  const std::string name = view.string();
  std::string known;
  for (const Value value : values) {
    if (name == word(value)) return value;
    known += (known.empty() ? "" : ", ") + std::string(word(value));
  }
  view.fail("json.out_of_range", "this is none of " + known);
}

/// A covariance of weights: an axis without noise has none, so that zero directions are allowed, negative ones are not.
Matrix read_covariance(const JsonView& view, Eigen::Index N) {
  Matrix C = view.matrix(N, N);
  require_symmetric(view, C, "dmp.not_symmetric");
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(C, Eigen::EigenvaluesOnly);
  const Vector& values = solver.eigenvalues();
  constexpr double rounding = 1e-9;
  if (solver.info() != Eigen::Success || !values.allFinite() || values[0] < -rounding * std::max(values[N - 1], 0.0)) {
    view.fail("dmp.not_positive_definite", "the covariance of the weights has a negative direction");
  }
  return C;
}

}  // namespace

const char* word(DmpScaling scaling) {
  return scaling == DmpScaling::goal ? "goal" : "none";
}

const char* word(DmpFitMethod fit) {
  switch (fit) {
    case DmpFitMethod::ls:
      return "ls";
    case DmpFitMethod::lwr:
      return "lwr";
    default:
      return "trajectory";
  }
}

DmpSettings read_dmp_settings(const JsonView& object) {
  DmpSettings settings;
  settings.scaling = read_word(object.at("scaling"), {DmpScaling::none, DmpScaling::goal});
  settings.alpha_z = object.at("alpha_z").positive();
  settings.beta_z = object.at("beta_z").positive();
  settings.alpha_x = object.at("alpha_x").positive();
  const JsonView centers = object.at("centers");
  settings.centers = centers.vector();
  const Eigen::Index N = settings.centers.size();
  if (N < 1 || N > most_bases) {
    centers.fail("json.out_of_range", "there must be 1 to " + std::to_string(most_bases) + " basis functions");
  }
  const JsonView widths = object.at("widths");
  settings.widths = widths.vector(N);
  for (Eigen::Index i = 0; i < N; ++i) (void)widths.at(static_cast<std::size_t>(i)).positive();
  checked(object, [&] { check(settings); });
  return settings;
}

void write_dmp_settings(JsonWriter& json, const DmpSettings& settings) {
  json.member("scaling", word(settings.scaling)).member("alpha_z", settings.alpha_z).member("beta_z", settings.beta_z);
  json.member("alpha_x", settings.alpha_x);
  json.member("centers", settings.centers).member("widths", settings.widths);
}

DmpFile read_dmp(const JsonDocument& document) {
  DmpFile file;
  file.header = read_header(document, format);
  const JsonView root = document.root();
  root.only({"format",  "version", "columns", "target",  "demo", "teacher",           "provenance",
             "scaling", "alpha_z", "beta_z",  "alpha_x", "tau",  "centers",           "widths",
             "start",   "goal",    "weights", "rmse",    "fit",  "weights_covariance"});
  const auto D = static_cast<Eigen::Index>(file.header.columns.size());
  Dmp& dmp = file.dmp;
  dmp.settings = read_dmp_settings(root);
  const Eigen::Index N = dmp.settings.bases();
  dmp.tau = root.at("tau").positive();
  dmp.start = root.at("start").vector(D);
  dmp.goal = root.at("goal").vector(D);
  dmp.weights = root.at("weights").matrix(D, N);
  const JsonView rmse = root.at("rmse");
  dmp.rmse = rmse.vector(D);
  for (Eigen::Index i = 0; i < D; ++i) {
    if (dmp.rmse[i] < 0) rmse.at(static_cast<std::size_t>(i)).fail("json.out_of_range", "the error is negative");
  }
  dmp.fit = read_word(root.at("fit"), {DmpFitMethod::trajectory, DmpFitMethod::ls, DmpFitMethod::lwr});
  if (const auto list = root.find("weights_covariance")) {
    if (static_cast<Eigen::Index>(list->size()) != D) {
      list->fail("json.wrong_length", "there must be one covariance for each of the " + std::to_string(D) + " signals");
    }
    for (std::size_t i = 0; i < list->size(); ++i) dmp.weights_covariance.push_back(read_covariance(list->at(i), N));
  }
  checked(root, [&] { check(dmp); });
  return file;
}

void write_dmp(const DmpFile& file, Output& out) {
  JsonWriter json;
  const Dmp& dmp = file.dmp;
  write_header(json, format, file.header);
  write_dmp_settings(json, dmp.settings);
  json.member("tau", dmp.tau).member("start", dmp.start).member("goal", dmp.goal).member("weights", dmp.weights);
  json.member("rmse", dmp.rmse).member("fit", word(dmp.fit));
  if (!dmp.weights_covariance.empty()) {
    json.key("weights_covariance").begin_array();
    for (const Matrix& C : dmp.weights_covariance) json.matrix(C);
    json.end_array();
  }
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
