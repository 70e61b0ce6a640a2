#include "lfdtools/io/gmm_file.hpp"

#include <cmath>
#include <limits>

#include "json_check.hpp"
#include "lfdtools/io/number.hpp"

namespace lfd {
namespace {

constexpr const char* format = "lfdtools.gmm";
constexpr Eigen::Index most_components = 10'000;
constexpr Eigen::Index most_columns = 1000;
constexpr double prior_tolerance = 1e-9;

const char* word(CovarianceType type) {
  switch (type) {
    case CovarianceType::tied:
      return "tied";
    case CovarianceType::diagonal:
      return "diagonal";
    default:
      return "full";
  }
}

CovarianceType read_covariance_type(const JsonView& view) {
  const std::string name = view.string();
  for (const CovarianceType type : {CovarianceType::full, CovarianceType::tied, CovarianceType::diagonal}) {
    if (name == word(type)) return type;
  }
  view.fail("json.out_of_range", "the covariance type is none of full, tied, diagonal");
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

std::vector<Selection> read_selection(const JsonView& list) {
  std::vector<Selection> table;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView row = list.at(i);
    row.only({"k", "log_likelihood", "bic", "aic"});
    table.push_back({row.at("k").integer(1, most_components), row.at("log_likelihood").number(), row.at("bic").number(),
                     row.at("aic").number()});
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
             "start",       "goal",           "selection"});
  const auto columns = static_cast<Eigen::Index>(file.header.columns.size());
  const JsonView names = root.at("columns");
  if (columns < 2 || columns > most_columns) {
    names.fail("json.wrong_length", "time and 1 to " + std::to_string(most_columns - 1) + " signals are needed");
  }
  if (file.header.columns[0] != "t") names.at(0).fail("json.out_of_range", "the first column must be t");
  if (const auto type = root.find("covariance_type")) file.covariance_type = read_covariance_type(*type);
  read_mixture(root, columns, file.gmm);

  const JsonView range = root.at("time_range");
  const Vector times = range.vector(2);
  if (!(times[0] < times[1])) range.fail("json.out_of_range", "the time range does not rise");
  file.time_range = {times[0], times[1]};
  file.start = root.at("start").vector(columns - 1);
  file.goal = root.at("goal").vector(columns - 1);

  const auto number = [&](const char* key) {
    const auto view = root.find(key);
    return view ? view->number() : 0.0;
  };
  const auto count = [&](const char* key) -> Eigen::Index {
    const auto view = root.find(key);
    return view ? view->integer(0, std::numeric_limits<long long>::max()) : 0;
  };
  file.log_likelihood = number("log_likelihood");
  file.bic = number("bic");
  file.aic = number("aic");
  file.bic_n = number("bic_n");
  file.samples = count("samples");
  file.iterations = count("iterations");
  if (const auto view = root.find("converged")) file.converged = view->boolean();
  if (const auto view = root.find("regularization")) file.regularization = view->vector(columns);
  if (const auto view = root.find("selection")) file.selection = read_selection(*view);
  return file;
}

void write_gmm(const GmmFile& file, Output& out) {
  JsonWriter json;
  write_header(json, format, file.header);
  json.member("covariance_type", word(file.covariance_type)).member("priors", file.gmm.priors);
  json.key("means").matrix(file.gmm.means).key("covariances").begin_array();
  for (const Matrix& Sigma : file.gmm.covariances) json.matrix(Sigma);
  json.end_array().member("regularization", file.regularization);
  json.member("log_likelihood", file.log_likelihood).member("bic", file.bic).member("aic", file.aic);
  json.member("samples", file.samples).member("bic_n", file.bic_n).member("iterations", file.iterations);
  json.member("converged", file.converged);
  json.key("time_range").begin_array().number(file.time_range[0]).number(file.time_range[1]).end_array();
  json.member("start", file.start).member("goal", file.goal).key("selection").begin_array();
  for (const Selection& row : file.selection) {
    json.begin_object().member("k", row.k).member("log_likelihood", row.log_likelihood);
    json.member("bic", row.bic).member("aic", row.aic).end_object();
  }
  json.end_array();
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
