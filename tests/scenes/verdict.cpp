#include "verdict.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "lfdtools/metrics.hpp"
#include "lfdtools/motion.hpp"

namespace lfd::scenes {
namespace {

using Shape = std::shared_ptr<fcl::CollisionGeometryd>;

Eigen::Isometry3d transform(const Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.rotation;
  T.translation() = pose.position;
  return T;
}

Shape shape_of(const Solid& solid) {
  switch (solid.shape) {
    case SolidShape::box:
      return std::make_shared<fcl::Boxd>(solid.size);
    case SolidShape::sphere:
      return std::make_shared<fcl::Sphered>(solid.radius);
    case SolidShape::cylinder:
      return std::make_shared<fcl::Cylinderd>(solid.radius, solid.length);
    case SolidShape::capsule:
      return std::make_shared<fcl::Capsuled>(solid.radius, solid.length);
    case SolidShape::plane:
      break;
  }
  throw std::invalid_argument("scenes have no planes");
}

double signed_distance(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
  fcl::CollisionRequestd touch(1, true);
  touch.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd touched;
  if (fcl::collide(&a, &b, touch, touched) > 0) {
    std::vector<fcl::Contactd> contacts;
    touched.getContacts(contacts);
    return contacts.empty() ? 0.0 : -std::abs(contacts.front().penetration_depth);
  }
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  return std::max(0.0, fcl::distance(&a, &b, request, result));
}

}  // namespace

struct FclScene::Bodies {
  std::vector<Shape> links;
  std::vector<Eigen::Isometry3d> in_frame;  // of each link's capsule
  std::vector<fcl::CollisionObjectd> obstacles, ground;
};

FclScene::FclScene(const Robot& robot, const std::vector<Solid>& obstacles, const std::vector<Solid>& ground)
    : robot_(robot), bodies_(std::make_unique<Bodies>()) {
  for (const Capsule& link : robot.links) {
    const Vector3 along = link.to - link.from;
    bodies_->links.push_back(std::make_shared<fcl::Capsuled>(link.radius, along.norm()));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (along.norm() > 0) T.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), along).toRotationMatrix();
    T.translation() = (link.from + link.to) / 2;
    bodies_->in_frame.push_back(T);
  }
  for (const Solid& solid : obstacles) bodies_->obstacles.emplace_back(shape_of(solid), transform(solid.pose));
  for (const Solid& solid : ground) bodies_->ground.emplace_back(shape_of(solid), transform(solid.pose));
}

FclScene::~FclScene() = default;

double FclScene::distance(const Joints& q) const {
  const auto frames = joint_frames(robot_, q);
  std::vector<fcl::CollisionObjectd> links;
  for (std::size_t i = 0; i < bodies_->links.size(); ++i) {
    const auto frame = static_cast<std::size_t>(robot_.links[i].frame);
    links.emplace_back(bodies_->links[i], transform(frames[frame]) * bodies_->in_frame[i]);
  }
  double least = 1e3;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const int frame = robot_.links[i].frame;
    for (const auto& obstacle : bodies_->obstacles) {
      if (frame > 0) least = std::min(least, signed_distance(links[i], obstacle));
    }
    for (const auto& obstacle : bodies_->ground) {
      if (frame > 1) least = std::min(least, signed_distance(links[i], obstacle));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (std::abs(frame - robot_.links[k].frame) > 1) least = std::min(least, signed_distance(links[i], links[k]));
    }
  }
  return least;
}

double least_distance(const FclScene& scene, const Samples& joints, int between) {
  double least = scene.distance(joints.row(0).transpose());
  for (Eigen::Index t = 1; t < joints.rows(); ++t) {
    for (int k = 1; k <= between; ++k) {
      const double share = static_cast<double>(k) / between;
      const Joints q = ((1 - share) * joints.row(t - 1) + share * joints.row(t)).transpose();
      least = std::min(least, scene.distance(q));
    }
  }
  return least;
}

Verdict judge(const InverseKinematics& arm, const FclScene& scene, const Matrix3& orientation, const Samples& path,
              const Joints& demonstrated_start, int branch, double seconds) {
  Verdict verdict;
  verdict.hand_length = path_length(path);
  verdict.jerk = rms_jerk(path, seconds);
  const auto refused = [&](const std::string& reason) {
    verdict.reason = reason;
    return verdict;
  };
  if (!path.allFinite()) return refused("not_finite");
  std::vector<Pose> poses;
  for (Eigen::Index t = 0; t < path.rows(); ++t) poses.push_back({orientation, path.row(t).transpose()});
  PathOptions options;
  options.seed = demonstrated_start;
  options.branch = branch;
  options.refinements = 3;
  const Vector times = linspace(0, seconds, path.rows());
  const JointPath joints = solve_path(arm, poses, times, options);
  if (joints.status == PathStatus::unreachable) return refused("unreachable");
  if (joints.status == PathStatus::outside_limits) return refused("joint_range");
  if (joints.status == PathStatus::jump) return refused("joint_step");
  if (joints.status == PathStatus::deviates) return refused("midpoint");
  if (joints.status == PathStatus::other_branch) return refused("posture");
  if (joints.condition.maxCoeff() > 30) return refused("condition");
  if (joints.largest_step_ratio > 1) return refused("joint_speed");
  verdict.joints = joints.joints;
  verdict.joint_length = path_length(joints.joints);
  verdict.clearance = least_distance(scene, joints.joints);
  verdict.outcome = verdict.clearance > 0 ? Outcome::clear : Outcome::collided;
  return verdict;
}

}  // namespace lfd::scenes
