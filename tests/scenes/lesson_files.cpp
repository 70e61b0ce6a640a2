#include "lesson_files.hpp"

#include <fmt/format.h>

#include <fstream>

namespace lfd::scenes {

void write_lesson(const std::string& folder, const Task& task, const Teacher& teacher, int branch,
                  const std::vector<TargetDemonstrations>& targets) {
  std::ofstream demos(folder + "/demos.csv");
  demos << "target,demo,t,x,y,z,q1,q2,q3,q4,q5,q6\n";
  for (const auto& target : targets) {
    for (std::size_t k = 0; k < target.demonstrations.size(); ++k) {
      const Trajectory& shown = target.demonstrations[k];
      const auto joints = joints_along(teacher.arm(), task.orientation, branch, shown.positions);
      for (Eigen::Index t = 0; t < shown.samples(); ++t) {
        demos << fmt::format("{},{},{},{},{},{}", *target.labels.target, k + 1, shown.times[t], shown.positions(t, 0),
                             shown.positions(t, 1), shown.positions(t, 2));
        for (int j = 0; j < 6; ++j) demos << fmt::format(",{}", (*joints)(t, j));
        demos << '\n';
      }
    }
  }
  std::ofstream goals(folder + "/goals.csv");
  goals << "target,x,y,z\n";
  for (const auto& hole : task.new_holes) {
    goals << fmt::format("{},{},{},{}\n", hole.target, hole.position[0], hole.position[1], hole.position[2]);
  }
  std::ofstream scene(folder + "/scene.json");
  scene << R"({"format":"lfdtools.scene","version":1,"frame":"base","obstacles":[)";
  std::vector<Solid> solids = task.obstacles;
  solids.insert(solids.end(), task.ground.begin(), task.ground.end());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid& box = solids[i];
    const Quaternion q = quaternion_from_rotation(box.pose.rotation);
    scene << fmt::format(
        R"({}{{"name":"{}","type":"box","pose":{{"position":[{},{},{}],"orientation":[{},{},{},{}]}},"size":[{},{},{}]}})",
        i > 0 ? "," : "", box.name, box.pose.position[0], box.pose.position[1], box.pose.position[2], q[0], q[1], q[2],
        q[3], box.size[0], box.size[1], box.size[2]);
  }
  scene << "]}\n";
}

}  // namespace lfd::scenes
