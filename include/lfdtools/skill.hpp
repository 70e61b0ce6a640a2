// A skill: movement primitives whose weights follow the target, paper Table 1 and Sec. III-C.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lfdtools/dmp.hpp"
#include "lfdtools/mvgp.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd {

/// One training row: a primitive and where it comes from.
struct SkillRow {
  Labels labels;
  Dmp primitive;

  /// Input of the process: dP = goal - start, D [m].
  [[nodiscard]] Vector change() const { return primitive.goal - primitive.start; }
};

/// Where a motion leads, as the processes see it.
struct Reach {
  Vector change;     ///< dP = goal - start, D [m]
  Vector offset;     ///< start - Skill::start, D [m]; empty: zero
  int teacher = -1;  ///< teacher_number of whose motion it is; -1: nobody's who is known

  // NOLINTNEXTLINE(google-explicit-constructor): a change alone says where, from the usual start.
  Reach(Vector dP, Vector start_offset = {}) : change(std::move(dP)), offset(std::move(start_offset)) {}
};

/// One process of a skill. Columns of its Y: by signal in `outputs`, then by basis.
struct SkillModel {
  std::vector<int>
      inputs;  ///< from 0: signals j whose change it sees; D + j: whose start it sees; 2 D: the teacher's number
  std::vector<int> outputs;  ///< signals whose weights it gives, from 0
  MvgpModel process;
};

/// tau = mean + coefficients . dP, kept inside `range`.
struct DurationModel {
  double mean = 1;           ///< at dP = 0 [s]
  Vector coefficients;       ///< D [s/m]
  double sd = 0;             ///< of a demonstration about the line [s]
  double range[2] = {1, 1};  ///< shortest and longest demonstrated [s]

  [[nodiscard]] double predict(const Vector& change) const;
};

/// What leaving targets out says of a skill's uncertainty (calibration.hpp: `calibrate`).
struct Calibration {
  int targets = 0;         ///< left out in turn
  Vector target_variance;  ///< D, of what sets a target apart on each axis, relative to its Omega as the kernel is
  Vector reproduction;     ///< D, root mean square distance of the rows' primitives from their recordings [m]
  Vector levels;           ///< L shares, rising
  Vector pointwise;        ///< L factors on the sd that hold these shares of samples
  Vector path;             ///< L factors that hold whole paths of these shares of targets
};

/// Distance of two starts from which on a goal needs its own start, and a process an eye for it [m].
inline constexpr double start_tolerance = 0.02;

struct Skill {
  std::vector<std::string> columns;  ///< D signal names
  DmpSettings dmp;
  Vector start;              ///< mean start of the rows, D [m]
  double start_spread = 0;   ///< largest distance between the starts of two rows [m]
  std::vector<Labels> rows;  ///< n
  DurationModel duration;
  std::vector<SkillModel> models;
  std::optional<Calibration> calibration;  ///< empty: not calibrated
};

/// Positions of the rows of each target, whoever demonstrated, by first appearance. A row that names no target is one
/// of its own.
[[nodiscard]] std::vector<std::vector<std::size_t>> target_groups(const std::vector<Labels>& rows);

/// The same of each target and teacher: rows that differ by chance alone.
[[nodiscard]] std::vector<std::vector<std::size_t>> repetition_groups(const std::vector<Labels>& rows);

[[nodiscard]] std::vector<Labels> labels_of(const std::vector<SkillRow>& rows);

/// The rows whose positions are not among those of `left_out`.
[[nodiscard]] std::vector<SkillRow> without(const std::vector<SkillRow>& rows,
                                            const std::vector<std::size_t>& left_out);

/// What is left of each row when its target is left out and predicted from the others with the skill's own
/// hyperparameters, n x (D N): by signal, then by basis, in the metric of each model.
[[nodiscard]] Matrix left_out_residuals(const Skill& skill);

/// Whether the processes see the start as well.
[[nodiscard]] bool sees_starts(const Skill& skill);

/// Whether the processes tell teachers apart.
[[nodiscard]] bool sees_teachers(const Skill& skill);

/// Number of a teacher, from 0 in the order in which rows first name them (no name is one too); -1: named by no row.
[[nodiscard]] int teacher_number(const std::vector<Labels>& rows, const std::optional<std::string>& teacher);

/// What a model sees of a reach, p [m]; the teacher's number has no unit.
[[nodiscard]] Vector inputs_of(const SkillModel& model, const Reach& reach);

/// The demonstrated region: for each input of the models (goal - start of each signal, and where they see it the start)
/// the interval that the rows span, widened at both ends by a tenth of its length and at least 10 mm; and the same
/// along each principal direction of dP in which the rows span under a tenth of what they span in the first, so that
/// rows on a line or a plane in any direction show nothing beside it.
/// @return how far a reach lies outside, the largest over the inputs and directions [m]; 0 inside
[[nodiscard]] double region_excess(const Skill& skill, const Reach& reach);

/// Weights for one target.
struct WeightPrediction {
  Matrix mean;  ///< D x N
  Matrix sd;    ///< D x N, latent: of the intention, without the noise of a demonstration
};

/// Where to go.
struct Goal {
  Labels labels;
  Vector position;                 ///< D [m]
  std::optional<Vector> start;     ///< D [m]; the skill's own if empty
  std::optional<double> duration;  ///< tau [s]; the skill's own if empty
  Matrix covariance = {};          ///< how sure the position is, D x D [m^2]; empty: exactly known
};

/// Predictions of one skill; the matrices are factorised once.
class SkillPredictor {
 public:
  explicit SkillPredictor(Skill skill);

  [[nodiscard]] const Skill& skill() const { return skill_; }
  /// One a model.
  [[nodiscard]] const std::vector<MvgpPredictor>& processes() const { return predictors_; }
  [[nodiscard]] WeightPrediction weights(const Reach& reach) const;
  /// What the processes see of a goal.
  [[nodiscard]] Reach reach(const Goal& goal) const;
  /// The primitive for a goal: predicted weights, goal, start and duration (Table 1, step 3). Rows fitted by
  /// `trajectory` all meet the condition y(tau) = g, which is linear in the weights, so predictions mixed from them
  /// meet it too.
  [[nodiscard]] Dmp primitive(const Goal& goal) const;

 private:
  Skill skill_;
  std::vector<MvgpPredictor> predictors_;
};

/// The motion of a primitive on times 0, dt, 2 dt, ... tau and on until it rests on its goal (settle_time). The last
/// sample is the first of the grid that rests.
/// @param dt  [s]; tau / 200 if empty
/// @throws DataError [skill.dt] if that makes over 10^7 samples; those of settle_time
[[nodiscard]] Motion generate(const Dmp& primitive, std::optional<double> dt = {});

}  // namespace lfd
