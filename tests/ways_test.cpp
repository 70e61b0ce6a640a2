#include "lfdtools/ways.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill_train.hpp"

using namespace lfd;

namespace {

/// Motions to five goals on a line, with a bump to one side or the other [m] and the wander of a hand.
/// @param side  of a row, by target and repetition
template <typename Side>
std::vector<SkillRow> motions(Side side, double wander) {
  Random random(7);
  std::vector<SkillRow> rows;
  const Vector s = linspace(0, 1, 150);
  for (int target = 0; target < 5; ++target) {
    for (int repetition = 0; repetition < 8; ++repetition) {
      Samples path = s * Eigen::RowVector2d(0.4, 0.1 * target);
      const auto half = (s * std::numbers::pi).array().sin().square();
      path.col(0).array() += side(target, repetition) * half;
      for (const int j : {0, 1}) path.col(j).array() += wander * random.normal() * half;
      DmpFitOptions fit;
      fit.bases = 10;
      rows.push_back({{std::to_string(target), {}, std::to_string(repetition), {}}, fit_dmp({2 * s, path}, fit)});
    }
  }
  return rows;
}

std::optional<Ways> ways_of(const std::vector<SkillRow>& rows) {
  return two_ways(train_skill({"x", "y"}, rows), rows);
}

}  // namespace

TEST_CASE("two ways round are told apart row by row") {
  const auto left = [](int target, int repetition) { return (repetition * 3 + target) % 8 < 3; };
  const auto rows = motions([&](int t, int r) { return left(t, r) ? -0.1 : 0.1; }, 0.01);
  const auto ways = ways_of(rows);
  REQUIRE(ways);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK((ways->of_row[i] == ways->of_row[0]) ==
          (left(static_cast<int>(i) / 8, static_cast<int>(i) % 8) == left(0, 0)));
  }
  // The root mean square of sin^2 is sqrt(3 / 8).
  CHECK(ways->distance == Approx(0.2 * std::sqrt(3.0 / 8)).epsilon(0.1));
  CHECK(ways->separation > 10);
  CHECK(rows_of_way(rows, *ways, 0).size() + rows_of_way(rows, *ways, 1).size() == rows.size());
  CHECK(rows_of_way(rows, *ways, 0).front().labels == rows.front().labels);
  // Five rows of eight go to the right, whatever the target.
  CHECK(nearest_way(rows, *ways, rows[20].change()) != ways->of_row[0]);
}

TEST_CASE("two ways are told apart where the berth depends on the target and most rows of it go one way") {
  const auto left = [](int target, int repetition) {
    return target == 3 ? false : repetition % 8 < (target % 2 == 0 ? 1 : 6);
  };
  const auto rows = motions([&](int t, int r) { return (left(t, r) ? -1 : 1) * (0.05 + 0.03 * t); }, 0.01);
  const auto ways = ways_of(rows);
  REQUIRE(ways);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int target = static_cast<int>(i) / 8;
    if (target == 3) continue;  // one way alone: below
    CHECK((ways->of_row[i] == ways->of_row[0]) == (left(target, static_cast<int>(i) % 8) == left(0, 0)));
  }
  for (std::size_t i = 24; i < 32; ++i) CHECK(ways->of_row[i] != ways->of_row[0]);
}

TEST_CASE("one way is not taken for two") {
  CHECK_FALSE(ways_of(motions([](int, int) { return 0.1; }, 0.02)));
  // A single outlier is no way.
  CHECK_FALSE(ways_of(motions([](int t, int r) { return t == 2 && r == 3 ? 0.5 : 0.1; }, 0.01)));
  // What the target decides may be what is meant.
  CHECK_FALSE(ways_of(motions([](int t, int) { return t < 2 ? -0.1 : 0.1; }, 0.01)));
}
