#include "lfdtools/scene.hpp"

namespace lfd {

std::vector<Solid> Scene::in_base() const {
  std::vector<Solid> solids = obstacles;
  if (frame != "base_link") return solids;
  Pose turn;
  turn.rotation.diagonal() << -1.0, -1.0, 1.0;
  for (Solid& solid : solids) solid.pose = turn * solid.pose;
  return solids;
}

}  // namespace lfd
