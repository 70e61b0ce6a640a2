// Learning a skill: which processes see what, and how they are fitted to rows. Paper Table 1, steps 1 and 2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lfdtools/skill.hpp"

namespace lfd {

/// Which components of dP speak for which weights.
enum class SkillStructure {
  automatic,  ///< the library's choice: `full`
  axis,       ///< one model an axis from its own component, R -> R^N (Sec. III-C of the paper)
  full,       ///< one model an axis from all of dP, R^D -> R^N (Table 1 of the paper); but for the paper's process, one
              ///< kernel for all axes, each with an Omega of its own
  joint       ///< one model for all axes, R^D -> R^(D N)
};

/// What the processes see of a reach.
enum class SkillInputs {
  automatic,        ///< `change_and_start` where two rows start over 20 mm apart and the process is not the paper's
  change,           ///< dP alone: the paper's
  change_and_start  ///< dP, and start - mean start: a hand that starts elsewhere comes back to its usual way
};

/// Covariance functions to choose from.
enum class SkillKernel {
  automatic,  ///< `sum`; with SkillOptions::paper `se_ard`
  sum,        ///< constant + linear + matern32 an input + se-ard over dP
  additive,   ///< the same without the last term: each input acts for itself
  se_ard,     ///< one term over all inputs, as the others below
  matern32,
  matern52
};

/// Mean functions of the process.
enum class SkillMean {
  automatic,  ///< `line`; with SkillOptions::paper `zero`
  zero,       ///< the motion of the spring alone
  constant,
  linear,
  line  ///< known beforehand: the weights of the straight minimum-jerk motion, proportional to dP
};

/// What is done about the tempo of a target's rows.
enum class SkillTempo {
  automatic,  ///< `shared`; `own` with SkillOptions::paper and with primitives of scaling goal
  own,        ///< rows as they are
  shared      ///< drawn towards the tempo of all targets (tempo.hpp: with_shared_tempo)
};

/// Whether motions are learnt as somebody's.
enum class SkillTeachers {
  automatic,  ///< `apart` where the rows name two teachers or more, with kernels `sum` and `additive` without an
              ///< estimated mean; else `together`
  together,   ///< as if one had demonstrated all
  apart       ///< what all share, and on top of it a constant and a linear term that are a teacher's own
};

struct SkillOptions {
  SkillStructure structure = SkillStructure::automatic;
  /// The published process: se-ard kernel, zero mean, plain weights, no priors. Structure `automatic` then means
  /// `axis`.
  bool paper = false;
  SkillInputs inputs = SkillInputs::automatic;
  SkillKernel kernel = SkillKernel::automatic;
  SkillMean mean = SkillMean::automatic;
  SkillTempo tempo = SkillTempo::automatic;
  SkillTeachers teachers = SkillTeachers::automatic;
  OmegaRule omega = OmegaRule::integrated;
  ProcessType process = ProcessType::gaussian;
  int starts = 5;
  std::uint64_t seed = 1;
  unsigned jobs = 1;
  /// Kernels, noise, nu and inputs of this skill are taken as they are, nothing is searched for.
  const Skill* hyperparameters = nullptr;
};

/// Learns weights as a function of dP from rows that share their settings. Hyperparameters are those of maximum
/// evidence times priors; but for the paper's process, with the evidence to the power (targets / rows, the targets of
/// each teacher counted apart), because rows of a target share what sets it apart and are not the independent witnesses
/// that the process takes them for. Durations always are learnt so.
/// @param columns  D signal names, as the rows' axes
/// @throws DataError [skill.too_few_rows], [skill.mixed_settings], [skill.one_target] if every row names the same
///         target or every dP is the same; [skill.tempo] if a shared tempo is asked for where there is none; UsageError
///         [skill.teachers]; those of train_mvgp
[[nodiscard]] Skill train_skill(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
                                const SkillOptions& options = {});

/// The kernel to learn with. SkillKernel::automatic without the paper's process: of `sum` and `additive` the one that
/// misses less on targets left out (left_out_residuals), `sum` under four targets: few targets cannot
/// say by evidence whether inputs act together. Any other: as it is.
/// @throws those of train_skill
[[nodiscard]] SkillKernel choose_kernel(const std::vector<std::string>& columns, const std::vector<SkillRow>& rows,
                                        const SkillOptions& options);

/// Whether rows can make a skill: at least two, which do not all name one target, and whose dP differ.
[[nodiscard]] bool is_trainable(const std::vector<SkillRow>& rows);

/// A, N x N lower triangular, so that the Euclidean distance of rows w A is the root mean square distance [m] over one
/// duration of the motions that weights w of one axis make (scale 1): A A^T = R^T R / T, with a floor of 1e-6 of the
/// largest singular value of R so that directions which hardly move the hand keep an inverse.
[[nodiscard]] Matrix trajectory_metric(const DmpSettings& settings);

/// Weights of the straight minimum-jerk motion from 0 to 1 on one axis, N: a motion by dP has dP times them (scaling
/// none), or them as they are (scaling goal).
[[nodiscard]] Vector line_weights(const DmpSettings& settings);

}  // namespace lfd
