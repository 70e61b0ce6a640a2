// A skill that the tests of its posterior share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/posterior.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/skill_train.hpp"

namespace lfd {

inline const std::vector<std::string> xyz = {"x", "y", "z"};

inline Vector vec(double x, double y, double z) {
  Vector v(3);
  v << x, y, z;
  return v;
}

/// Two demonstrations of each of nine targets, with a bump that bends with the goal, and a wander of their own.
inline SkillPredictor some_skill(SkillStructure structure, DmpScaling scaling = DmpScaling::none) {
  Random random(3);
  std::vector<SkillRow> rows;
  const Vector phases = linspace(0, 1, 120);
  for (const double x : {0.2, 0.3, 0.4}) {
    for (const double y : {-0.2, 0.15, 0.3}) {
      for (int demo = 0; demo < 2; ++demo) {
        const Vector goal = vec(x, y, 0.3 - 0.5 * x * y);
        Matrix wander(6, 3);  // of each half-wave and axis [m]
        for (double& value : wander.reshaped()) value = 0.006 * random.normal();
        Samples path(120, 3);
        for (Eigen::Index i = 0; i < 120; ++i) {
          const double s = phases[i];
          const double bump = 64 * std::pow(s * (1 - s), 3);
          path.row(i) = (s * s * s * (10 - 15 * s + 6 * s * s)) * goal.transpose();
          path(i, 2) += bump * (0.05 + x * x);
          path(i, 0) -= bump * 0.1 * y;
          for (Eigen::Index k = 0; k < 6; ++k) {
            path.row(i) += std::sin(3.141592653589793 * static_cast<double>(k + 1) * s) * wander.row(k);
          }
        }
        DmpFitOptions fit;
        fit.bases = 8;
        fit.scaling = scaling;
        rows.push_back(
            {{std::to_string(rows.size() / 2 + 1), {}, std::to_string(demo), {}}, fit_dmp({phases * 2.0, path}, fit)});
      }
    }
  }
  SkillOptions options;
  options.structure = structure;
  options.starts = 2;
  options.kernel = SkillKernel::sum;  // smooth, so that differences mean derivatives
  return SkillPredictor(train_skill(xyz, rows, options));
}

inline const SkillPredictor& full() {
  static const SkillPredictor predictor = some_skill(SkillStructure::full);
  return predictor;
}
inline const SkillPredictor& joint() {
  static const SkillPredictor predictor = some_skill(SkillStructure::joint);
  return predictor;
}
inline const SkillPredictor& scaled() {
  static const SkillPredictor predictor = some_skill(SkillStructure::full, DmpScaling::goal);
  return predictor;
}

inline Goal some_goal(double tau = 2.0) {
  return {{}, vec(0.33, 0.1, 0.27), {}, tau};
}

inline Samples positions(const MotionPosterior& posterior, const Vector& times) {
  return rollout(posterior.course, times).positions;
}

/// A via through the mean moved by `offset` at t = 0.9.
inline Waypoint via_beside(const SkillPredictor& predictor, const Vector& offset, double sd = 0) {
  Vector at(1);
  at << 0.9;
  return {0.9, positions(predict_motion(predictor, some_goal()), at).row(0).transpose() + offset, sd};
}

inline double distance(const Matrix& a, const Matrix& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace lfd
