// What a figure is made of: the content of the toolchain's files, told by itself and not by their names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lfdtools/io/gmm_file.hpp"
#include "lfdtools/io/input.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/io/message.hpp"
#include "lfdtools/scene.hpp"
#include "lfdtools/skill.hpp"
#include "lfdtools/trajectory.hpp"

namespace lfd::plot {

/// Where a curve comes from, in the order in which they are drawn.
enum class Role {
  demonstration,  ///< rows with a demo
  reference,      ///< rows with the columns goal_<s> of gmr-regress
  motion          ///< other rows with a time: generated motions, intentions, joint paths
};

/// Signals over time, and what is known beside them.
struct Curve {
  Role role = Role::motion;
  Labels labels;
  Trajectory trajectory;       ///< over the signals of the material
  Samples sd;                  ///< T x D, from the columns sd_<s>; empty: there are none
  std::optional<Vector> goal;  ///< D, from the columns goal_<s>
};

/// Predicted weights of one signal for one target.
struct PredictedWeights {
  Labels labels;
  std::string signal;
  Vector basis;  ///< numbers of the bases, from 1
  Vector mean;
  Vector sd;
};

/// Weights of one training row.
struct TrainingWeights {
  std::vector<std::string> columns;  ///< D signals
  Matrix weights;                    ///< D x N
  DmpScaling scaling = DmpScaling::none;
};

/// A row of the leave-one-target-out table.
struct ErrorRow {
  std::string method;
  std::string target;
  Vector values;  ///< of Material::measures, in their unit
};

/// How often bands of a nominal level held what they should.
struct ReliabilityRow {
  std::string method;
  double nominal = 0;    ///< level of the band, 0 to 1
  double pointwise = 0;  ///< share of samples inside
  double path = 0;       ///< share of whole paths inside
  double width = 0;      ///< mean half-width [m]
};

struct Material {
  std::vector<std::string> signals;  ///< D, of curves, goals and mixtures
  std::vector<Curve> curves;         ///< by role, then as read
  std::vector<Goal> goals;
  std::vector<GmmFile> mixtures;
  std::vector<Solid> obstacles;  ///< in the frame base
  std::vector<PredictedWeights> predicted;
  std::vector<TrainingWeights> training;
  std::vector<std::string> measures;  ///< columns of the leave-one-target-out table
  std::vector<ErrorRow> errors;
  std::vector<ReliabilityRow> reliability;
  std::vector<std::string> found;  ///< such as "goals (goals.csv)", for messages
};

struct MaterialOptions {
  std::vector<std::string> columns;  ///< signals, or measures of a leave-one-target-out table; empty: by rule
  bool renumber = false;             ///< later files get new demo numbers
  JsonOptions json;
};

/// Reads everything. Files with the same columns are one table.
/// @throws DataError as the readers of each kind; [plot.unknown_content] for what cannot be drawn, with a list of what
///         can; [plot.columns_differ] if files have different signals
[[nodiscard]] Material read_material(std::vector<Input> inputs, Messages& messages, const MaterialOptions& options);

/// Name of a curve's group in a legend: the target, with the teacher in brackets; empty without both.
[[nodiscard]] std::string series_name(const Labels& labels);

}  // namespace lfd::plot
