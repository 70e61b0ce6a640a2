// What becomes of a hand path in a scene: joint path, whole-arm clearance by FCL, figures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lfdtools/path.hpp"
#include "task.hpp"

namespace lfd::scenes {

enum class Outcome { clear, collided, refused };

struct Verdict {
  Outcome outcome = Outcome::refused;
  std::string reason;       ///< of a refusal: the gate of ur10-ik
  double clearance = 0;     ///< least distance of the arm to the obstacles [m]; 0 when refused
  double hand_length = 0;   ///< [m]
  double joint_length = 0;  ///< sum over samples of the Euclidean joint step [rad]
  Samples joints;           ///< of the path; rows may lie between its samples
  double jerk = 0;          ///< of the hand over 3 s, root mean square [m/s^3]
};

/// Links and obstacles as FCL bodies. Distances owe nothing to lfdtools/solid_distance.hpp, by which the teacher kept
/// clear.
class FclScene {
 public:
  /// @param ground  what the arm stands on: links of frames 0 and 1 do not count against it
  FclScene(const Robot& robot, const std::vector<Solid>& obstacles, const std::vector<Solid>& ground);
  ~FclScene();

  /// Least signed distance at these joints of any link to any obstacle or to another link, whose frames are not
  /// neighbours [m]; FCL's penetration depth where they overlap.
  [[nodiscard]] double distance(const Joints& q) const;

 private:
  struct Bodies;
  Robot robot_;
  std::unique_ptr<Bodies> bodies_;
};

/// Judges a hand path as ur10-ik would with its gates, started where the demonstrations started (their branch): poses
/// out of reach, joint steps over 0.5 rad, another branch, joint speed over a path of `seconds`, condition number over
/// 30 refuse it. Then FCL judges joints at the samples and midway between any two (a hand moves by 2 mm).
[[nodiscard]] Verdict judge(const InverseKinematics& arm, const FclScene& scene, const Matrix3& orientation,
                            const Samples& path, const Joints& demonstrated_start, int branch, double seconds);

/// FCL's verdict on a joint path alone: its least distance [m].
/// @param between  looks at so many joints an interval, the last of which is the next sample
[[nodiscard]] double least_distance(const FclScene& scene, const Samples& joints, int between = 2);

}  // namespace lfd::scenes
