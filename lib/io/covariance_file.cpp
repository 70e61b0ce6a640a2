#include "lfdtools/io/covariance_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"
#include "lfdtools/io/json_writer.hpp"
#include "lfdtools/semidefinite.hpp"

namespace lfd {
namespace {

Matrix read_symmetric(const JsonView& view, Eigen::Index rows) {
  const Matrix A = view.matrix(rows, rows);
  if (rows == 0) return A;
  Eigen::Index i = 0, j = 0;
  const double off = (A - A.transpose()).cwiseAbs().maxCoeff(&i, &j);
  if (off > 1e-9 * A.cwiseAbs().maxCoeff()) {
    view.at(static_cast<std::size_t>(i))
        .at(static_cast<std::size_t>(j))
        .fail("covariance.not_symmetric",
              fmt::format("the covariance is not symmetric: {} here, {} across the diagonal", A(i, j), A(j, i)));
  }
  Matrix L;
  if (!try_thin_cholesky(A, L)) view.fail("covariance.not_positive", "the covariance is not positive semidefinite");
  return A;
}

}  // namespace

CovarianceFile read_covariance(const JsonDocument& document) {
  CovarianceFile file;
  file.header = read_header(document, "lfdtools.covariance");
  const JsonView root = document.root();
  root.only({"format", "version", "columns", "target", "demo", "teacher", "spread", "degrees_of_freedom", "calibration",
             "t", "mean", "covariance", "goal_factor", "provenance"});
  const std::string spread = root.at("spread").string();
  if (spread != "latent" && spread != "predictive") {
    root.at("spread").fail("covariance.spread", "the spread is latent or predictive");
  }
  file.spread = spread == "latent" ? Spread::latent : Spread::predictive;
  const auto D = static_cast<Eigen::Index>(file.header.columns.size());
  const JsonView freedom = root.at("degrees_of_freedom");
  file.degrees_of_freedom = Vector::Constant(D, std::numeric_limits<double>::infinity());
  if (freedom.size() != file.header.columns.size()) freedom.fail("json.wrong_length", "there must be one a column");
  for (Eigen::Index a = 0; a < D; ++a) {
    const JsonView value = freedom.at(static_cast<std::size_t>(a));
    if (!value.is_null()) file.degrees_of_freedom[a] = value.positive();
  }
  if (const auto calibration = root.find("calibration")) {
    file.calibration = calibration->vector(D);
    for (std::size_t a = 0; a < calibration->size(); ++a) (void)calibration->at(a).positive();
  }
  file.times = root.at("t").vector();
  const Eigen::Index T = file.times.size();
  for (Eigen::Index k = 1; k < T; ++k) {
    if (!(file.times[k] > file.times[k - 1])) {
      root.at("t").at(static_cast<std::size_t>(k)).fail("covariance.time_not_rising", "the times do not rise");
    }
  }
  file.mean = root.at("mean").matrix(T, D);
  const JsonView covariance = root.at("covariance");
  if (covariance.size() > 0 && covariance.at(0).size() > 0 && covariance.at(0).at(0).is_array()) {
    if (covariance.size() != file.header.columns.size()) {
      covariance.fail("json.wrong_length", "there must be one matrix a column");
    }
    for (std::size_t a = 0; a < covariance.size(); ++a) file.covariance.push_back(read_symmetric(covariance.at(a), T));
  } else {
    file.covariance.push_back(read_symmetric(covariance, D * T));
  }
  if (const auto goal = root.find("goal_factor")) {
    if (file.covariance.size() > 1) goal->fail("covariance.goal_factor", "a goal moves all signals at once");
    file.goal_factor = goal->matrix(D * T, D);
    const Vector own = file.covariance.front().diagonal(), of_goal = file.goal_factor.rowwise().squaredNorm();
    for (Eigen::Index i = 0; i < D * T; ++i) {
      if (of_goal[i] <= (1 + 1e-9) * own[i] + 1e-9 * own.maxCoeff()) continue;
      goal->at(static_cast<std::size_t>(i))
          .fail("covariance.goal_factor",
                fmt::format("a variance of {:.3g} by the goal, of {:.3g} in all", of_goal[i], own[i]));
    }
  }
  return file;
}

std::vector<Matrix> calibrated(const CovarianceFile& file) {
  std::vector<Matrix> scaled = file.covariance;
  if (file.calibration.size() == 0) return scaled;
  const Eigen::Index T = file.times.size();
  if (scaled.size() > 1) {
    for (std::size_t a = 0; a < scaled.size(); ++a) scaled[a] *= file.calibration[static_cast<Eigen::Index>(a)];
    return scaled;
  }
  const bool goal = file.goal_factor.size() > 0;
  const Vector roots = file.calibration.cwiseSqrt();
  if (goal) scaled.front() -= file.goal_factor * file.goal_factor.transpose();
  for (Eigen::Index a = 0; a < roots.size(); ++a) {
    for (Eigen::Index b = 0; b < roots.size(); ++b) scaled.front().block(a * T, b * T, T, T) *= roots[a] * roots[b];
  }
  if (goal) scaled.front() += file.goal_factor * file.goal_factor.transpose();
  return scaled;
}

void write_covariance(const CovarianceFile& file, Output& out) {
  double numbers = 0;
  for (const Matrix& part : file.covariance) numbers += static_cast<double>(part.size());
  if (numbers > 2e7) {
    throw DataError("covariance.too_large",
                    fmt::format("the covariance of a motion of {} samples has {:.3g} numbers, over 2e7: take a larger "
                                "time step",
                                file.times.size(), numbers));
  }
  JsonWriter json;
  write_header(json, "lfdtools.covariance", file.header);
  json.member("spread", file.spread == Spread::latent ? "latent" : "predictive");
  json.key("degrees_of_freedom").begin_array();
  for (const double nu : file.degrees_of_freedom) std::isfinite(nu) ? json.number(nu) : json.null();
  json.end_array();
  if (file.calibration.size() > 0) json.member("calibration", file.calibration);
  json.member("t", file.times).key("mean").matrix(file.mean).key("covariance");
  if (file.covariance.size() == 1 && file.header.columns.size() > 1) {
    json.matrix(file.covariance.front());
  } else {
    json.begin_array();
    for (const Matrix& part : file.covariance) json.matrix(part);
    json.end_array();
  }
  if (file.goal_factor.size() > 0) json.key("goal_factor").matrix(file.goal_factor);
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
