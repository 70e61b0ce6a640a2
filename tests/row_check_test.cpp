#include "lfdtools/row_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill_train.hpp"

using namespace lfd;

namespace {

/// Demonstrations of five targets on a line, with 3 mm of chance in their bumps.
std::vector<SkillRow> some_rows(int repetitions) {
  Random random(5);
  std::vector<SkillRow> rows;
  const Vector phases = linspace(0, 1, 60);
  for (int target = 0; target < 5; ++target) {
    for (int demo = 0; demo < repetitions; ++demo) {
      Samples path(60, 2);
      const double bump = 0.1 + 0.02 * target + 0.003 * random.normal();
      for (Eigen::Index i = 0; i < 60; ++i) {
        const double s = phases[i];
        const double m = s * s * s * (10 - 15 * s + 6 * s * s);
        path.row(i) << (0.2 + 0.1 * target) * m, 0.3 * m + bump * 64 * std::pow(s * (1 - s), 3);
      }
      DmpFitOptions fit;
      fit.bases = 8;
      rows.push_back({{std::to_string(target), {}, std::to_string(demo), {}}, fit_dmp({2 * phases, path}, fit)});
    }
  }
  return rows;
}

Skill learnt(const std::vector<SkillRow>& rows) {
  SkillOptions options;
  options.starts = 1;
  return train_skill({"x", "y"}, rows, options);
}

}  // namespace

TEST_CASE("a copy of a row is found in its own target alone") {
  auto rows = some_rows(2);
  CHECK(repeated_rows(rows).empty());
  rows.push_back(rows[3]);
  rows.back().labels.demo = "again";
  rows.push_back(rows[3]);
  rows.back().labels.target = "another";
  CHECK(repeated_rows(rows) == std::vector<std::size_t>{10});
  CHECK(without(rows, repeated_rows(rows)).size() == 11);
}

TEST_CASE("rows that all are copies, or nearly, make a skill") {
  auto rows = some_rows(1);
  const std::size_t targets = rows.size();
  for (const double apart : {0.0, 1e-9}) {
    for (std::size_t i = 0; i < targets; ++i) {
      rows.push_back(rows[i]);
      rows.back().primitive.weights.array() += apart;
    }
    const SkillPredictor predictor(learnt(rows));
    CHECK(left_out_residuals(predictor.skill()).allFinite());
    CHECK(predictor.weights(rows[2].change()).mean.isApprox(rows[2].primitive.weights, 0.02));
  }
}

TEST_CASE("a row far from what other targets say of it is an outlier") {
  auto rows = some_rows(3);
  CHECK(outlying_rows(learnt(rows), rows).empty());
  rows[7].primitive.weights *= 3;
  const auto outliers = outlying_rows(learnt(rows), rows);
  REQUIRE(outliers.size() == 1);
  CHECK(outliers[0].row == 7);
  CHECK(outliers[0].ratio > 5);
  CHECK_FALSE(outliers[0].ends);
  const std::vector<SkillRow> few{rows[0], rows[3], rows[7]};
  CHECK(outlying_rows(learnt(few), few).empty());
}

TEST_CASE("a row that starts far from the others of its target is an outlier, and they are not") {
  auto rows = some_rows(4);
  rows[9].primitive.start[1] += 0.3;
  rows[9].primitive.goal[1] += 0.3;
  const auto outliers = outlying_rows(learnt(rows), rows);
  REQUIRE(outliers.size() == 1);
  CHECK(outliers[0].row == 9);
  CHECK(outliers[0].ends);
}

TEST_CASE("targets of one place are found whatever their names") {
  auto rows = some_rows(2);
  CHECK(coinciding_targets(rows).empty());
  rows[4].labels.target = "other";  // the first row of the third target: it comes before the rest of it
  const auto pairs = coinciding_targets(rows);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0] == std::pair<std::size_t, std::size_t>(2, 3));
  for (auto& row : rows) {
    if (row.labels.target == "other") row.primitive.start[0] += 0.05;
    if (row.labels.target == "other") row.primitive.goal[0] += 0.05;
  }
  CHECK(coinciding_targets(rows).empty());  // the same dP from another start
}
