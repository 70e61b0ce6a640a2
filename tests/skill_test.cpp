#include "lfdtools/skill.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/validation.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> xyz = {"x", "y", "z"};

/// A motion from the origin whose bump is affine in the goal.
Trajectory motion_to(const Vector& goal, double duration) {
  const Vector phases = linspace(0, 1, 150);
  Samples path = straight_line(Vector::Zero(3), goal, phases);
  for (Eigen::Index i = 0; i < 150; ++i) {
    const double bump = std::pow(phases[i] * (1 - phases[i]), 3) * 64;
    path(i, 2) += bump * (0.05 + 0.3 * goal[0]);
    path(i, 0) -= bump * 0.2 * goal[1];
  }
  return {phases * duration, path};
}

std::vector<SkillRow> rows_on_grid(double tempo = 0) {
  std::vector<SkillRow> rows;
  for (const double x : {0.2, 0.3, 0.4}) {
    for (const double y : {-0.1, 0.05, 0.2}) {
      Vector goal(3);
      goal << x, y, 0.3 - 0.5 * y;
      rows.push_back({{std::to_string(rows.size() + 1), {}, {}, {}}, fit_dmp(motion_to(goal, 2 + tempo * x))});
    }
  }
  return rows;
}

Vector vec(double x, double y, double z) {
  Vector v(3);
  v << x, y, z;
  return v;
}

}  // namespace

TEST_CASE("the trajectory metric measures weights by the distance of the motions that they make") {
  const DmpSettings settings = make_dmp_settings(15);
  const Matrix A = trajectory_metric(settings);
  Random random(2);
  for (int trial = 0; trial < 5; ++trial) {
    Dmp dmp;
    dmp.settings = settings;
    dmp.start = dmp.goal = Vector::Zero(1);
    dmp.rmse = Vector::Zero(1);
    dmp.weights = Matrix(1, 15);
    for (Eigen::Index i = 0; i < 15; ++i) dmp.weights(0, i) = 100 * random.normal();
    const Samples path = rollout(dmp, linspace(0, 1, 200)).positions;
    CHECK((dmp.weights * A).norm() == Approx(std::sqrt(path.squaredNorm() / 200)).epsilon(1e-5));
  }
}

TEST_CASE(
    "a skill follows an intention that is affine in the goal to targets between and beside the demonstrated ones") {
  for (const auto structure : {SkillStructure::automatic, SkillStructure::full, SkillStructure::joint}) {
    SkillOptions options;
    options.structure = structure;
    const SkillPredictor predictor(train_skill(xyz, rows_on_grid(), options));
    for (const Vector& goal : {vec(0.25, 0.1, 0.25), vec(0.42, 0.22, 0.19)}) {
      const Dmp dmp = predictor.primitive({{}, goal, {}, 2.0});
      const Samples path = rollout(dmp, linspace(0, 2, 150)).positions;
      CHECK(rms_distance(path, motion_to(goal, 2).positions) < 0.002);
      CHECK((path.row(149).transpose() - goal).norm() < 1e-4);
    }
  }
}

TEST_CASE("structures say which components speak for which weights") {
  const auto rows = rows_on_grid();
  SkillOptions options;
  options.paper = true;
  const Skill paper = train_skill(xyz, rows, options);
  REQUIRE(paper.models.size() == 3);
  CHECK(paper.models[1].inputs == std::vector<int>{1});
  CHECK(paper.models[1].outputs == std::vector<int>{1});
  CHECK(paper.models[1].process.output_transform.size() == 0);
  CHECK(paper.models[1].process.kernel.terms.size() == 1);
  options.structure = SkillStructure::full;
  CHECK(train_skill(xyz, rows, options).models[2].inputs == std::vector<int>{0, 1, 2});
  options.structure = SkillStructure::joint;
  const Skill joint = train_skill(xyz, rows, options);
  REQUIRE(joint.models.size() == 1);
  CHECK(joint.models[0].process.Y.cols() == 45);
  CHECK(joint.models[0].outputs == std::vector<int>{0, 1, 2});
}

TEST_CASE("weights come out signal by signal, basis by basis, as the process gives them") {
  const Skill skill = train_skill(xyz, rows_on_grid());
  const Vector change = vec(0.33, 0, 0.3);
  const WeightPrediction weights = SkillPredictor(skill).weights(change);
  for (int j = 0; j < 3; ++j) {
    const MvgpPrediction row = predict(skill.models[static_cast<std::size_t>(j)].process, change);
    CHECK((weights.mean.row(j).transpose() - row.mean).norm() < 1e-9 * (1 + row.mean.norm()));
  }
  CHECK(weights.sd.minCoeff() >= 0);
}

TEST_CASE("the duration follows a line where the durations do, and stays what it always was") {
  const Skill same = train_skill(xyz, rows_on_grid());
  CHECK(same.duration.predict(vec(0.3, 0.1, 0.25)) == Approx(2).epsilon(1e-6));
  const Skill slower = train_skill(xyz, rows_on_grid(1.0));
  CHECK(slower.duration.predict(vec(0.3, 0.1, 0.25)) == Approx(2.3).epsilon(0.01));
  CHECK(slower.duration.predict(vec(30, 0.1, 0.25)) == Approx(2.4));
}

TEST_CASE("a generated motion goes on until it rests on its goal") {
  const SkillPredictor predictor(train_skill(xyz, rows_on_grid()));
  const Dmp dmp = predictor.primitive({{}, vec(0.3, 0.1, 0.25), vec(0.01, 0.02, 0), {}});
  const Motion motion = generate(dmp);
  const Eigen::Index last = motion.times.size() - 1;
  CHECK(motion.times[0] == 0);
  CHECK(motion.times[last] >= dmp.tau * (1 - 1e-12));
  CHECK((motion.positions.row(0).transpose() - vec(0.01, 0.02, 0)).norm() < 1e-15);
  CHECK((motion.positions.row(last).transpose() - dmp.goal).norm() <= 1e-4);
  CHECK_THROWS_AS(generate(dmp, 1e-9), DataError);
}

TEST_CASE("the demonstrated region is the widened range of each signal") {
  const Skill skill = train_skill(xyz, rows_on_grid());
  CHECK(region_excess(skill, vec(0.3, 0, 0.3)) == 0);
  CHECK(region_excess(skill, vec(0.415, 0, 0.3)) == 0);
  CHECK(region_excess(skill, vec(0.52, 0, 0.3)) == Approx(0.1));
  CHECK(region_excess(skill, vec(0.3, -0.2, 0.4)) == Approx(0.07));
}

TEST_CASE("beside targets on a slanted line or plane nothing was demonstrated") {
  std::vector<SkillRow> line, plane;
  for (const double x : {0.2, 0.3, 0.4}) {
    const auto name = std::to_string(line.size());
    line.push_back({{name, {}, {}, {}}, fit_dmp(motion_to(vec(x, 2 * x - 0.6, 0.3 - x), 2))});
    for (const double y : {-0.1, 0.2}) {
      plane.push_back({{name + std::to_string(y), {}, {}, {}}, fit_dmp(motion_to(vec(x, y, 0.3 - x + y), 2))});
    }
  }
  for (const auto structure : {SkillStructure::full, SkillStructure::axis}) {
    SkillOptions options;
    options.structure = structure;
    options.starts = 1;
    const Skill on_line = train_skill(xyz, line, options);
    CHECK(region_excess(on_line, vec(0.35, 0.1, -0.05)) == 0);
    CHECK(region_excess(on_line, vec(0.4, 0.2, 0.1)) > 0.1);  // inside the interval of each signal
    const Skill on_plane = train_skill(xyz, plane, options);
    CHECK(region_excess(on_plane, vec(0.35, 0.05, 0.0)) == 0);
    CHECK(region_excess(on_plane, vec(0.35, 0.05, 0.1)) == Approx(0.1 / std::sqrt(3) - 0.01));
  }
}

TEST_CASE("rows that make no skill are refused") {
  auto rows = rows_on_grid();
  CHECK_THROWS_AS(train_skill(xyz, {rows.front()}), DataError);
  CHECK_THROWS_AS(train_skill(xyz, {rows.front(), rows.front()}), DataError);
  auto same_name = rows;
  for (auto& row : same_name) row.labels.target = "hole";
  CHECK_THROWS_AS(train_skill(xyz, same_name), DataError);
  CHECK_THROWS_AS(train_skill({"x", "y"}, rows), DataError);
  DmpFitOptions other;
  other.bases = 10;
  rows.push_back({{}, fit_dmp(motion_to(vec(0.3, 0.3, 0.3), 2), other)});
  CHECK_THROWS_AS(train_skill(xyz, rows), DataError);
}
