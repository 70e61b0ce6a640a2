#include "lfdtools/validation.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "lfdtools/error.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/synthesis.hpp"

using namespace lfd;

namespace {

Experiment small_experiment() {
  Experiment experiment;
  experiment.start = Vector::Zero(3);
  for (const double x : {0.2, 0.3, 0.4}) {
    for (const double y : {0.1, 0.25}) {
      Vector hole(3);
      hole << x, y, 0.3;
      experiment.holes.push_back({std::to_string(experiment.holes.size() + 1), hole});
    }
  }
  experiment.repetitions = 3;
  experiment.rate = 50;
  Bump bump;
  bump.constant = 0.05;
  experiment.bumps = {Bump{}, Bump{}, bump};
  return experiment;
}

std::vector<TargetDemonstrations> by_target(const DemonstrationSet& set) {
  std::vector<TargetDemonstrations> targets;
  for (const auto& demonstration : set.demonstrations) {
    if (targets.empty() || targets.back().labels.target != demonstration.labels.target) {
      targets.push_back({{demonstration.labels.target, {}, {}, {}}, {}});
    }
    targets.back().demonstrations.push_back(demonstration.trajectory);
  }
  return targets;
}

}  // namespace

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

TEST_CASE("scores of the line equal a computation by hand, for every target in order") {
  const auto targets = by_target(synthesize(small_experiment()));
  ValidationOptions options;
  options.methods = {"line"};
  const Validation validation = leave_one_target_out(targets, options);
  REQUIRE(validation.scores.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const Samples mean = mean_path(targets[i].demonstrations, 200);
    const Vector start = mean.row(0).transpose();
    const Vector goal = mean.row(199).transpose();
    const Samples line = straight_line(start, goal, linspace(0, 1, 200));
    CHECK(validation.scores[i].labels.target == targets[i].labels.target);
    CHECK(validation.scores[i].rmse == Approx(rms_distance(line, mean)).epsilon(1e-12));
    CHECK_FALSE(validation.scores[i].band95);
  }
}

TEST_CASE("nothing of the left-out target reaches its prediction: the query's ends alone count") {
  auto targets = by_target(synthesize(small_experiment()));
  ValidationOptions options;
  options.methods = {"skill", "affine", "nearest", "mean"};
  const auto before = leave_one_target_out(targets, options);
  // The middle of one target's demonstrations changes; its own predictions may not, so that its error grows by the
  // change alone, while predictions of the others do change.
  for (auto& demonstration : targets[2].demonstrations) {
    const Eigen::Index T = demonstration.samples();
    for (Eigen::Index k = 0; k < T; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(T - 1);
      demonstration.positions(k, 1) += 0.5 * s * s * (1 - s) * (1 - s) * 16;
    }
  }
  const auto after = leave_one_target_out(targets, options);
  for (std::size_t m = 0; m < 4; ++m) {
    CHECK(after.scores[2 * 4 + m].end_error == Approx(before.scores[2 * 4 + m].end_error).epsilon(1e-9));
    CHECK(after.scores[2 * 4 + m].rmse > 0.2);
  }
  CHECK(std::abs(after.scores[3 * 4].rmse - before.scores[3 * 4].rmse) > 1e-4);
}

TEST_CASE(
    "the skill beats the nearest target's weights where the intention is smooth, on both roads; jobs change nothing") {
  const auto targets = by_target(synthesize(small_experiment()));
  ValidationOptions options;
  options.methods = {"skill", "nearest"};
  options.preparation.k_to = 4;
  std::map<std::string, double> sum;
  const auto one = leave_one_target_out(targets, options);
  for (const auto& score : one.scores) sum[score.method] += score.rmse;
  CHECK(sum["skill"] < sum["nearest"]);
  options.jobs = 2;
  const auto two = leave_one_target_out(targets, options);
  for (std::size_t i = 0; i < one.scores.size(); ++i) CHECK(one.scores[i].rmse == two.scores[i].rmse);
  options.preparation.road = Road::references;
  options.methods = {"skill"};
  double references = 0;
  for (const auto& score : leave_one_target_out(targets, options).scores) {
    references += score.rmse;
    REQUIRE(score.band95);
    CHECK(score.band95->pointwise >= 0);
    CHECK(score.band95->pointwise <= 1);
  }
  CHECK(references < sum["nearest"]);
}

TEST_CASE("two targets or an unknown method are refused") {
  auto targets = by_target(synthesize(small_experiment()));
  ValidationOptions options;
  options.methods = {"oracle"};
  CHECK_THROWS_AS(leave_one_target_out(targets, options), UsageError);
  targets.resize(2);
  CHECK_THROWS_AS(leave_one_target_out(targets, ValidationOptions{}), DataError);
}
