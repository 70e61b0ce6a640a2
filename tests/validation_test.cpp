#include "lfdtools/validation.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "judge_fixture.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/methods.hpp"
#include "lfdtools/metrics.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

constexpr std::size_t method_count = 20;

/// Every method, with few components so that it is quick.
ValidationOptions every_method() {
  ValidationOptions options;
  options.preparation.k_to = 3;
  return options;
}

std::string id_of(const std::vector<TargetDemonstrations>& targets, const ValidationOptions& options) {
  return refusal_of([&] { (void)leave_one_target_out(targets, options); }).id;
}

}  // namespace

TEST_CASE("scores of the line equal a computation by hand, for every target in order") {
  const auto targets = small_targets();
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

TEST_CASE("a method by two names is computed once and reported under both") {
  ValidationOptions options;
  options.methods = {"skill-full", "line", "skill"};
  const Validation validation = leave_one_target_out(small_targets(), options);
  REQUIRE(validation.scores.size() == 18);
  for (std::size_t i = 0; i < validation.scores.size(); i += 3) {
    CHECK(validation.scores[i].method == "skill-full");
    CHECK(validation.scores[i + 2].method == "skill");
    CHECK(validation.scores[i].rmse == validation.scores[i + 2].rmse);
    CHECK(validation.scores[i + 1].rmse != validation.scores[i + 2].rmse);
  }
  CHECK(validation.times[0].seconds == validation.times[2].seconds);  // to the last digit: the same run
}

TEST_CASE("nothing of the left-out target but its ends reaches any method") {
  auto targets = small_targets();
  const auto before = leave_one_target_out(targets, every_method());
  REQUIRE(before.scores.size() == 6 * method_count);
  // The third target's demonstrations turn about the line between their ends, and so does its mean path. Predictions
  // that stay leave a known error: |p - m'|^2 = |p - m|^2 + 2 (p - m).(m - m') + |m - m'|^2 cannot tell, so the change
  // is made in a signal of its own.
  for (auto& target : targets) {
    for (auto& demonstration : target.demonstrations) {
      demonstration.positions.conservativeResize(demonstration.samples(), 4);
      demonstration.positions.col(3).setConstant(0.5);
    }
  }
  const auto flat = leave_one_target_out(targets, every_method());
  for (auto& demonstration : targets[2].demonstrations) {
    for (Eigen::Index k = 0; k < demonstration.samples(); ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(demonstration.samples() - 1);
      demonstration.positions(k, 3) += 3.2 * s * s * (1 - s) * (1 - s);
    }
  }
  const auto bent = leave_one_target_out(targets, every_method());
  const Samples path = mean_path(targets[2].demonstrations, phase_count);
  const double change = std::sqrt((path.col(3).array() - 0.5).square().mean());
  for (std::size_t m = 0; m < method_count; ++m) {
    const ValidationScore& score = bent.scores[2 * method_count + m];
    CAPTURE(score.method);
    // The prediction stays at 0.5 in the new signal and as it was in the others.
    CHECK(score.rmse == Approx(std::hypot(flat.scores[2 * method_count + m].rmse, change)).epsilon(1e-6));
    CHECK(score.end_error == Approx(flat.scores[2 * method_count + m].end_error).margin(1e-9));
  }
  // While the others, who learn from it, do change.
  CHECK(std::abs(bent.scores[3 * method_count].rmse - flat.scores[3 * method_count].rmse) > 1e-4);
}

TEST_CASE("the skill beats the nearest target's weights where the intention is smooth, on all roads, with any jobs") {
  const auto targets = small_targets();
  ValidationOptions options;
  options.methods = {"skill", "nearest"};
  options.preparation.k_to = 4;
  for (const Road road : {Road::recordings, Road::demonstrations, Road::references}) {
    options.preparation.road = road;
    options.jobs = 1;
    std::map<std::string, double> sum;
    const auto one = leave_one_target_out(targets, options);
    for (const auto& score : one.scores) sum[score.method] += score.rmse;
    CHECK(sum["skill"] < sum["nearest"]);
    options.jobs = 2;
    const auto two = leave_one_target_out(targets, options);
    for (std::size_t i = 0; i < one.scores.size(); ++i) CHECK(one.scores[i].rmse == two.scores[i].rmse);
  }
}

TEST_CASE("targets of one fold are left out together and scored as alone where nothing is learnt") {
  const auto targets = small_targets();
  ValidationOptions options;
  options.methods = {"line", "mean-deviation"};
  const auto alone = leave_one_target_out(targets, options);
  options.folds = {4, 7, 4, 7, 9, 9};
  const auto together = leave_one_target_out(targets, options);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(together.scores[2 * i].labels == targets[i].labels);
    CHECK(together.scores[2 * i].rmse == alone.scores[2 * i].rmse);
  }
  // The mean of the four others, for target 0.
  Samples mean = Samples::Zero(phase_count, 3);
  for (const std::size_t i : {1, 3, 4, 5}) {
    for (const auto& d : judged_target({}, targets[i].demonstrations).deviations) mean += d / 12.0;
  }
  const JudgedTarget judged = judged_target({}, targets[0].demonstrations);
  const Samples path = straight_line(judged.query.start, judged.query.goal, linspace(0, 1, phase_count)) + mean;
  CHECK(together.scores[1].rmse == Approx(rms_distance(path, judged.mean_path)).epsilon(1e-9));
  options.folds = {1, 1, 1, 1, 1, 2};
  CHECK(id_of(targets, options) == "validation.too_few_targets");
}

TEST_CASE("on test targets methods are judged as on a fold of the same targets left out") {
  const auto targets = small_targets();
  ValidationOptions options;
  options.methods = {"skill", "nearest", "affine-prior"};
  const auto tested =
      judge_on_test_targets({targets.begin(), targets.begin() + 4}, {targets.begin() + 4, targets.end()}, options);
  REQUIRE(tested.scores.size() == 6);
  REQUIRE(tested.noise_floor.size() == 2);
  options.folds = {1, 2, 3, 4, 5, 5};
  const auto folds = leave_one_target_out(targets, options);
  for (std::size_t i = 0; i < 6; ++i) {
    const ValidationScore& one = tested.scores[i];
    const ValidationScore& other = folds.scores[12 + i];
    CHECK(one.labels == other.labels);
    CHECK(one.method == other.method);
    CHECK(one.rmse == other.rmse);
    CHECK(one.outside == other.outside);
    CHECK(one.band95.has_value() == other.band95.has_value());
    if (one.band95) CHECK(one.band95->width == other.band95->width);
  }
  CHECK(tested.noise_floor[0] == folds.noise_floor[4]);
}

TEST_CASE("bands narrow from one demonstration to the mean of three to the intention itself") {
  const Experiment experiment = small_experiment();
  const auto targets = small_targets();
  ValidationOptions options;
  options.methods = {"skill", "gpr"};
  const Labels labels{"new", {}, {}, {}};
  const Vector hole = small_query().goal;
  const Trajectory path{linspace(0, 3, phase_count), intention(experiment, hole, linspace(0, 1, phase_count))};
  const auto widths = [&](std::size_t demonstrations, bool noise_free) {
    const TargetDemonstrations test{labels, std::vector<Trajectory>(demonstrations, path), noise_free};
    const auto validation = judge_on_test_targets(targets, {test}, options);
    CHECK(validation.noise_floor[0].has_value() == (demonstrations > 1));
    return std::pair{validation.scores[0].band95->width, validation.scores[1].band95->width};
  };
  const auto one = widths(1, false);
  const auto three = widths(3, false);
  const auto itself = widths(1, true);
  CHECK(one.first > three.first);
  CHECK(three.first > itself.first);
  CHECK(one.second > three.second);
  CHECK(three.second > itself.second);
  CHECK(itself.first > 0);
}

TEST_CASE("two targets are enough to learn from for test targets, one is not, nor is no test target") {
  const auto targets = small_targets();
  const std::vector<TargetDemonstrations> two(targets.begin(), targets.begin() + 2);
  const std::vector<TargetDemonstrations> one(targets.begin(), targets.begin() + 1);
  for (const auto& score : judge_on_test_targets(two, {targets[5]}, every_method()).scores) {
    CHECK(std::isfinite(score.rmse));
  }
  const auto id = [](const auto& learnt, const auto& test) {
    return refusal_of([&] { (void)judge_on_test_targets(learnt, test, {}); }).id;
  };
  CHECK(id(one, two) == "validation.too_few_targets");
  CHECK(id(two, std::vector<TargetDemonstrations>{}) == "validation.no_test_target");
}

TEST_CASE("a band's score counts phases and signals, without the ends") {
  const Samples path = Samples::Zero(5, 2);
  Samples mean = Samples::Zero(5, 2);
  mean(0, 0) = 9;  // an end
  mean(2, 1) = 0.5;
  const auto constant = [&](double pointwise, double whole) {
    return Predicted{path, [=](BandKind kind, double) -> Samples {
                       return Samples::Constant(5, 2, kind == BandKind::path ? whole : pointwise);
                     }};
  };
  const BandScore score = band_score(constant(0.2, 0.4), 0.95, mean);
  CHECK(score.pointwise == Approx(5.0 / 6.0));
  CHECK(score.path == 0);
  CHECK(score.width == Approx(0.2));
  CHECK(band_score(constant(0.2, 0.5), 0.95, mean).path == 1);
}

TEST_CASE("bands widen with their level, so they hold more") {
  ValidationOptions options;
  options.methods = {"skill", "promp"};
  for (const auto& score : leave_one_target_out(small_targets(), options).scores) {
    REQUIRE(score.bands.size() == nominal_levels().size());
    for (std::size_t k = 1; k < score.bands.size(); ++k) {
      CHECK(score.bands[k].width >= score.bands[k - 1].width);
      CHECK(score.bands[k].pointwise >= score.bands[k - 1].pointwise);
    }
    CHECK(score.bands[9].width == Approx(score.band95->width));
  }
}

TEST_CASE("one demonstration a target is enough for every method") {
  auto targets = small_targets();
  for (auto& target : targets) target.demonstrations.resize(1);
  const auto validation = leave_one_target_out(targets, every_method());
  for (const auto& score : validation.scores) CHECK(std::isfinite(score.rmse));
  CHECK_FALSE(validation.noise_floor[0]);
}

TEST_CASE("two targets that coincide are no obstacle, where nothing but one change is left to learn from, a skill is") {
  auto targets = small_targets();
  targets[1].demonstrations = targets[0].demonstrations;
  for (const auto& score : leave_one_target_out(targets, every_method()).scores) CHECK(std::isfinite(score.rmse));
  targets.resize(3);
  for (auto& target : targets) target.demonstrations.resize(1);
  ValidationOptions options;
  options.methods = {"line", "nearest", "mean-deviation", "affine", "affine-prior", "promp", "gpr", "kmp"};
  for (const auto& score : leave_one_target_out(targets, options).scores) CHECK(std::isfinite(score.rmse));
  options.methods = {"skill"};
  CHECK(id_of(targets, options) == "skill.one_target");
}

TEST_CASE("two targets or an unknown method are refused") {
  auto targets = small_targets();
  ValidationOptions options;
  options.methods = {"oracle"};
  CHECK_THROWS_AS(leave_one_target_out(targets, options), UsageError);
  targets.resize(2);
  CHECK(id_of(targets, ValidationOptions{}) == "validation.too_few_targets");
}
