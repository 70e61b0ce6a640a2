#include "lfdtools/fold.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "judge_fixture.hpp"
#include "lfdtools/metrics.hpp"

using namespace lfd;

TEST_CASE("the straight line is minimum jerk between its ends") {
  Vector start(1);
  Vector goal(1);
  start << 1;
  goal << 3;
  Vector phases(3);
  phases << 0, 0.5, 1;
  const Samples line = straight_line(start, goal, phases);
  CHECK(line(0, 0) == 1);
  CHECK(line(1, 0) == Approx(2));
  CHECK(line(2, 0) == 3);
}

TEST_CASE("rows of recordings keep their own time, and their path is the recording's at equal phases") {
  const auto targets = small_targets();
  const auto training = small_training();
  REQUIRE(training[1].examples.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const Trajectory& recording = targets[1].demonstrations[k];
    const Example& example = training[1].examples[k];
    CHECK(example.start == recording.start());
    CHECK(example.goal == recording.goal());
    CHECK(example.path == at_phases(recording, phase_count));
    CHECK(example.primitive.tau == Approx(recording.duration()).epsilon(1e-12));
    CHECK(example.deviation().row(0).norm() < 1e-15);
  }
}

TEST_CASE("roads differ in their rows: three recordings, three aligned, one reference") {
  PreparationOptions options;
  options.k_to = 4;
  options.road = Road::demonstrations;
  const auto aligned = small_training(options);
  CHECK(aligned[0].examples.size() == 3);
  CHECK(aligned[0].examples[0].primitive.tau == Approx(aligned[0].examples[1].primitive.tau));
  options.road = Road::references;
  CHECK(small_training(options)[0].examples.size() == 1);
}

TEST_CASE("the noise floor is the standard error of the mean path") {
  const auto targets = small_targets();
  const auto& recordings = targets[0].demonstrations;
  const JudgedTarget judged = judged_target(targets[0].labels, recordings);
  double squares = 0;
  for (Eigen::Index k = 0; k < phase_count; ++k) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      double sum = 0;
      double sum_of_squares = 0;
      for (const auto& recording : recordings) {
        const double y = at_phases(recording, phase_count)(k, j);
        sum += y;
        sum_of_squares += y * y;
      }
      squares += (sum_of_squares - sum * sum / 3) / 2;
    }
  }
  REQUIRE(judged.noise_floor);
  CHECK(*judged.noise_floor == Approx(std::sqrt(squares / phase_count / 3)).epsilon(1e-6));
  CHECK_FALSE(judged_target({}, {recordings[0]}).noise_floor);
}

TEST_CASE("repetitions are drawn by the seed, without repeats, in their order") {
  PreparationOptions options;
  options.repetitions = 2;
  const auto some = small_training(options);
  const auto again = small_training(options);
  const auto all = small_training();
  bool differs = false;
  for (std::size_t i = 0; i < some.size(); ++i) {
    REQUIRE(some[i].examples.size() == 2);
    std::vector<std::size_t> found;
    for (const auto& example : some[i].examples) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (all[i].examples[k].path == example.path) found.push_back(k);
      }
    }
    REQUIRE(found.size() == 2);
    CHECK(found[0] < found[1]);
    CHECK(some[i].examples[0].path == again[i].examples[0].path);
    differs = differs || found[0] != 0 || found[1] != 1;
  }
  CHECK(differs);
  options.repetitions = 7;
  CHECK(small_training(options)[0].examples.size() == 3);
}
