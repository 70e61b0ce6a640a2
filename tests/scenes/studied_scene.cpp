#include "studied_scene.hpp"

#include <fmt/format.h>

namespace lfd::scenes {

StudiedScene::StudiedScene(bool two_ways, int number, const Robot& robot, const Random& random)
    : number_(number),
      task_(draw_task(two_ways, random)),
      teacher_(robot, task_, margin),
      fcl_(robot, task_.obstacles, task_.ground) {}

std::optional<Samples> StudiedScene::joints_of(const Samples& path) const {
  return joints_along(arm(), task_.orientation, lesson_.branch, path);
}

Joints StudiedScene::joints_at(const Vector3& position) const {
  return joints_of(position.transpose())->row(0).transpose();
}

void StudiedScene::set_aside(const std::string& reason) const {
  fmt::print("{},{},,,set_aside,{},,,,,,,\n", number_, task_.ways.size(), reason);
}

void StudiedScene::row(const std::string& method, const std::string& target, const Verdict& verdict, double outside,
                       double taken, const std::string& probability) const {
  const char* words[] = {"clear", "collided", "refused"};
  fmt::print("{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f},{:.6f},{}\n", number_, task_.ways.size(), method,
             target, words[static_cast<int>(verdict.outcome)], verdict.reason, verdict.clearance, outside,
             verdict.hand_length, verdict.joint_length, verdict.jerk, taken, probability);
}

}  // namespace lfd::scenes
