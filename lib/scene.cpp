#include "lfdtools/scene.hpp"

namespace lfd {

std::vector<Solid> Scene::in_base(const Robot& robot) const {
  std::vector<Solid> solids = obstacles;
  const Pose pose = frame_in_base(robot, frame);
  for (Solid& solid : solids) solid.pose = pose * solid.pose;
  return solids;
}

}  // namespace lfd
