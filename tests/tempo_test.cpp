#include "lfdtools/tempo.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill_train.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> xy = {"x", "y"};
const Vector phases = linspace(0, 1, 200);

Vector goal_of(std::size_t target) {
  Vector goal(2);
  goal << 0.3 + 0.1 * static_cast<double>(target), 0.2 - 0.05 * static_cast<double>(target * target);
  return goal;
}

/// A straight minimum-jerk motion whose hand is early by c: at phase s + c sin(pi s) instead of s.
SkillRow early_row(std::size_t target, std::size_t demo, double c, DmpScaling scaling = DmpScaling::none) {
  Samples path(200, 2);
  for (Eigen::Index k = 0; k < 200; ++k) {
    const double s = phases[k] + c * std::sin(std::numbers::pi * phases[k]);
    path.row(k) = s * s * s * (10 + s * (-15 + 6 * s)) * goal_of(target).transpose();
  }
  DmpFitOptions fit;
  fit.scaling = scaling;
  return {{std::to_string(target), {}, std::to_string(demo), {}}, fit_dmp({2 * phases, path}, fit)};
}

using Earliness = std::vector<std::vector<double>>;  // c by target, then by demonstration

std::vector<SkillRow> early_rows(const Earliness& early, DmpScaling scaling = DmpScaling::none) {
  std::vector<SkillRow> rows;
  for (std::size_t i = 0; i < early.size(); ++i) {
    for (std::size_t k = 0; k < early[i].size(); ++k) rows.push_back(early_row(i, k, early[i][k], scaling));
  }
  return rows;
}

SkillOptions own_tempo() {
  SkillOptions options;
  options.kernel = SkillKernel::se_ard;
  options.tempo = SkillTempo::own;
  options.starts = 1;
  return options;
}

/// A skill that predicts the straight line whatever it has seen, so that what it misses is known.
Skill line_skill(const std::vector<SkillRow>& rows) {
  Skill skill = train_skill(xy, rows, own_tempo());
  for (auto& model : skill.models) model.process.kernel.terms.front().variance = 1e-14;
  return skill;
}

Samples path_of(const SkillRow& row) {
  Dmp unit = row.primitive;
  unit.tau = 1;
  return rollout(unit, phases).positions;
}

/// What each target's rows lose of their earliness, by the formula of the header.
std::vector<double> losses(const Earliness& early) {
  std::vector<double> means;
  double within = 0, rows = 0, usual = 0;
  const double m = static_cast<double>(early.size());
  for (const auto& target : early) {
    double mean = 0;
    for (const double c : target) mean += c / static_cast<double>(target.size());
    for (const double c : target) within += (c - mean) * (c - mean);
    rows += static_cast<double>(target.size());
    usual += mean / m;
    means.push_back(mean);
  }
  const double v = within / (rows - m);
  double V = 0;
  for (std::size_t i = 0; i < early.size(); ++i) {
    V += (means[i] - usual) * (means[i] - usual) / (m - 1) - v / static_cast<double>(early[i].size()) / m;
  }
  V = std::max(V, 0.0);
  std::vector<double> losses;
  for (std::size_t i = 0; i < early.size(); ++i) {
    const double chance = v / static_cast<double>(early[i].size());
    losses.push_back(chance / (V + chance) * (means[i] - usual));
  }
  return losses;
}

void check_unchanged(const std::vector<SkillRow>& rows) {
  const auto same = with_shared_tempo(line_skill(rows), rows);
  REQUIRE(same.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(same[i].primitive.weights == rows[i].primitive.weights);
}

std::string id_of(const std::vector<SkillRow>& rows, const SkillOptions& options) {
  return refused_as(Fault::data, [&] { (void)train_skill(xy, rows, options); });
}

}  // namespace

TEST_CASE("each target loses the share of its earliness that its repetitions put down to chance") {
  // Small, because the change of a path is linear in c to first order only.
  const double e = 1e-3;
  Earliness early;
  SECTION("targets differ by more than chance: a part") {
    early = {{5 * e, 3 * e}, {-3 * e, -2 * e, -4 * e}, {e, 0, 2 * e, 3 * e}, {-e}};
  }
  SECTION("by no more than chance: everything") {
    early = {{3 * e, -2 * e}, {-2 * e, 3 * e, 0.5 * e}, {2 * e, -3 * e}};
  }
  const auto rows = early_rows(early);
  const auto shared = with_shared_tempo(line_skill(rows), rows);
  const auto expected = losses(early);
  std::size_t row = 0;
  for (std::size_t i = 0; i < early.size(); ++i) {
    for (std::size_t k = 0; k < early[i].size(); ++k, ++row) {
      const Samples change = path_of(shared[row]) - path_of(rows[row]);
      Samples by_hand(200, 2);
      for (Eigen::Index t = 0; t < 200; ++t) {
        const double s = phases[t];
        const double slope = 30 * s * s * (1 - s) * (1 - s);
        by_hand.row(t) = -expected[i] * std::sin(std::numbers::pi * s) * slope * goal_of(i).transpose();
      }
      INFO("target " << i << ", loss " << expected[i]);
      CHECK((change - by_hand).cwiseAbs().maxCoeff() < 0.02 * by_hand.cwiseAbs().maxCoeff() + 1e-9);
      // Both ends stay where they are.
      CHECK(change.row(0).norm() < 1e-9);
      CHECK(change.row(199).norm() < 1e-9);
      CHECK(shared[row].primitive.goal == rows[row].primitive.goal);
      CHECK(shared[row].primitive.tau == rows[row].primitive.tau);
    }
  }
}

TEST_CASE("rows stay as they are where nothing says what is chance") {
  SECTION("no repetitions") {
    check_unchanged(early_rows({{0.01}, {-0.02}, {0.005}, {0.03}}));
  }
  SECTION("two targets") {
    check_unchanged(early_rows({{0.01, 0.02}, {-0.02, 0}}));
  }
}

TEST_CASE("repetitions that are all alike leave each target its tempo") {
  const auto rows = early_rows({{0.01, 0.01}, {-0.02, -0.02}, {0.005, 0.005}});
  const auto shared = with_shared_tempo(line_skill(rows), rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK((path_of(shared[i]) - path_of(rows[i])).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("a skill with a shared tempo is one that learnt from rows with a shared tempo") {
  Random random(3);
  Earliness early(4);
  for (auto& target : early) {
    for (int k = 0; k < 3; ++k) target.push_back(0.02 * random.normal());
  }
  const auto rows = early_rows(early);
  SkillOptions options = own_tempo();
  const Skill own = train_skill(xy, rows, options);
  const Skill again = train_skill(xy, with_shared_tempo(own, rows), options);
  for (const auto tempo : {SkillTempo::automatic, SkillTempo::shared}) {
    options.tempo = tempo;
    const Skill shared = train_skill(xy, rows, options);
    CHECK(shared.models[0].process.Y == again.models[0].process.Y);
    CHECK(shared.models[1].process.noise_variance == again.models[1].process.noise_variance);
    CHECK(shared.models[0].process.Y != own.models[0].process.Y);
  }
}

TEST_CASE("a shared tempo is refused where weights are scaled by the goal, and with the paper's process") {
  const Earliness early = {{0.01, 0.02}, {-0.02, 0}, {0.01, -0.01}};
  SkillOptions options = own_tempo();
  const auto scaled = early_rows(early, DmpScaling::goal);
  const Skill own = train_skill(xy, scaled, options);
  options.tempo = SkillTempo::automatic;
  CHECK(train_skill(xy, scaled, options).models[0].process.Y == own.models[0].process.Y);
  options.tempo = SkillTempo::shared;
  CHECK(id_of(scaled, options) == "skill.tempo");
  options.paper = true;
  CHECK(id_of(early_rows(early), options) == "skill.tempo");
}
