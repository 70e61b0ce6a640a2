#include "lfdtools/comparison.hpp"

#include <catch2/catch.hpp>

using namespace lfd;

namespace {

Validation scores(const std::vector<std::pair<std::string, std::vector<double>>>& methods) {
  Validation validation;
  for (std::size_t i = 0; i < methods.front().second.size(); ++i) {
    for (const auto& [name, rmse] : methods) {
      ValidationScore score;
      score.labels.target = std::to_string(i);
      score.method = name;
      score.rmse = rmse[i];
      validation.scores.push_back(score);
    }
  }
  for (const auto& method : methods) validation.times.push_back({method.first, 0});
  return validation;
}

}  // namespace

TEST_CASE("means by method in their order") {
  const auto errors = errors_by_method(scores({{"skill", {1, 2, 6}}, {"line", {4, 4, 4}}}));
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].mean == Approx(3));
  CHECK(errors[1].rmse == std::vector<double>{4, 4, 4});
}

TEST_CASE("the ratio is to the best simple opponent, methods that learn more are none") {
  const auto ratio = against_best_simple(
      scores({{"skill", {1, 2, 3}}, {"line", {9, 9, 9}}, {"affine", {2, 4, 6}}, {"gpr", {0, 0, 0}}}));
  REQUIRE(ratio);
  CHECK(ratio->opponent == "affine");
  CHECK(ratio->ratio == Approx(0.5));
  CHECK(ratio->low == Approx(0.5));  // the same on every target, so whatever is drawn
  CHECK(ratio->high == Approx(0.5));
  CHECK_FALSE(against_best_simple(scores({{"line", {1, 2}}})));
  CHECK_FALSE(against_best_simple(scores({{"skill", {1, 2}}, {"gpr", {1, 2}}})));
}

TEST_CASE("the interval holds the ratio and narrows with more targets") {
  std::vector<double> a;
  std::vector<double> b;
  double width[2];
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < (round == 0 ? 6 : 90); ++i) {
      a.push_back(1 + 0.5 * (i % 3));
      b.push_back(1 + 0.5 * (i % 2));
    }
    const auto ratio = against_best_simple(scores({{"skill", a}, {"mean", b}}));
    CHECK(ratio->low < ratio->ratio);
    CHECK(ratio->ratio < ratio->high);
    width[round] = ratio->high - ratio->low;
  }
  CHECK(width[1] < 0.5 * width[0]);
}

TEST_CASE("reliability averages over targets, a noise floor that no target has is none") {
  Validation validation = scores({{"skill", {1, 1}}, {"line", {1, 1}}});
  for (std::size_t i = 0; i < 2; ++i) {
    const double share = i == 0 ? 1.0 : 0.5;
    validation.scores[2 * i].bands.assign(nominal_levels().size(), {share, i == 0 ? 1.0 : 0.0, 0.01});
  }
  const auto rows = reliability(validation);
  REQUIRE(rows.size() == nominal_levels().size());
  CHECK(rows.back().nominal == 0.99);
  CHECK(rows[0].pointwise == Approx(0.75));
  CHECK(rows[0].path == Approx(0.5));
  CHECK(rows[0].width == Approx(0.01));
  validation.noise_floor = {std::nullopt, std::nullopt};
  CHECK_FALSE(mean_noise_floor(validation));
  validation.noise_floor = {std::nullopt, 0.002};
  CHECK(*mean_noise_floor(validation) == 0.002);
}
