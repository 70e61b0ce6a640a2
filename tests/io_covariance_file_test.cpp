// Covariance files: read as written, refused where they disagree with themselves.
#include <catch2/catch.hpp>
#include <limits>

#include "io_model_fixture.hpp"
#include "lfdtools/io/covariance_file.hpp"

using namespace lfd;

TEST_CASE("calibration multiplies what comes of the skill, not what comes of the goal") {
  CovarianceFile file;
  file.times = (Vector(2) << 0, 1).finished();
  const Matrix own = (Matrix(4, 4) << 4, 1, 0, 0, 1, 5, 0, 0, 0, 0, 2, 1, 0, 0, 1, 3).finished();
  file.covariance = {own.topLeftCorner(2, 2), own.bottomRightCorner(2, 2)};
  CHECK(calibrated(file) == file.covariance);
  file.calibration = (Vector(2) << 4, 9).finished();
  CHECK(calibrated(file)[0] == 4 * file.covariance[0]);
  CHECK(calibrated(file)[1] == 9 * file.covariance[1]);
  // The same with all signals in one matrix, and a goal that is off by F.
  Matrix expected = own;
  expected.topLeftCorner(2, 2) *= 4;
  expected.bottomRightCorner(2, 2) *= 9;
  file.covariance = {own};
  CHECK(calibrated(file)[0].isApprox(expected, 1e-15));
  file.goal_factor = (Matrix(4, 2) << 0.1, 0, 1, 0.2, 0, 0.3, 0.4, 2).finished();
  file.covariance[0] += file.goal_factor * file.goal_factor.transpose();
  CHECK(calibrated(file)[0].isApprox(expected + file.goal_factor * file.goal_factor.transpose(), 1e-14));
}

TEST_CASE("a covariance is read as it was written, one matrix a signal or one of all") {
  CovarianceFile file;
  file.header.columns = {"x", "y"};
  file.header.labels.target = "3";
  file.spread = Spread::predictive;
  file.degrees_of_freedom = (Vector(2) << 7.5, std::numeric_limits<double>::infinity()).finished();
  file.times = (Vector(3) << 0, 0.5, 1).finished();
  file.mean = (Samples(3, 2) << 1, 2, 3, 4, 5, 6).finished();
  const Matrix A = (Matrix(3, 3) << 4, 1, 0, 1, 5, 2, 0, 2, 6).finished();
  for (const bool together : {false, true}) {
    file.covariance = {A, 2 * A};
    file.goal_factor.resize(0, 0);
    if (together) {
      file.covariance = {Matrix::Identity(6, 6)};
      file.goal_factor = Matrix::Constant(6, 2, 0.1);
    }
    const std::string text = text_of(file, write_covariance);
    const CovarianceFile back = read_covariance(document(text));
    REQUIRE(text_of(back, write_covariance) == text);
    REQUIRE(back.covariance == file.covariance);
    REQUIRE(back.mean == file.mean);
    REQUIRE(back.goal_factor == file.goal_factor);
    if (together) {
      require_refused(changed(text, "[0.1,0.1],", ""), read_covariance, "json.wrong_length", "/goal_factor");
      require_refused(changed(text, "[0.1,0.1],", "[0.8,0.7],"), read_covariance, "covariance.goal_factor",
                      "/goal_factor/0");
    } else {
      require_refused(changed(text, "\"t\":", "\"goal_factor\":[[1,1]],\"t\":"), read_covariance,
                      "covariance.goal_factor", "/goal_factor");
    }
    require_refused(changed(text, "\"t\":[0,0.5,1]", "\"t\":[0,0.5,0.5]"), read_covariance,
                    "covariance.time_not_rising", "/t/2");
    require_refused(changed(text, "\"t\":[0,0.5,1]", "\"t\":[0,0.5]"), read_covariance, "json.wrong_length", "/mean");
    require_refused(changed(text, "predictive", "wide"), read_covariance, "covariance.spread", "/spread");
    require_refused(changed(text, "[7.5,null]", "[7.5]"), read_covariance, "json.wrong_length", "/degrees_of_freedom");
  }
  file.covariance = {A, Matrix::Identity(2, 2)};
  require_refused(text_of(file, write_covariance), read_covariance, "json.wrong_length", "/covariance/1");
  file.covariance = {A, A};
  file.covariance[1](2, 0) += 1e-7;
  require_refused(text_of(file, write_covariance), read_covariance, "covariance.not_symmetric", "/covariance/1/2/0");
  file.covariance[1] = A - 10 * Matrix::Identity(3, 3);
  require_refused(text_of(file, write_covariance), read_covariance, "covariance.not_positive", "/covariance/1");
}
