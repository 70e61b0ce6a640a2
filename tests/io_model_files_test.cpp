// Files of mixtures, primitives and experiments: read as written, refused with their place.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "io_model_fixture.hpp"
#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/experiment_file.hpp"
#include "lfdtools/io/gmm_file.hpp"

using namespace lfd;

namespace {

/// A file whose parts can all be told apart in its text.
GmmFile small_gmm() {
  GmmFile file;
  file.header.columns = {"t", "x"};
  file.header.labels.target = "3";
  file.header.labels.teacher = "ann";
  file.header.provenance = {{"gmm-fit", "0.1.0", {"-k", "2"}, 1, std::string(64, 'f')}};
  file.gmm.priors = (Vector(2) << 0.25, 0.75).finished();
  file.gmm.means = (Samples(2, 2) << 0.5, 1, 1.5, 2).finished();
  file.gmm.covariances = {(Matrix(2, 2) << 4, 1.25, 1.25, 2).finished(), (Matrix(2, 2) << 3, 0, 0, 6).finished()};
  file.regularization = (Vector(2) << 1e-9, 2e-9).finished();
  file.log_likelihood = -180.1;
  file.bic = 391;
  file.aic = 380;
  file.icl = 395;
  file.entropy = 2;
  file.parameters = 11;
  file.criterion = Criterion::icl;
  file.likelihood = Likelihood::effective;
  file.samples = 150;
  file.bic_n = 149.5;
  file.iterations = 12;
  file.converged = true;
  file.time_range = {0, 2};
  file.start = Vector::Constant(1, 0.1);
  file.goal = Vector::Constant(1, 0.9);
  file.selection = {{1, -200, 410, 405, 410.5, 5, 0}, {2, -180.1, 391, 380, 395, 11, 2}};
  return file;
}

std::string gmm_text() {
  return text_of(small_gmm(), write_gmm);
}

Dmp small_dmp() {
  Dmp dmp;
  dmp.settings = make_dmp_settings(3);
  dmp.tau = 2.5;
  dmp.start = (Vector(2) << 0, 1).finished();
  dmp.goal = (Vector(2) << 2, 3).finished();
  dmp.weights = (Matrix(2, 3) << 1, 2, 3, 4, 5, 6).finished();
  dmp.rmse = (Vector(2) << 0.001, 0.002).finished();
  dmp.fit = DmpFitMethod::ls;
  return dmp;
}

std::string dmp_text() {
  DmpFile file;
  file.header.columns = {"x", "y"};
  file.header.labels.target = "3";
  file.header.labels.demo = "1";
  file.dmp = small_dmp();
  return text_of(file, write_dmp);
}

}  // namespace

TEST_CASE("a mixture is read as it was written, byte for byte when written again") {
  const GmmFile file = small_gmm();
  const std::string text = gmm_text();
  REQUIRE(text.back() == '\n');
  REQUIRE(std::count(text.begin(), text.end(), '\n') == 1);
  const GmmFile back = read_gmm(document(text));
  REQUIRE(text_of(back, write_gmm) == text);
  REQUIRE(back.header.columns == file.header.columns);
  REQUIRE(back.header.labels == file.header.labels);
  REQUIRE(back.header.provenance == file.header.provenance);
  REQUIRE(back.gmm.priors == file.gmm.priors);
  REQUIRE(back.gmm.means == file.gmm.means);
  REQUIRE(back.gmm.covariances == file.gmm.covariances);
  REQUIRE(back.regularization == file.regularization);
  REQUIRE(back.bic_n == file.bic_n);
  REQUIRE(back.samples == 150);
  REQUIRE(back.converged);
  REQUIRE(back.time_range == file.time_range);
  REQUIRE(back.start == file.start);
  REQUIRE(back.goal == file.goal);
  REQUIRE(back.selection.size() == 2);
  REQUIRE(back.selection[1].log_likelihood == -180.1);
  REQUIRE(back.selection[1].icl == 395);
  REQUIRE(back.selection[1].parameters == 11);
  REQUIRE(back.selection[1].entropy == 2);
  REQUIRE(back.criterion == Criterion::icl);
  REQUIRE(back.likelihood == Likelihood::effective);
  REQUIRE(back.icl == 395);
  REQUIRE(back.parameters == 11);
}

TEST_CASE("each covariance type is written and read, and its covariances must be of it") {
  GmmFile file = small_gmm();
  const std::pair<CovarianceType, std::string> types[] = {{CovarianceType::full, "full"},
                                                          {CovarianceType::tied, "tied"},
                                                          {CovarianceType::diagonal, "diagonal"},
                                                          {CovarianceType::spherical, "spherical"}};
  for (const auto& [type, word] : types) {
    file.covariance_type = type;
    const std::string text = text_of(file, write_gmm);
    REQUIRE(text.find("\"covariance_type\":\"" + word + "\"") != std::string::npos);
    if (type != CovarianceType::full) {
      require_refused(text, read_gmm, "gmm.covariance_type",
                      type == CovarianceType::tied ? "/covariances/1" : "/covariances/0");
    }
  }
  file.gmm.covariances[0] = file.gmm.covariances[1];
  for (const auto& [type, word] : types) {
    file.covariance_type = type;
    REQUIRE(read_gmm(document(text_of(file, write_gmm))).covariance_type == type);
  }
}

TEST_CASE("a mixture by hand needs only what regression uses") {
  const GmmFile file = read_gmm(document(R"({"format":"lfdtools.gmm","version":1,"columns":["t","x"],"priors":[1],
    "means":[[0,0]],"covariances":[[[1,0],[0,1]]],"time_range":[0,1],"start":[0],"goal":[1]})"));
  REQUIRE(file.gmm.components() == 1);
}

TEST_CASE("a mixture that disagrees with itself is refused") {
  const std::string text = gmm_text();
  const auto refused = [&](const char* from, const char* to, const char* id, const char* pointer) {
    require_refused(changed(text, from, to), read_gmm, id, pointer);
  };
  refused("\"priors\":[0.25,0.75]", "\"priors\":[-0.25,1.25]", "gmm.priors", "/priors/0");
  refused("\"priors\":[0.25,0.75]", "\"priors\":[0.25,0.750000002]", "gmm.priors", "/priors");
  refused("\"priors\":[0.25,0.75]", "\"priors\":[0.25,null]", "json.not_a_number", "/priors/1");
  refused("\"priors\":[0.25,0.75]", "\"priors\":[]", "json.out_of_range", "/priors");
  refused("\"priors\":[0.25,0.75]", "\"priors\":[0.25,0.25,0.5]", "json.wrong_length", "/means");
  refused("\"means\":[[0.5,1],[1.5,2]]", "\"means\":[[0.5,1],[1.5]]", "json.wrong_length", "/means/1");
  refused("\"means\":[[0.5,1],[1.5,2]]", "\"means\":[[0.5,1],[1.5,\"2\"]]", "json.not_a_number", "/means/1/1");
  refused("[[4,1.25],[1.25,2]]", "[[4,1.25],[1.25,2,0]]", "json.wrong_length", "/covariances/0/1");
  refused("[[4,1.25],[1.25,2]]", "[[4,1.25],[1.2500001,2]]", "gmm.not_symmetric", "/covariances/0/1/0");
  refused("[[3,0],[0,6]]", "[[3,5],[5,6]]", "gmm.not_positive_definite", "/covariances/1");
  refused("[[3,0],[0,6]]", "[[3,0],[0,0]]", "gmm.not_positive_definite", "/covariances/1");
  refused("[[3,0],[0,6]]", "[[-3,0],[0,6]]", "gmm.not_positive_definite", "/covariances/1");
  refused(",[[3,0],[0,6]]", "", "json.wrong_length", "/covariances");
  refused("[\"t\",\"x\"]", "[\"x\",\"t\"]", "json.out_of_range", "/columns/0");
  refused("[\"t\",\"x\"]", "[\"t\",\"x\",\"y\"]", "json.wrong_length", "/means/0");
  refused("\"time_range\":[0,2]", "\"time_range\":[2,2]", "json.out_of_range", "/time_range");
  refused("\"start\":[0.1]", "\"start\":[0.1,0]", "json.wrong_length", "/start");
  refused("\"start\":[0.1],", "", "json.missing_key", "");
  refused("\"samples\":150", "\"samples\":-1", "json.out_of_range", "/samples");
  refused("\"samples\":150", "\"samples\":4.7", "json.not_an_integer", "/samples");
  refused("\"k\":1,", "\"k\":1000000000,", "json.out_of_range", "/selection/0/k");
  refused("\"k\":1,", "\"k\":5e9,", "json.not_an_integer", "/selection/0/k");
  refused("\"k\":1,", "\"k\":true,", "json.not_an_integer", "/selection/0/k");
  refused("\"version\":1", "\"version\":2", "json.newer_version", "/version");
  refused("lfdtools.gmm", "lfdtools.dmp", "json.wrong_format", "/format");
  refused("\"full\"", "\"round\"", "json.out_of_range", "/covariance_type");
  refused("\"full\"", "null", "json.wrong_type", "/covariance_type");
  refused("\"criterion\":\"icl\"", "\"criterion\":\"mdl\"", "json.out_of_range", "/criterion");
  refused("\"effective\"", "\"some\"", "json.out_of_range", "/bic_likelihood");
  refused("\"parameters\":5", "\"parameters\":-5", "json.out_of_range", "/selection/0/parameters");
  refused("\"bic_n\"", "\"bic_m\"", "json.unknown_key", "/bic_m");
}

TEST_CASE("what the writer cannot say is a defect, not a null") {
  GmmFile file = small_gmm();
  file.bic = std::nan("");
  Output out("/dev/null");
  REQUIRE(refusal_of([&] { write_gmm(file, out); }).id == "json.write_not_finite");
}

TEST_CASE("a primitive is read as it was written, with and without the covariance of its weights") {
  DmpFile file;
  file.header.columns = {"x", "y"};
  file.dmp = small_dmp();
  for (const bool with_covariance : {false, true}) {
    if (with_covariance) {
      // A rank that is not full, and zero, are both covariances.
      const Vector v = (Vector(3) << 1, 0.1, -0.3).finished();
      file.dmp.weights_covariance = {v * v.transpose(), Matrix::Zero(3, 3)};
    }
    const std::string text = text_of(file, write_dmp);
    const DmpFile back = read_dmp(document(text));
    REQUIRE(text_of(back, write_dmp) == text);
    REQUIRE(back.dmp.settings == file.dmp.settings);
    REQUIRE(back.dmp.weights == file.dmp.weights);
    REQUIRE(back.dmp.tau == 2.5);
    REQUIRE(back.dmp.start == file.dmp.start);
    REQUIRE(back.dmp.goal == file.dmp.goal);
    REQUIRE(back.dmp.rmse == file.dmp.rmse);
    REQUIRE(back.dmp.fit == DmpFitMethod::ls);
    REQUIRE(back.dmp.weights_covariance == file.dmp.weights_covariance);
  }
}

TEST_CASE("a primitive that disagrees with itself is refused") {
  const std::string text = dmp_text();
  const auto refused = [&](const char* from, const char* to, const char* id, const char* pointer) {
    require_refused(changed(text, from, to), read_dmp, id, pointer);
  };
  refused("\"scaling\":\"none\"", "\"scaling\":\"some\"", "json.out_of_range", "/scaling");
  refused("\"fit\":\"ls\"", "\"fit\":\"LS\"", "json.out_of_range", "/fit");
  refused("\"tau\":2.5", "\"tau\":0", "json.out_of_range", "/tau");
  refused("\"tau\":2.5", "\"tau\":\"2.5\"", "json.not_a_number", "/tau");
  refused("\"alpha_z\":25", "\"alpha_z\":-25", "json.out_of_range", "/alpha_z");
  refused("[[1,2,3],[4,5,6]]", "[[1,2,3],[4,5]]", "json.wrong_length", "/weights/1");
  refused("[[1,2,3],[4,5,6]]", "[[1,2,3]]", "json.wrong_length", "/weights");
  refused("\"goal\":[2,3]", "\"goal\":[2,3,4]", "json.wrong_length", "/goal");
  refused("\"rmse\":[0.001,0.002]", "\"rmse\":[0.001,-0.002]", "json.out_of_range", "/rmse/1");
  refused("\"fit\":\"ls\"", "\"fit\":\"ls\",\"weights_covariance\":[[[1,0,0],[0,1,0],[0,0,1]]]", "json.wrong_length",
          "/weights_covariance");
  const std::string identity = "[[1,0,0],[0,1,0],[0,0,1]]";
  const auto covariance = [&](const std::string& second, const char* id, const char* pointer) {
    require_refused(
        changed(text, "\"fit\":\"ls\"", "\"fit\":\"ls\",\"weights_covariance\":[" + identity + "," + second + "]"),
        read_dmp, id, pointer);
  };
  covariance("[[1,2,0],[2,1,0],[0,0,1]]", "dmp.not_positive_definite", "/weights_covariance/1");
  covariance("[[1,0.5,0],[0.4,1,0],[0,0,1]]", "dmp.not_symmetric", "/weights_covariance/1/1/0");
  covariance("[[1,0,0],[0,1,0]]", "json.wrong_length", "/weights_covariance/1");
}

TEST_CASE("an experiment states everything, and is read as it was written") {
  Experiment experiment;
  experiment.name = "B";
  experiment.start = (Vector(3) << 0.4, -0.3, 0.5).finished();
  experiment.holes = {{"1", (Vector(3) << 0.5, 0.1, 0.1).finished()},
                      {"left", (Vector(3) << 0.6, 0.2, 0.1).finished()}};
  experiment.new_holes = {{"n1", (Vector(3) << 0.55, 0.15, 0.1).finished()}};
  experiment.repetitions = 7;
  experiment.seed = 18446744073709551615ULL;
  experiment.noise.tempo_sd = 0.04;
  experiment.origin = (Vector(3) << 0.5, 0, 0.1).finished();
  experiment.bumps.resize(3);
  experiment.bumps[0].constant = 0.02;
  experiment.bumps[1].linear = (Vector(3) << 0.1, 0, 0).finished();
  experiment.bumps[1].quadratic = Matrix::Identity(3, 3);
  experiment.bumps[2].exponent = 1.5;
  experiment.bumps[2].sines = {{0.05, (Vector(3) << 8, 0, 0).finished(), 0.3}};
  experiment.bumps[2].gaussians = {{0.04, (Vector(3) << 0.5, 0.1, 0).finished(), 0.2}};
  experiment.approach = {(Vector(3) << 0, 0, 0.05).finished(), 3};
  experiment.obstacle = Obstacle{};
  experiment.obstacle->center = (Vector(3) << 0.5, -0.1, 0.3).finished();
  experiment.obstacle->ways = {(Vector(3) << 0, 0, 1).finished()};
  const std::string text = text_of(experiment, write_experiment);
  const Experiment back = read_experiment(document(text));
  REQUIRE(text_of(back, write_experiment) == text);
  REQUIRE(back.seed == experiment.seed);
  REQUIRE(back.holes[1].target == "left");
  REQUIRE(back.bumps[1].quadratic == Matrix::Identity(3, 3));
  REQUIRE(back.bumps[2].sines[0].phase == 0.3);
  REQUIRE(back.obstacle->ways == experiment.obstacle->ways);
  REQUIRE(back.noise.wander_sd == experiment.noise.wander_sd);
  REQUIRE(back.bumps[0].linear.size() == 0);

  const auto refused = [&](const char* from, const char* to, const char* id, const char* pointer) {
    require_refused(changed(text, from, to), read_experiment, id, pointer);
  };
  refused("\"repetitions\":7", "\"repetitions\":0", "json.out_of_range", "/repetitions");
  refused("\"repetitions\":7", "\"repetitions\":2.5", "json.not_an_integer", "/repetitions");
  refused("\"start\":[0.4,-0.3,0.5]", "\"start\":[0.4,-0.3]", "json.wrong_length", "/start");
  refused("\"target\":\"left\"", "\"target\":1.5", "json.wrong_type", "/holes/1/target");
  refused("\"target\":\"left\"", "\"target\":1", "synthesis.repeated_target", "");
  refused("\"tempo_sd\"", "\"tempo\"", "json.unknown_key", "/noise/tempo");
}
