#include <catch2/catch.hpp>

#include "io_model_fixture.hpp"
#include "lfdtools/calibration.hpp"
#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/io/skill_file.hpp"
#include "lfdtools/validation.hpp"

using namespace lfd;

namespace {

SkillFile trained(const SkillOptions& options) {
  std::vector<SkillRow> rows;
  for (const double x : {0.1, 0.2, 0.3, 0.45}) {
    Vector goal(2);
    goal << x, 0.4 - x * x;
    const Vector phases = linspace(0, 1, 60);
    Samples path = straight_line(Vector::Zero(2), goal, phases);
    for (Eigen::Index i = 0; i < 60; ++i) path(i, 1) += x * phases[i] * (1 - phases[i]);
    DmpFitOptions fit;
    fit.bases = 6;
    rows.push_back({{std::to_string(rows.size() + 1), "ann", "1", {}}, fit_dmp({phases * (1 + x), path}, fit)});
  }
  SkillFile file{{{"x", "y"}, {}, {}}, train_skill({"x", "y"}, rows, options)};
  file.skill.calibration = calibrate(file.skill, rows, options);
  REQUIRE(file.skill.calibration);
  return file;
}

}  // namespace

TEST_CASE("a skill that is written and read again predicts the same and writes the same bytes") {
  for (const bool paper : {false, true}) {
    for (const auto structure : {SkillStructure::axis, SkillStructure::full, SkillStructure::joint}) {
      SkillOptions options;
      options.paper = paper;
      options.structure = structure;
      if (!paper && structure == SkillStructure::full) options.mean = SkillMean::constant;
      const SkillFile file = trained(options);
      const std::string text = text_of(file, write_skill);
      const SkillFile back = read_skill(document(text));
      CHECK(text_of(back, write_skill) == text);
      Vector change(2);
      change << 0.25, 0.3;
      CHECK(SkillPredictor(back.skill).weights(change).mean == SkillPredictor(file.skill).weights(change).mean);
      CHECK(back.skill.duration.predict(change) == file.skill.duration.predict(change));
      CHECK(back.skill.rows == file.skill.rows);
      const Vector phases = linspace(0, 1, 20);
      CHECK(band(SkillPredictor(back.skill), change, phases, BandKind::path) ==
            band(SkillPredictor(file.skill), change, phases, BandKind::path));
    }
  }
}

TEST_CASE("what does not fit together is refused with its place") {
  const std::string text = text_of(trained({}), write_skill);
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& id,
                           const std::string& pointer) {
    INFO(from << " -> " << to);
    require_refused(changed(text, from, to), read_skill, id, pointer);
  };
  refused(R"("scaling":"none")", R"("scaling":"some")", "json.out_of_range", "/dmp/scaling");
  refused(R"("outputs":["x"])", R"("outputs":["z"])", "skill.unknown_signal", "/models/0/outputs/0");
  refused(R"("outputs":["x"])", R"("outputs":["y"])", "skill.outputs", "/models");
  refused(R"("inputs":["x","y"])", R"("inputs":["x","x"])", "skill.repeated_signal", "/models/0/inputs/1");
  refused(R"("type":"linear")", R"("type":"cubic")", "kernel.unknown_type", "/models/0/kernel/terms/1/type");
  refused(R"("mean":{"type":"linear")", R"("mean":{"type":"constant")", "json.wrong_length",
          "/models/0/mean/coefficients");
  refused(R"("nu":8)", R"("nu":"8")", "json.not_a_number", "/models/0/nu");
  refused(R"("rows":[{)", R"("rows":[{"colour":1,)", "json.unknown_key", "/rows/0/colour");
  refused(R"("levels":[0.1)", R"("levels":[0.3)", "skill.levels", "/calibration/levels");
  refused(R"({"targets":)", R"({"targets":-)", "json.out_of_range", "/calibration/targets");
}
