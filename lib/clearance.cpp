#include "lfdtools/clearance.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "lfdtools/error.hpp"

namespace lfd {
namespace {

constexpr double nothing_near = std::numeric_limits<double>::infinity();

using Frames = std::array<Pose, 7>;

const Pose& frame_of(const Capsule& body, const Frames& frames) {
  return frames[static_cast<std::size_t>(body.frame)];
}

Segment axis_of(const Capsule& body, const Frames& frames) {
  const Pose& frame = frame_of(body, frames);
  return {frame.rotation * body.from + frame.position, frame.rotation * body.to + frame.position};
}

LinkClearance clearance(std::size_t link, std::size_t obstacle, const Separation& s) {
  return {static_cast<int>(link), static_cast<int>(obstacle), s.distance, s.point, s.normal};
}

/// How far the solid of a pair reaches along its normal, from the origin of the base.
double reach_of_solid(const LinkClearance& pair, const Capsule& body) {
  return pair.normal.dot(pair.point) - body.radius - pair.distance;
}

bool nearer(const LinkClearance& a, const LinkClearance& b) {
  return a.distance < b.distance;
}

}  // namespace

Capsule tool_capsule(const Pose& tool, double radius) {
  return {"tool", 6, Vector3::Zero(), tool.position, radius};
}

ArmClearance::ArmClearance(Robot robot, std::vector<Solid> solids_in_base, const std::optional<Capsule>& tool)
    : robot_(std::move(robot)), solids_(std::move(solids_in_base)) {
  if (std::none_of(robot_.links.begin(), robot_.links.end(), [](const Capsule& body) { return body.frame > 0; })) {
    throw ConfigError("robot.no_links", fmt::format("robot {} has no links that move", robot_.name),
                      {.pointer = "/links"});
  }
  if (tool) robot_.links.push_back(*tool);
  check(robot_);
  for (const Solid& solid : solids_) {
    stood_on_.push_back(std::any_of(bodies().begin(), bodies().end(), [&](const Capsule& body) {
      return body.frame == 0 && separation({body.from, body.to}, body.radius, solid).distance < 0;
    }));
  }
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    for (std::size_t j = 0; j < bodies().size(); ++j) {
      if (bodies()[i].frame - bodies()[j].frame > 1) own_pairs_.emplace_back(i, j);
    }
  }
}

std::string ArmClearance::obstacle_name(int obstacle) const {
  const auto i = static_cast<std::size_t>(obstacle);
  if (i >= solids_.size()) return bodies()[i - solids_.size()].name;
  return solids_[i].called(i);
}

std::vector<LinkClearance> ArmClearance::pairs(const Joints& q) const {
  const Frames frames = joint_frames(robot_, q);
  std::vector<LinkClearance> all;
  for (std::size_t i = 0; i < bodies().size(); ++i) {
    const Segment axis = axis_of(bodies()[i], frames);
    for (std::size_t k = 0; k < solids_.size(); ++k) {
      if (!counts(bodies()[i], k)) continue;
      all.push_back(clearance(i, k, separation(axis, bodies()[i].radius, solids_[k])));
    }
  }
  return all;
}

std::vector<LinkClearance> ArmClearance::links(const Joints& q) const {
  std::vector<LinkClearance> closest;
  for (const LinkClearance& pair : pairs(q)) {
    if (closest.empty() || closest.back().link != pair.link) {
      closest.push_back(pair);
    } else if (nearer(pair, closest.back())) {
      closest.back() = pair;
    }
  }
  return closest;
}

std::vector<LinkClearance> ArmClearance::pairs_of_arm_itself(const Joints& q) const {
  const Frames frames = joint_frames(robot_, q);
  std::vector<LinkClearance> all;
  for (const auto& [i, j] : own_pairs_) {
    const auto far = static_cast<std::size_t>(i), near = static_cast<std::size_t>(j);
    const Capsule &a = bodies()[far], &b = bodies()[near];
    all.push_back(
        clearance(far, solids_.size() + near, separation(axis_of(a, frames), a.radius, axis_of(b, frames), b.radius)));
  }
  return all;
}

double ArmClearance::distance(const LinkClearance& pair, const Frames& frames) const {
  const Capsule& body = bodies()[static_cast<std::size_t>(pair.link)];
  const auto obstacle = static_cast<std::size_t>(pair.obstacle);
  const Segment axis = axis_of(body, frames);
  if (obstacle < solids_.size()) return separation(axis, body.radius, solids_[obstacle]).distance;
  const Capsule& other = bodies()[obstacle - solids_.size()];
  return separation(axis, body.radius, axis_of(other, frames), other.radius).distance;
}

bool ArmClearance::any_closer(const std::vector<LinkClearance>& pairs, double margin, const Frames& frames) const {
  std::vector<Segment> axes;
  axes.reserve(bodies().size());
  for (const Capsule& body : bodies()) axes.push_back(axis_of(body, frames));
  // The least of gaps().
  const auto least_gap = [&](const LinkClearance& pair) {
    const auto link = static_cast<std::size_t>(pair.link), obstacle = static_cast<std::size_t>(pair.obstacle);
    const Capsule& body = bodies()[link];
    const double near = std::min(pair.normal.dot(axes[link].from), pair.normal.dot(axes[link].to)) - body.radius;
    if (obstacle < solids_.size()) return near - reach_of_solid(pair, body);
    const Segment& line = axes[obstacle - solids_.size()];
    return near - std::max(pair.normal.dot(line.from), pair.normal.dot(line.to)) -
           bodies()[obstacle - solids_.size()].radius;
  };
  return std::any_of(pairs.begin(), pairs.end(), [&](const LinkClearance& pair) {
    return least_gap(pair) <= margin && distance(pair, frames) <= margin;
  });
}

std::vector<Gap> ArmClearance::gaps(const LinkClearance& pair, const Frames& frames) const {
  const auto ends_of = [&](const Capsule& body) {
    const Segment axis = axis_of(body, frames);
    return body.from == body.to ? std::vector<Vector3>{axis.from} : std::vector<Vector3>{axis.from, axis.to};
  };
  // How a point that moves with a frame goes along the normal.
  const auto slope = [&](const Vector3& point, int frame) {
    Joints along = Joints::Zero();
    for (int j = 0; j < frame; ++j) {
      const Pose& joint = frames[static_cast<std::size_t>(j)];
      along[j] = pair.normal.dot(joint.rotation.col(2).cross(point - joint.position));
    }
    return along;
  };
  const Capsule& body = bodies()[static_cast<std::size_t>(pair.link)];
  const auto obstacle = static_cast<std::size_t>(pair.obstacle);
  std::vector<Gap> gaps;
  for (const Vector3& end : ends_of(body)) {
    const Gap near{pair.normal.dot(end) - body.radius, slope(end, body.frame)};
    if (obstacle < solids_.size()) {
      gaps.push_back({near.distance - reach_of_solid(pair, body), near.slope});
      continue;
    }
    const Capsule& other = bodies()[obstacle - solids_.size()];
    for (const Vector3& far : ends_of(other)) {
      gaps.push_back({near.distance - pair.normal.dot(far) - other.radius, near.slope - slope(far, other.frame)});
    }
  }
  return gaps;
}

double ArmClearance::least(const Joints& q) const {
  const Frames frames = joint_frames(robot_, q);
  double least = nothing_near;
  for (const Capsule& body : bodies()) {
    if (body.frame == 0) continue;
    const Segment axis = axis_of(body, frames);
    for (std::size_t k = 0; k < solids_.size(); ++k) {
      if (counts(body, k)) least = std::min(least, separation(axis, body.radius, solids_[k]).distance);
    }
  }
  return least;
}

double ArmClearance::least_of_arm_itself(const Joints& q) const {
  const Frames frames = joint_frames(robot_, q);
  double least = nothing_near;
  for (const auto& [i, j] : own_pairs_) {
    const Capsule &a = bodies()[static_cast<std::size_t>(i)], &b = bodies()[static_cast<std::size_t>(j)];
    least = std::min(least, separation(axis_of(a, frames), a.radius, axis_of(b, frames), b.radius).distance);
  }
  return least;
}

double ArmClearance::furthest_motion(const Joints& q, const Joints& range) const {
  const Frames frames = joint_frames(robot_, q);
  double moved = 0.0;
  // From the last joint to the first: when joint j turns, its axis stands as at q, and what it carries is at most as
  // far from it as at q plus what the joints beyond have moved it.
  for (int j = 5; j >= 0; --j) {
    const Pose& frame = frames[static_cast<std::size_t>(j)];
    const Vector3 z = frame.rotation.col(2);
    double reach = 0.0;
    for (const Capsule& body : bodies()) {
      if (body.frame <= j) continue;
      const Segment axis = axis_of(body, frames);
      for (const Vector3& end : {axis.from, axis.to}) {
        reach = std::max(reach, z.cross(end - frame.position).norm() + body.radius);
      }
    }
    moved += range[j] * (reach + moved);
  }
  return moved;
}

namespace {

class Search {
 public:
  static constexpr int most_halvings = 40;

  Search(const ArmClearance& arm, Eigen::Index samples, double tolerance, bool self)
      : arm_(arm), tolerance_(tolerance), self_(self), halvings_(1'000'000 + 1000 * samples) {}

  double look_at(const Joints& q, Eigen::Index sample, double share) {
    const double d = self_ ? arm_.least_of_arm_itself(q) : arm_.least(q);
    if (d < best_.distance) {
      best_.distance = d;
      best_.sample = sample;
      best_.share = share;
      at_ = q;
    }
    return d;
  }

  void look_between(const Joints& from, const Joints& to, Eigen::Index sample, double low, double high,
                    int halvings = 0) {
    const Joints q = 0.5 * from + 0.5 * to;
    const double share = 0.5 * (low + high);
    const double d = look_at(q, sample, share);
    // Two links that both move approach each other by twice as much.
    const double moved = (self_ ? 2.0 : 1.0) * arm_.furthest_motion(q, (0.5 * to - 0.5 * from).cwiseAbs());
    if (d - moved >= best_.distance - tolerance_) return;
    if (halvings == most_halvings || halvings_ == 0) {
      best_.complete = false;
      return;
    }
    --halvings_;
    look_between(from, q, sample, low, share, halvings + 1);
    look_between(q, to, sample, share, high, halvings + 1);
  }

  [[nodiscard]] bool nothing() const { return best_.distance == nothing_near; }

  [[nodiscard]] ClosestApproach result() const {
    ClosestApproach closest = best_;
    if (nothing()) return closest;
    const auto all = self_ ? arm_.pairs_of_arm_itself(at_) : arm_.pairs(at_);
    closest.pair = *std::min_element(all.begin(), all.end(), nearer);
    return closest;
  }

 private:
  const ArmClearance& arm_;
  double tolerance_;
  bool self_;
  Eigen::Index halvings_;  // left
  ClosestApproach best_{nothing_near, 0, 0.0, {}};
  Joints at_ = Joints::Zero();
};

ClosestApproach search(const ArmClearance& arm, const Samples& joints, double tolerance, bool self) {
  if (joints.rows() < 1 || joints.cols() != 6 || !(tolerance > 0)) {
    throw DataError("clearance.shape", "the joint path needs a sample, six columns and a tolerance over 0");
  }
  if (!joints.allFinite()) throw DataError("clearance.not_finite", "the joint path has a value that is not finite");
  Search search(arm, joints.rows(), tolerance, self);
  for (Eigen::Index k = 0; k < joints.rows(); ++k) (void)search.look_at(joints.row(k).transpose(), k, 0.0);
  if (search.nothing()) return search.result();
  for (Eigen::Index k = 0; k + 1 < joints.rows(); ++k) {
    search.look_between(joints.row(k).transpose(), joints.row(k + 1).transpose(), k, 0.0, 1.0);
  }
  return search.result();
}

}  // namespace

ClosestApproach closest_approach(const ArmClearance& arm, const Samples& joints, double tolerance) {
  return search(arm, joints, tolerance, false);
}

ClosestApproach closest_approach_of_arm_itself(const ArmClearance& arm, const Samples& joints, double tolerance) {
  return search(arm, joints, tolerance, true);
}

}  // namespace lfd
