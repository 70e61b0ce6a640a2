#include "lfdtools/opponents.hpp"

#include <catch2/catch.hpp>

#include "judge_fixture.hpp"
#include "lfdtools/metrics.hpp"

using namespace lfd;

namespace {

const Vector phases = linspace(0, 1, phase_count);

}  // namespace

TEST_CASE("nearest target by dP, not by goal") {
  const auto training = small_training();
  Query query = small_query();
  query.goal = training[4].goal;
  query.start = training[4].goal - training[1].change();
  CHECK(nearest_target(all_of(training), query) == 1);
}

TEST_CASE("deviations of the nearest target and of all, averaged by hand") {
  const auto training = small_training();
  const Query query = small_query();
  const Samples line = straight_line(query.start, query.goal, phases);
  Samples all = Samples::Zero(phase_count, 3);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < training.size(); ++i) {
    const auto distance = [&](std::size_t t) { return (training[t].change() - query.change()).norm(); };
    if (distance(i) < distance(nearest)) nearest = i;
  }
  for (std::size_t i = 0; i < training.size(); ++i) {
    Samples own = Samples::Zero(phase_count, 3);
    for (const auto& e : training[i].examples) own += (e.path - straight_line(e.start, e.goal, phases)) / 3.0;
    all += own / 6.0;
    if (i == nearest) {
      const Predicted predicted = train_nearest_deviation(all_of(training), {})(query);
      CHECK((predicted.path - line - own).norm() < 1e-12);
      CHECK_FALSE(predicted.band);
    }
  }
  CHECK((train_mean_deviation(all_of(training), {})(query).path - line - all).norm() < 1e-12);
}

TEST_CASE("mean weights make the mean of the motions that each target's weights make: rollouts are linear in weights") {
  const auto training = small_training();
  const Query query = small_query();
  Samples mean = Samples::Zero(phase_count, 3);
  for (const auto& target : training) {
    for (const auto& example : target.examples) {
      Dmp dmp = example.primitive;
      dmp.start = query.start;
      dmp.goal = query.goal;
      mean += rollout(dmp, linspace(0, dmp.tau, phase_count)).positions / 18.0;
    }
  }
  CHECK(rms_distance(train_mean(all_of(training), {})(query).path, mean) < 1e-9);
}

TEST_CASE("the moved goal scales what a primitive adds to its spring by the change of each axis, eq. (12)") {
  const auto training = small_training();
  const Fold one = {&training[2]};
  Query query = small_query();
  query.start = training[2].start;
  query.goal = training[2].goal;
  const Samples same = train_moved_goal(one, {})(query).path;
  query.goal = query.start + 1.3 * (training[2].goal - query.start);
  const Samples further = train_moved_goal(one, {})(query).path;
  // Spring and forcing term both scale with g - y0, so the whole motion does.
  const Samples expected = (1.3 * (same.rowwise() - query.start.transpose())).rowwise() + query.start.transpose();
  CHECK(rms_distance(further, expected) < 1e-9);
}
