#include "lesson.hpp"

#include <algorithm>
#include <utility>

namespace lfd::scenes {
namespace {

constexpr double least_shown = 0.005;  // [m]

}  // namespace

std::string teach(const Teacher& teacher, const Task& task, Lesson& lesson) {
  const auto branches = teacher.branches();
  if (branches.empty()) return "no_posture";
  std::vector<Hole> places = task.holes;
  // Round the box of holes, so that each is beside the one before.
  std::reverse(places.begin() + 3, places.end());
  for (const int branch : branches) {
    lesson = {branch, {}, {}};
    for (const Hole& place : places) {
      std::vector<Meant> meant;
      for (std::size_t way = 0; way < task.ways.size(); ++way) {
        const Meant* like = lesson.meant.empty() ? nullptr : &lesson.meant.back()[way];
        const auto path = teacher.plan(place.position, way, branch, like);
        if (!path) break;
        meant.push_back(*path);
      }
      if (meant.size() < task.ways.size()) break;
      lesson.meant.push_back(std::move(meant));
    }
    if (lesson.meant.size() < places.size()) continue;
    std::reverse(lesson.meant.begin() + 3, lesson.meant.end());
    for (const Hole& hole : task.new_holes) {
      lesson.of_new_holes.emplace_back();
      for (std::size_t way = 0; way < task.ways.size(); ++way) {
        lesson.of_new_holes.back().push_back(teacher.plan(hole.position, way, branch, &lesson.meant.front()[way]));
      }
    }
    return {};
  }
  return "no_way_round";
}

std::vector<Trajectory> demonstrate(const Teacher& teacher, const std::vector<Meant>& meant, int branch,
                                    const Random& random) {
  std::vector<Trajectory> shown;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const Random stream = random.split(static_cast<std::uint64_t>(repetition));
    const std::size_t way = static_cast<std::size_t>(stream.split(99).below(meant.size()));
    for (std::uint64_t attempt = 0; attempt < 50; ++attempt) {
      Trajectory one = perform([&](const Vector& phases) { return meant[way].positions(phases); }, seconds, 100,
                               TeacherNoise(), stream.split(attempt));
      const auto least = teacher.clearance(one.positions, branch);
      if (!least || *least < least_shown) continue;
      shown.push_back(std::move(one));
      break;
    }
  }
  return shown;
}

}  // namespace lfd::scenes
