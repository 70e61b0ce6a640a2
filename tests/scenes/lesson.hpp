// What a teacher means and shows in one scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "teacher.hpp"

namespace lfd::scenes {

inline constexpr double margin = 0.05;  ///< of the whole arm on the way that is meant [m]
inline constexpr double seconds = 3;    ///< of motions, on average
inline constexpr int repetitions = 10;  ///< demonstrations a hole

/// What the teacher means at each hole, by hole and way, and the arm's branch meanwhile.
struct Lesson {
  int branch = 0;
  std::vector<std::vector<Meant>> meant;                        // of holes, by way
  std::vector<std::vector<std::optional<Meant>>> of_new_holes;  // nothing where the teacher finds no way either
};

/// Plans the way to every hole. @return a reason why there is no lesson, or nothing
[[nodiscard]] std::string teach(const Teacher& teacher, const Task& task, Lesson& lesson);

/// The demonstrations of one hole: each takes one of the ways, with a person's noise, and keeps the whole arm 5 mm
/// clear; a draw that does not is drawn again, fifty times at most.
/// @param meant  by way
[[nodiscard]] std::vector<Trajectory> demonstrate(const Teacher& teacher, const std::vector<Meant>& meant, int branch,
                                                  const Random& random);

}  // namespace lfd::scenes
