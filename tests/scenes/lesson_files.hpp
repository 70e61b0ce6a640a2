// One scene's lesson as files, for the programs to try it on.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/validation.hpp"
#include "teacher.hpp"

namespace lfd::scenes {

/// Leaves demos.csv (with joints), goals.csv and scene.json in a folder, which is there.
void write_lesson(const std::string& folder, const Task& task, const Teacher& teacher, int branch,
                  const std::vector<TargetDemonstrations>& targets);

}  // namespace lfd::scenes
