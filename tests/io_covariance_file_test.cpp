// Covariance files: read as written, refused where they disagree with themselves.
#include <catch2/catch.hpp>
#include <limits>

#include "io_model_fixture.hpp"
#include "lfdtools/io/covariance_file.hpp"

using namespace lfd;

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
    if (together) file.covariance = {Matrix::Identity(6, 6)};
    const std::string text = text_of(file, write_covariance);
    const CovarianceFile back = read_covariance(document(text));
    REQUIRE(text_of(back, write_covariance) == text);
    REQUIRE(back.covariance == file.covariance);
    REQUIRE(back.mean == file.mean);
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
