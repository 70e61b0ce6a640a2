#include "lfdtools/methods.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/affine.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/gpr.hpp"
#include "lfdtools/kmp.hpp"
#include "lfdtools/opponents.hpp"
#include "lfdtools/promp.hpp"
#include "lfdtools/skill_method.hpp"

namespace lfd {

const std::vector<Method>& methods() {
  constexpr Needs paths{};
  constexpr Needs primitives{.primitives = true};
  constexpr Needs paper{.paper = true};
  static const std::vector<Method> all = {
      {"skill", "the default skill", false, primitives, skill_method(SkillStructure::automatic)},
      {"skill-axis", "one model an axis from its own component of dP", false, primitives,
       skill_method(SkillStructure::axis)},
      {"skill-full", "one model an axis from all of dP", false, primitives, skill_method(SkillStructure::full),
       "skill"},
      {"skill-joint", "one model for all axes", false, primitives, skill_method(SkillStructure::joint)},
      {"skill-student-t", "the default skill with a Student-t process", false, primitives,
       skill_method(SkillStructure::automatic, ProcessType::student_t)},
      {"paper", "--paper on dmp-fit and mvgpr-train: one model an axis (Sec. III-C)", false, paper,
       paper_method(SkillStructure::axis)},
      {"paper-full", "--paper with all of dP as input (Table 1)", false, paper, paper_method(SkillStructure::full)},
      {"line", "straight minimum-jerk line", true, paths, train_line},
      {"nearest", "weights of the target with the nearest dP", true, primitives, train_nearest},
      {"nearest-deviation", "deviation from the straight line of that target", true, paths, train_nearest_deviation},
      {"mean", "mean weights of all targets", true, primitives, train_mean},
      {"mean-deviation", "mean deviation from the straight line", true, paths, train_mean_deviation},
      {"moved-goal", "one primitive, of the nearest target, scaled with its goal, eq. (12)", false, paths,
       train_moved_goal},
      {"affine", "weights affine in dP, least squares on all rows", true, primitives, train_affine},
      {"affine-means", "the same on one mean a target", true, primitives, train_affine_means},
      {"affine-prior", "deviation affine in dP, all rows, prior on the slopes by evidence", true, paths,
       train_affine_prior},
      {"affine-ends", "the same in start and goal", true, paths, train_affine_ends},
      {"gpr", "an independent Gaussian process a weight (Forte et al. 2012)", false, primitives, train_gpr},
      {"promp", "probabilistic movement primitives conditioned on start and goal", false, paths, train_promp},
      {"kmp", "kernelized movement primitives in the frames of start and goal", false, paths, train_kmp},
  };
  return all;
}

std::vector<const Method*> chosen_methods(const std::vector<std::string>& names) {
  std::vector<const Method*> chosen;
  if (names.empty()) {
    for (const auto& method : methods()) chosen.push_back(&method);
  }
  for (const auto& name : names) {
    const auto found =
        std::find_if(methods().begin(), methods().end(), [&](const Method& method) { return method.name == name; });
    if (found == methods().end()) {
      std::string known;
      for (const auto& method : methods()) known += (known.empty() ? "" : ", ") + method.name;
      throw UsageError("validation.method", fmt::format("there is no method '{}'; methods: {}", name, known));
    }
    chosen.push_back(&*found);
  }
  return chosen;
}

}  // namespace lfd
