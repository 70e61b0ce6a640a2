#include "lfdtools/skill.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill_train.hpp"
#include "lfdtools/tempo.hpp"
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

/// What each row misses when its target is left out and the rest learnt anew with the skill's hyperparameters,
/// n x (D N), in the metric.
Matrix misses_by_retraining(const Skill& skill, const std::vector<SkillRow>& rows, SkillOptions options) {
  options.hyperparameters = &skill;
  const Matrix metric = trajectory_metric(skill.dmp);
  const Eigen::Index N = skill.dmp.bases();
  Matrix missed(static_cast<Eigen::Index>(rows.size()), N * static_cast<Eigen::Index>(skill.columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<SkillRow> rest;
    for (const auto& row : rows) {
      if (row.labels.target != rows[i].labels.target) rest.push_back(row);
    }
    const SkillPredictor predictor(train_skill(skill.columns, rest, options));
    const Matrix left = (rows[i].primitive.weights - predictor.weights(rows[i].change()).mean) * metric;
    for (Eigen::Index j = 0; j < left.rows(); ++j) {
      missed.row(static_cast<Eigen::Index>(i)).segment(j * N, N) = left.row(j);
    }
  }
  return missed;
}

/// Two noisy motions to each of a grid of goals, bent by what the first input does for itself.
std::vector<SkillRow> rows_by_one_input(Random& random) {
  std::vector<SkillRow> rows;
  const double alone[] = {0, 0.06, -0.05, 0.03};
  const Vector phases = linspace(0, 1, 100);
  const Vector bump = (3.14159265358979 * phases.array()).sin().square();
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      Vector goal(2);
      goal << 0.3 + 0.1 * i, 0.1 + 0.1 * k;
      for (int r = 0; r < 2; ++r) {
        Samples path = straight_line(Vector::Zero(2), goal, phases);
        path.col(0) += (alone[i] + 0.003 * random.normal()) * bump;
        path.col(1) += 0.003 * random.normal() * bump;
        DmpFitOptions fit;
        fit.bases = 8;
        rows.push_back({{std::to_string(4 * i + k), {}, std::to_string(r), {}}, fit_dmp({2 * phases, path}, fit)});
      }
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

TEST_CASE("teachers are told apart: each keeps to their own way, and nobody's way is less sure") {
  std::vector<SkillRow> rows;
  for (const std::string teacher : {"anna", "bert"}) {
    for (SkillRow row : rows_on_grid()) {
      // Bert goes 40 mm higher halfway; two of his targets alone are known.
      if (teacher == "bert" && row.labels.target != "1" && row.labels.target != "9") continue;
      Trajectory path = motion_to(row.primitive.goal, 2);
      const auto s = path.times.array() / 2;
      if (teacher == "bert") path.positions.col(2).array() += 0.04 * 64 * (s * (1 - s)).cube();
      row.labels.teacher = teacher;
      rows.push_back({row.labels, fit_dmp(path)});
    }
  }
  const SkillPredictor predictor(train_skill(xyz, rows));
  REQUIRE(sees_teachers(predictor.skill()));
  CHECK(teacher_number(predictor.skill().rows, "bert") == 1);
  CHECK(teacher_number(predictor.skill().rows, "carla") == -1);
  const Vector goal = vec(0.3, 0.05, 0.275);
  const auto halfway = [&](std::optional<std::string> teacher) {
    const Dmp dmp = predictor.primitive({{{}, teacher, {}, {}}, goal, Vector::Zero(3), 1.0});
    return rollout(dmp, Vector::Constant(1, 0.5)).positions(0, 2);
  };
  CHECK(halfway("bert") - halfway("anna") == Approx(0.04).margin(0.002));
  const auto variance = [&](std::optional<std::string> teacher) {
    const Reach reach = predictor.reach({{{}, teacher, {}, {}}, goal, Vector::Zero(3), {}});
    return predictor.processes()[2].predict(inputs_of(predictor.skill().models[2], reach)).variance;
  };
  CHECK(variance("bert") < variance({}));
  CHECK(variance("carla") == variance({}));
  SkillOptions together;
  together.teachers = SkillTeachers::together;
  CHECK_FALSE(sees_teachers(train_skill(xyz, rows, together)));
  together = {};
  together.teachers = SkillTeachers::apart;
  together.paper = true;
  CHECK_THROWS_AS(train_skill(xyz, rows, together), UsageError);
}

TEST_CASE("what is left of a target that is left out is what a skill without it misses") {
  auto rows = rows_on_grid();
  for (std::size_t i = 0; i < rows.size(); ++i) {  // five targets, the last of one row
    rows[i].labels = {std::to_string(i / 2), {}, std::to_string(i % 2), {}};
    rows[i].primitive.weights.row(0) *= 1 + 0.03 * static_cast<double>(i % 3);
  }
  for (const auto structure : {SkillStructure::axis, SkillStructure::full, SkillStructure::joint}) {
    SkillOptions options;
    options.structure = structure;
    options.tempo = SkillTempo::own;
    options.starts = 1;
    const Skill skill = train_skill(xyz, rows, options);
    const Matrix brute = misses_by_retraining(skill, rows, options);
    CHECK((left_out_residuals(skill) - brute).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("of sum and additive the kernel is chosen that misses less on targets left out") {
  int additive = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Random random(seed);
    const auto rows = rows_by_one_input(random);
    double missed[2] = {};
    for (const auto kernel : {SkillKernel::additive, SkillKernel::sum}) {
      SkillOptions options;
      options.kernel = kernel;
      options.starts = 1;
      options.tempo = SkillTempo::own;
      const Skill skill = train_skill({"x", "y"}, rows, options);
      const Matrix brute = misses_by_retraining(skill, rows, options);
      for (const auto& group : target_groups(skill.rows)) {
        missed[kernel == SkillKernel::sum] += brute(group, Eigen::all).colwise().mean().squaredNorm();
      }
    }
    INFO("additive " << missed[0] << ", sum " << missed[1]);
    CHECK(choose_kernel({"x", "y"}, rows, {}) == (missed[0] < missed[1] ? SkillKernel::additive : SkillKernel::sum));
    additive += missed[0] < missed[1] ? 1 : 0;
  }
  CHECK(additive > 0);  // both choices are tried
  CHECK(additive < 4);
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
