// How far every link of the arm stays from what stands around it, and from the arm itself.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lfdtools/dh.hpp"
#include "lfdtools/solid_distance.hpp"

namespace lfd {

/// One link and the body nearest to it.
struct LinkClearance {
  int link = 0;                       ///< index into bodies()
  int obstacle = 0;                   ///< index into solids(), or solids().size() + the index of another link
  double distance = 0.0;              ///< signed [m]
  Vector3 point = Vector3::Zero();    ///< on the link's axis, in the base [m]
  Vector3 normal = Vector3::UnitZ();  ///< unit, along which the distance grows as `point` moves
};

/// How far two bodies are apart along a direction that stays as it is.
struct Gap {
  double distance = 0.0;          ///< [m]
  Joints slope = Joints::Zero();  ///< its derivative by the joints [m/rad]
};

/// A tool as one more link: a capsule from the flange to the tool tip, called "tool".
/// @param tool  pose of the tip in the flange frame   @param radius  [m]
[[nodiscard]] Capsule tool_capsule(const Pose& tool, double radius);

/// An arm among solids.
///
/// Links of frame 0 never move: they are bodies that other links may touch, and do not count against the solids. A
/// solid that they overlap is what the arm stands on; links of frame 1, which only turn on the spot, do not count
/// against it. Of the arm itself, pairs whose frames are the same or neighbours are left aside: they meet at a joint,
/// where their capsules always overlap.
class ArmClearance {
 public:
  /// @param solids_in_base  as Scene::in_base gives them   @param tool  one more link
  /// @throws ConfigError as check(robot); [robot.no_links] if no link moves
  ArmClearance(Robot robot, std::vector<Solid> solids_in_base, const std::optional<Capsule>& tool = {});

  [[nodiscard]] const Robot& robot() const { return robot_; }
  /// The links, the tool last.
  [[nodiscard]] const std::vector<Capsule>& bodies() const { return robot_.links; }
  [[nodiscard]] const std::vector<Solid>& solids() const { return solids_; }
  /// Name of LinkClearance::obstacle; a solid without a name is called by its number, from 1.
  [[nodiscard]] std::string obstacle_name(int obstacle) const;

  /// Every link that counts and its closest solid; empty without solids. @param q  [rad]
  [[nodiscard]] std::vector<LinkClearance> links(const Joints& q) const;
  /// Every link that counts with every solid.
  [[nodiscard]] std::vector<LinkClearance> pairs(const Joints& q) const;
  /// Every pair of links that is not left aside; `link` is the one further along the arm.
  [[nodiscard]] std::vector<LinkClearance> pairs_of_arm_itself(const Joints& q) const;

  /// Whether any of the pairs is no further apart than `margin`. They may have been measured at other joints, best near
  /// these: the plane that parted two bodies there shows of most, without their distance, that they are further.
  /// @param margin  [m]   @param frames  as joint_frames gives them
  [[nodiscard]] bool any_closer(const std::vector<LinkClearance>& pairs, double margin,
                                const std::array<Pose, 7>& frames) const;
  /// The gaps of a pair along its normal: of each end of the link's axis from the solid, or from each end of the other
  /// link. All bodies being convex, none of the distances at other joints is under the least gap there; where the pair
  /// was measured the least gap is its distance.
  [[nodiscard]] std::vector<Gap> gaps(const LinkClearance& pair, const std::array<Pose, 7>& frames) const;

  /// Least distance of all pairs(q); infinite without solids.
  [[nodiscard]] double least(const Joints& q) const;
  /// Least distance of all pairs_of_arm_itself(q).
  [[nodiscard]] double least_of_arm_itself(const Joints& q) const;

  /// No point of the arm moves further than this while each joint moves by at most `range` from q [m].
  /// @param range  [rad], not negative
  [[nodiscard]] double furthest_motion(const Joints& q, const Joints& range) const;

 private:
  [[nodiscard]] double distance(const LinkClearance& pair, const std::array<Pose, 7>& frames) const;
  [[nodiscard]] bool counts(const Capsule& body, std::size_t solid) const {
    return body.frame > 1 || (body.frame == 1 && !stood_on_[solid]);
  }

  Robot robot_;
  std::vector<Solid> solids_;
  std::vector<bool> stood_on_;                  // solids that overlap links of frame 0
  std::vector<std::pair<int, int>> own_pairs_;  // further along the arm, nearer to the base
};

/// Where a joint path comes closest.
struct ClosestApproach {
  double distance = 0.0;    ///< [m], infinite without anything to touch
  Eigen::Index sample = 0;  ///< at this sample, or on the way from it to the next
  double share = 0.0;       ///< of that way, in [0, 1)
  LinkClearance pair;       ///< which link, which obstacle
  bool complete = true;     ///< false: joints move so far between samples that not all of the way was searched
};

/// The least distance from the solids along a joint path, every joint going straight from sample to sample: also an
/// obstacle thinner than a step is found. Intervals are halved until no point of the arm can come more than `tolerance`
/// closer than the least distance found, but not over 40 times, nor over 10^6 + 10^3 T times in all: joints that go
/// round thousands of times between two samples have an end too.
/// @param joints  T x 6 [rad], T >= 1   @param tolerance  over 0 [m]
/// @throws DataError [clearance.shape], [clearance.not_finite]
[[nodiscard]] ClosestApproach closest_approach(const ArmClearance& arm, const Samples& joints, double tolerance = 1e-3);

/// The same of the arm's own pairs.
[[nodiscard]] ClosestApproach closest_approach_of_arm_itself(const ArmClearance& arm, const Samples& joints,
                                                             double tolerance = 1e-3);

}  // namespace lfd
