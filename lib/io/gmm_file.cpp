#include "lfdtools/io/gmm_file.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "json_check.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.gmm";
constexpr Eigen::Index most_components = 10'000;
constexpr Eigen::Index most_columns = 1000;
constexpr double prior_tolerance = 1e-9;

/// The words of an enumeration; the first is that of a file that does not say.
template <typename Value, std::size_t N>
using Words = std::array<std::pair<const char*, Value>, N>;

constexpr Words<CovarianceType, 4> covariance_types{{{"full", CovarianceType::full},
                                                     {"tied", CovarianceType::tied},
                                                     {"diagonal", CovarianceType::diagonal},
                                                     {"spherical", CovarianceType::spherical}}};
constexpr Words<Criterion, 3> criterion_words{
    {{"bic", Criterion::bic}, {"aic", Criterion::aic}, {"icl", Criterion::icl}}};
constexpr Words<Likelihood, 2> likelihoods{{{"samples", Likelihood::samples}, {"effective", Likelihood::effective}}};

template <typename Value, std::size_t N>
const char* word(const Words<Value, N>& words, Value value) {
  for (const auto& [name, meaning] : words) {
    if (meaning == value) return name;
  }
  return words.front().first;
}

template <typename Value, std::size_t N>
Value read_word(const JsonView& root, const char* key, const Words<Value, N>& words) {
  const auto view = root.find(key);
  if (!view) return words.front().second;
  const std::string given = view->string();
  std::string all;
  for (const auto& [name, meaning] : words) {
    if (given == name) return meaning;
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  view->fail("json.out_of_range", std::string(key) + " is none of " + all);
}

/// diagonal, spherical: nothing off the diagonals. tied: all the same. Up to rounding.
void require_type(const JsonView& covariances, const std::vector<Matrix>& Sigma, CovarianceType type) {
  if (type == CovarianceType::full) return;
  for (std::size_t k = 0; k < Sigma.size(); ++k) {
    const Vector sd = Sigma[k].diagonal().cwiseSqrt();
    const Matrix wanted = type == CovarianceType::tied ? Sigma.front() : Matrix(Sigma[k].diagonal().asDiagonal());
    if (((Sigma[k] - wanted).cwiseAbs().array() > 1e-9 * (sd * sd.transpose()).array()).any()) {
      covariances.at(k).fail("gmm.covariance_type", std::string("the covariance is not that of a mixture of type ") +
                                                        word(covariance_types, type));
    }
  }
}

void read_mixture(const JsonView& root, Eigen::Index columns, Gmm& gmm) {
  const JsonView priors = root.at("priors");
  gmm.priors = priors.vector();
  const Eigen::Index K = gmm.priors.size();
  if (K < 1 || K > most_components) {
    priors.fail("json.out_of_range", "a mixture has 1 to " + std::to_string(most_components) + " components");
  }
  for (Eigen::Index k = 0; k < K; ++k) {
    if (gmm.priors[k] < 0) priors.at(static_cast<std::size_t>(k)).fail("gmm.priors", "the prior is negative");
  }
  if (!(std::abs(gmm.priors.sum() - 1) <= prior_tolerance)) {
    priors.fail("gmm.priors", "the priors sum to " + number_text(gmm.priors.sum()) + " instead of 1");
  }
  gmm.means = root.at("means").matrix(K, columns);
  const JsonView covariances = root.at("covariances");
  if (static_cast<Eigen::Index>(covariances.size()) != K) {
    covariances.fail("json.wrong_length", "there are " + std::to_string(covariances.size()) + " covariances and " +
                                              std::to_string(K) + " priors");
  }
  for (std::size_t k = 0; k < covariances.size(); ++k) {
    const JsonView view = covariances.at(k);
    const Matrix Sigma = view.matrix(columns, columns);
    require_symmetric(view, Sigma, "gmm.not_symmetric");
    Matrix L;
    if (!try_cholesky(Sigma, L)) view.fail("gmm.not_positive_definite", "the covariance is not positive definite");
    gmm.covariances.push_back(Sigma);
  }
  checked(root, [&] { check(gmm); });
}

// What may be missing is 0 then.
double number(const JsonView& object, const char* key) {
  const auto view = object.find(key);
  return view ? view->number() : 0.0;
}

Eigen::Index count(const JsonView& object, const char* key) {
  const auto view = object.find(key);
  return view ? view->integer(0, std::numeric_limits<long long>::max()) : 0;
}

std::vector<Selection> read_selection(const JsonView& list) {
  std::vector<Selection> table;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView row = list.at(i);
    row.only({"k", "log_likelihood", "bic", "aic", "icl", "parameters", "entropy"});
    table.push_back({row.at("k").integer(1, most_components), row.at("log_likelihood").number(), row.at("bic").number(),
                     row.at("aic").number(), number(row, "icl"), count(row, "parameters"), number(row, "entropy")});
  }
  return table;
}

}  // namespace

GmmFile read_gmm(const JsonDocument& document) {
  GmmFile file;
  file.header = read_header(document, format);
  const JsonView root = document.root();
  root.only({"format",      "version",        "columns",         "target",    "demo",
             "teacher",     "provenance",     "covariance_type", "priors",    "means",
             "covariances", "regularization", "log_likelihood",  "bic",       "aic",
             "samples",     "bic_n",          "iterations",      "converged", "time_range",
             "start",       "goal",           "selection",       "icl",       "criterion",
             "parameters",  "entropy",        "bic_likelihood"});
  const auto columns = static_cast<Eigen::Index>(file.header.columns.size());
  const JsonView names = root.at("columns");
  if (columns < 2 || columns > most_columns) {
    names.fail("json.wrong_length", "time and 1 to " + std::to_string(most_columns - 1) + " signals are needed");
  }
  if (file.header.columns[0] != "t") names.at(0).fail("json.out_of_range", "the first column must be t");
  file.covariance_type = read_word(root, "covariance_type", covariance_types);
  read_mixture(root, columns, file.gmm);
  require_type(root.at("covariances"), file.gmm.covariances, file.covariance_type);

  const JsonView range = root.at("time_range");
  const Vector times = range.vector(2);
  if (!(times[0] < times[1])) range.fail("json.out_of_range", "the time range does not rise");
  file.time_range = {times[0], times[1]};
  file.start = root.at("start").vector(columns - 1);
  file.goal = root.at("goal").vector(columns - 1);

  file.log_likelihood = number(root, "log_likelihood");
  file.bic = number(root, "bic");
  file.aic = number(root, "aic");
  file.icl = number(root, "icl");
  file.bic_n = number(root, "bic_n");
  file.entropy = number(root, "entropy");
  file.parameters = count(root, "parameters");
  file.samples = count(root, "samples");
  file.iterations = count(root, "iterations");
  file.criterion = read_word(root, "criterion", criterion_words);
  file.likelihood = read_word(root, "bic_likelihood", likelihoods);
  if (const auto view = root.find("converged")) file.converged = view->boolean();
  if (const auto view = root.find("regularization")) file.regularization = view->vector(columns);
  if (const auto view = root.find("selection")) file.selection = read_selection(*view);
  return file;
}

GmmFile gmm_file(ComponentSelection selection, const CriterionOptions& criterion, CovarianceType type) {
  GmmFile file;
  GmmFit& fit = selection.fit;
  file.covariance_type = type;
  file.gmm = std::move(fit.gmm);
  file.regularization = fit.regularization;
  file.log_likelihood = fit.log_likelihood;
  file.criterion = criterion.criterion;
  file.likelihood = criterion.likelihood;
  file.bic = fit.bic;
  file.aic = fit.aic;
  file.icl = fit.icl;
  file.parameters = fit.parameters;
  file.entropy = fit.entropy;
  file.samples = fit.samples;
  file.bic_n = selection.bic_n;
  file.iterations = fit.iterations;
  file.converged = fit.converged;
  file.selection = std::move(selection.table);
  return file;
}

void write_gmm(const GmmFile& file, Output& out) {
  JsonWriter json;
  write_header(json, format, file.header);
  json.member("covariance_type", word(covariance_types, file.covariance_type)).member("priors", file.gmm.priors);
  json.key("means").matrix(file.gmm.means).key("covariances").begin_array();
  for (const Matrix& Sigma : file.gmm.covariances) json.matrix(Sigma);
  json.end_array().member("regularization", file.regularization);
  json.member("log_likelihood", file.log_likelihood).member("parameters", file.parameters);
  json.member("entropy", file.entropy).member("bic", file.bic).member("aic", file.aic).member("icl", file.icl);
  json.member("criterion", word(criterion_words, file.criterion));
  json.member("bic_likelihood", word(likelihoods, file.likelihood));
  json.member("samples", file.samples).member("bic_n", file.bic_n).member("iterations", file.iterations);
  json.member("converged", file.converged);
  json.key("time_range").begin_array().number(file.time_range[0]).number(file.time_range[1]).end_array();
  json.member("start", file.start).member("goal", file.goal).key("selection").begin_array();
  for (const Selection& row : file.selection) {
    json.begin_object().member("k", row.k).member("log_likelihood", row.log_likelihood);
    json.member("parameters", row.parameters).member("entropy", row.entropy);
    json.member("bic", row.bic).member("aic", row.aic).member("icl", row.icl).end_object();
  }
  json.end_array();
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
