#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/experiment_file.hpp"
#include "lfdtools/io/scene_file.hpp"
#include "lfdtools/io/skill_file.hpp"
#include "material_reader.hpp"

namespace lfd::plot {
namespace {

constexpr double endless = 100;  // [m], length of a cylinder without end: far beyond any arm

/// The experiment's obstacle as a solid: a sphere, or a long cylinder along its axis.
Solid solid_of(const Obstacle& obstacle) {
  Solid solid;
  solid.name = "obstacle";
  solid.pose.position = obstacle.center;
  solid.radius = obstacle.radius;
  solid.shape = SolidShape::sphere;
  if (obstacle.axis.size() == 3 && obstacle.axis.norm() > 0) {
    solid.shape = SolidShape::cylinder;
    solid.length = endless;
    const Vector3 z = obstacle.axis.normalized();
    Eigen::Index least = 0;
    z.cwiseAbs().minCoeff(&least);
    const Vector3 x = z.cross(Vector3::Unit(least)).normalized();
    solid.pose.rotation << x, z.cross(x), z;
  }
  return solid;
}

/// Weights of the training rows of a skill: W = Y A^-1, rows by target, columns by signal and basis.
std::vector<TrainingWeights> rows_of(const Skill& skill) {
  const Eigen::Index N = skill.dmp.bases();
  const auto D = static_cast<Eigen::Index>(skill.columns.size());
  std::vector<TrainingWeights> rows(skill.rows.size(), {skill.columns, Matrix::Zero(D, N), skill.dmp.scaling});
  for (const SkillModel& model : skill.models) {
    Matrix W = model.process.Y;
    if (const Matrix& A = model.process.output_transform; A.size() > 0) {
      W = A.transpose().fullPivLu().solve(W.transpose()).transpose();
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < model.outputs.size(); ++k) {
        rows[i].weights.row(model.outputs[k]) =
            W.row(static_cast<Eigen::Index>(i)).segment(static_cast<Eigen::Index>(k) * N, N);
      }
    }
  }
  return rows;
}

}  // namespace

void MaterialReader::read_documents(Input input) {
  const std::string file = input.name();
  std::vector<Input> inputs;
  inputs.push_back(std::move(input));
  JsonStream stream(std::move(inputs), messages_, options_.json);
  while (const auto document = stream.next()) read_document(*document, file);
}

void MaterialReader::read_document(const JsonDocument& document, const std::string& file) {
  const std::string format = document.format();
  if (format == "lfdtools.dmp") {
    const DmpFile dmp = read_dmp(document);
    material_.training.push_back({dmp.header.columns, dmp.dmp.weights, dmp.dmp.settings.scaling});
    found("a primitive", file);
  } else if (format == skill_format) {
    const SkillFile skill = read_skill(document);
    for (TrainingWeights& row : rows_of(skill.skill)) material_.training.push_back(std::move(row));
    found("a skill", file);
  } else if (format == "lfdtools.gmm") {
    GmmFile mixture = read_gmm(document);
    const std::vector<std::string>& columns = mixture.header.columns;
    adopt({columns.begin() + 1, columns.end()}, file);
    material_.mixtures.push_back(std::move(mixture));
    found("a mixture", file);
  } else if (format == "lfdtools.scene") {
    for (Solid& solid : read_scene(document).in_base()) material_.obstacles.push_back(std::move(solid));
    found("a scene", file);
  } else if (format == "lfdtools.experiment") {
    const Experiment experiment = read_experiment(document);
    if (experiment.obstacle && experiment.columns == std::vector<std::string>{"x", "y", "z"}) {
      material_.obstacles.push_back(solid_of(*experiment.obstacle));
    }
    // Alone it shows its holes; beside data, what stands in the way.
    if (material_.signals.empty()) {
      adopt(experiment.columns, file);
      for (const auto* list : {&experiment.holes, &experiment.new_holes}) {
        for (const Hole& hole : *list) material_.goals.push_back({{hole.target, {}, {}, {}}, hole.position, {}, {}});
      }
    }
    found("an experiment", file);
  } else {
    document.root().at("format").fail(
        "plot.unknown_content",
        fmt::format("nothing here that can be drawn: the format is {}; {}", format, drawable_content));
  }
}

}  // namespace lfd::plot
