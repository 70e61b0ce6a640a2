#include "lfdtools/suggestion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/fold.hpp"
#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

Vector vec(double x, double y) {
  Vector v(2);
  v << x, y;
  return v;
}

/// A skill in the plane from one primitive a goal, with weights of chance and a kernel of known length [m].
Skill plane_skill(const std::vector<Vector>& goals, SkillStructure structure, double length_scale) {
  Random random(5);
  std::vector<SkillRow> rows;
  for (const auto& goal : goals) {
    Dmp dmp;
    dmp.settings = make_dmp_settings(6);
    dmp.start = Vector::Zero(2);
    dmp.goal = goal;
    dmp.weights = Matrix::NullaryExpr(2, 6, [&] { return random.normal(); });
    dmp.rmse = Vector::Constant(2, 0.002);
    rows.push_back({{std::to_string(rows.size() + 1), {}, {}, {}}, dmp});
  }
  SkillOptions options;
  options.structure = structure;
  options.kernel = SkillKernel::se_ard;
  options.starts = 1;
  Skill skill = train_skill({"x", "y"}, rows, options);
  for (auto& model : skill.models) {
    model.process.kernel.terms.front().length_scales.setConstant(length_scale);
    model.process.noise_variance = 0.02;
  }
  Calibration calibration;
  calibration.target_variance = vec(0.05, 0.3);
  calibration.reproduction = vec(0.001, 0.002);
  skill.calibration = calibration;
  return skill;
}

/// The sd of calibration.hpp at one goal, phase by phase [m].
double sd_at(const SkillPredictor& predictor, const Vector& goal) {
  const auto& calibration = *predictor.skill().calibration;
  Samples variance = position_variance(predictor, predictor.reach({{}, goal, {}, {}}), linspace(0, 1, phase_count))
                         .of_mean(calibration.target_variance, INFINITY);
  variance.rowwise() += calibration.reproduction.array().square().matrix().transpose();
  return std::sqrt(variance.maxCoeff());
}

double largest_sd(const Skill& skill, const Matrix& goals) {
  const SkillPredictor predictor(skill);
  double largest = 0;
  for (Eigen::Index g = 0; g < goals.rows(); ++g)
    largest = std::max(largest, sd_at(predictor, goals.row(g).transpose()));
  return largest;
}

/// The skill with r rows more at a goal, whatever was done there; Omega kept.
Skill with_target(Skill skill, const Vector& goal, int r) {
  for (auto& model : skill.models) {
    MvgpModel& process = model.process;
    const Eigen::Index n = process.X.rows();
    process.X.conservativeResize(n + r, Eigen::NoChange);
    process.X.bottomRows(r).rowwise() = inputs_of(model, {goal - skill.start}).transpose();
    process.Y.conservativeResize(n + r, Eigen::NoChange);
    process.Y.bottomRows(r).setConstant(7);
  }
  return skill;
}

Skill without_row(Skill skill, Eigen::Index i) {
  for (auto& model : skill.models) {
    for (Matrix* rows : {&model.process.X, &model.process.Y}) {
      const Matrix below = rows->bottomRows(rows->rows() - i - 1);
      rows->middleRows(i, below.rows()) = below;
      rows->conservativeResize(rows->rows() - 1, Eigen::NoChange);
    }
  }
  return skill;
}

std::string id_of(const GoalBox& box) {
  return refused_as(Fault::usage, [&] { (void)goal_grid(box); });
}

}  // namespace

TEST_CASE("what is said of a target more and of a row less is what another factorisation says") {
  const auto structure = GENERATE(SkillStructure::axis, SkillStructure::full, SkillStructure::joint);
  std::vector<Vector> layout;
  Random random(11);
  for (int i = 0; i < 9; ++i) layout.push_back(vec(random.uniform(0.1, 0.4), random.uniform(-0.2, 0.2)));
  const Skill skill = plane_skill(layout, structure, 0.08);
  const GoalBox box{vec(0.05, 0.1), vec(0.45, 0.1)};  // flat in y
  const Matrix goals = goal_grid(box);
  const Suggestion found = suggest(SkillPredictor(skill), box, 3);
  CHECK(found.sd_before == Approx(largest_sd(skill, goals)).epsilon(1e-9));
  CHECK(found.sd_after == Approx(largest_sd(with_target(skill, found.goal, 3), goals)).epsilon(1e-9));
  CHECK(found.sd_after < found.sd_before);
  for (Eigen::Index c = 0; c < goals.rows(); c += 7) {
    CHECK(largest_sd(with_target(skill, goals.row(c).transpose(), 3), goals) > found.sd_after * (1 - 1e-9));
  }
  REQUIRE(found.rows.size() == layout.size());
  const SkillPredictor before(skill);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Skill less = without_row(skill, static_cast<Eigen::Index>(i));
    const SkillPredictor after(less);
    double growth = 0;
    for (Eigen::Index g = 0; g < goals.rows(); ++g) {
      growth = std::max(growth, sd_at(after, goals.row(g).transpose()) - sd_at(before, goals.row(g).transpose()));
    }
    CHECK(found.rows[i].largest_sd == Approx(largest_sd(less, goals)).epsilon(1e-9));
    CHECK(found.rows[i].growth == Approx(growth).epsilon(1e-6).margin(1e-12));
    CHECK(found.rows[i].growth >= found.rows[found.least].growth * (1 - 1e-9));
  }
}

TEST_CASE("a hole in the layout is what to demonstrate, and a demonstration twice over what to leave out") {
  std::vector<Vector> layout;
  for (const double x : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    for (const double y : {0.1, 0.2, 0.3, 0.4, 0.5}) {
      if (std::abs(x - 0.3) > 0.05 || std::abs(y - 0.4) > 0.05) layout.push_back(vec(x, y));
    }
  }
  const GoalBox box{vec(0.1, 0.1), vec(0.5, 0.5)};
  const SkillPredictor once(plane_skill(layout, SkillStructure::full, 0.1));
  const Suggestion holed = suggest(once, box, 1);
  CHECK((holed.goal - vec(0.3, 0.4)).norm() < 0.02);
  CHECK(holed.sd_after < holed.sd_before);
  CHECK(holed.fall >= holed.sd_before - holed.sd_after);
  layout.push_back(layout[7]);
  const Suggestion twice = suggest(SkillPredictor(plane_skill(layout, SkillStructure::full, 0.1)), box, 1);
  CHECK(twice.least == 7);
  CHECK(twice.rows.back().growth == Approx(twice.rows[7].growth).epsilon(1e-6));
  CHECK(twice.rows[7].growth < 0.5 * twice.rows[8].growth);
}

TEST_CASE("the grid reaches the ends of the box, and a flat axis once") {
  const GoalBox box{vec(0.1, 0.3), vec(0.2, 0.3)};
  const Matrix goals = goal_grid(box);
  CHECK(goals.rows() == 101);
  CHECK(goals.col(0).minCoeff() == 0.1);
  CHECK(goals.col(0).maxCoeff() == 0.2);
  CHECK((goals.col(1).array() == 0.3).all());
  CHECK(goal_grid({Vector::Zero(3), Vector::Ones(3)}).rows() == 729);
  CHECK(goal_grid({vec(1, 2), vec(1, 2)}) == Matrix(vec(1, 2).transpose()));
  CHECK(id_of({vec(0.1, 0.3), vec(0.05, 0.3)}) == "suggestion.box");
  CHECK(id_of({vec(0.1, 0.3), Vector::Ones(3)}) == "suggestion.box");
  CHECK(id_of({vec(0.1, NAN), vec(0.2, 1)}) == "suggestion.box");
  CHECK(id_of({Vector::Zero(7), Vector::Ones(7)}) == "suggestion.dimensions");
}
