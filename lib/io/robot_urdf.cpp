// Built where urdfdom is wanted (LFD_URDF).
#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <cctype>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/joint_chain.hpp"
#include "robot_formats.hpp"

namespace lfd {

namespace {

using Link = urdf::LinkConstSharedPtr;
using UrdfJoint = urdf::JointSharedPtr;

/// Keeps the first error of the parser, which would go to standard error.
class FirstError : public console_bridge::OutputHandler {
 public:
  FirstError() { console_bridge::useOutputHandler(this); }
  ~FirstError() override { console_bridge::restorePreviousOutputHandler(); }
  FirstError(const FirstError&) = delete;
  FirstError& operator=(const FirstError&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.empty()) text_ = text;
  }
  /// In the form of our own sentences.
  [[nodiscard]] std::string text() const {
    if (text_.empty()) return "no robot description";
    std::string text = text_.substr(0, text_.find_last_not_of(".\n ") + 1);
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    return text;
  }

 private:
  std::string text_;
};

bool turns(const UrdfJoint& joint) {
  return joint && (joint->type == urdf::Joint::REVOLUTE || joint->type == urdf::Joint::CONTINUOUS);
}

Pose pose_of(const urdf::Pose& pose) {
  Quaternion q;
  pose.rotation.getQuaternion(q[1], q[2], q[3], q[0]);
  return {rotation_from_quaternion(q), Vector3(pose.position.x, pose.position.y, pose.position.z)};
}

/// Turns z to the joint's axis.
Pose axis_of(const UrdfJoint& joint) {
  const Vector3 axis(joint->axis.x, joint->axis.y, joint->axis.z);
  if (axis == Vector3::UnitZ()) return {};
  return {Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), axis).toRotationMatrix(), Vector3::Zero()};
}

class UrdfReader {
 public:
  UrdfReader(const urdf::ModelInterface& model, std::string file) : model_(model), file_(std::move(file)) {}

  [[nodiscard]] Robot read() {
    walk(model_.getRoot(), {}, {}, true);
    if (!last_) fail("urdf.chain", "there is no chain of six turning joints");
    JointChain chain;
    Pose axis;
    for (std::size_t i = 0; i < 6; ++i) {
      // What was tilted to turn about z is tilted back before the next origin.
      const Pose next = axis_of(joints_[i]);
      chain.origins[i] = inverse(axis) * origins_[i] * next;
      axis = next;
    }
    chain.flange = inverse(axis) * flange_;
    Robot robot;
    robot.name = model_.getName();
    try {
      const DhForm form = dh_form(chain);
      robot.dh = form.rows;
      for (const auto& [name, pose] : fixed_) robot.frames[name] = inverse(form.base) * pose;
      robot.frames.try_emplace("base", inverse(form.base));
    } catch (const ConfigError& error) {
      fail(error.id(), error.what());
    }
    for (std::size_t i = 0; i < 6; ++i) set_limits(static_cast<Eigen::Index>(i), robot.limits);
    return robot;
  }

 private:
  [[noreturn]] void fail(const std::string& id, const std::string& text, const std::string& joint = {}) const {
    throw ConfigError(id, text, {file_, 0, 0, joint.empty() ? "/robot" : "/robot/joint/" + joint});
  }

  /// @param joints    turning joints on the way from the root   @param origins  of each, in the frame before
  void walk(const Link& link, const std::vector<UrdfJoint>& joints, std::vector<Pose> origins, bool moves_not) {
    if (moves_not) fixed_[link->name] = origins.empty() ? Pose{} : origins.back();
    for (const auto& child : link->child_links) {
      const UrdfJoint& joint = child->parent_joint;
      auto next_joints = joints;
      auto next = origins;
      const Pose origin = pose_of(joint->parent_to_joint_origin_transform);
      if (next.size() == next_joints.size()) next.emplace_back();
      next.back() = next.back() * origin;
      if (turns(joint)) {
        next_joints.push_back(joint);
        if (next_joints.size() == 6) take(next_joints, next);
      } else if (joint->type != urdf::Joint::FIXED) {
        continue;  // a gripper's finger or a carriage: nothing behind it belongs to the arm
      } else if (next_joints.size() == 6 && child->name == "tool0" && next_joints.back() == last_) {
        flange_ = next.back();
      }
      if (next_joints.size() <= 6) walk(child, next_joints, next, moves_not && joint->type == urdf::Joint::FIXED);
    }
  }

  void take(const std::vector<UrdfJoint>& joints, const std::vector<Pose>& origins) {
    if (last_) fail("urdf.chain", "there are several chains of six turning joints", joints.back()->name);
    joints_ = joints;
    origins_ = origins;
    last_ = joints.back();
  }

  void set_limits(Eigen::Index i, JointLimits& limits) const {
    const UrdfJoint& joint = joints_[static_cast<std::size_t>(i)];
    const auto& given = joint->limits;
    const bool endless = joint->type == urdf::Joint::CONTINUOUS;
    const bool fast = given && given->velocity >= JointLimits::least_rate && given->velocity <= JointLimits::most_rate;
    if (!fast || (!endless && !(given->lower < given->upper))) {
      fail("urdf.limits", "a joint needs a range and a limit of its speed from 1e-6 to 1e6", joint->name);
    }
    constexpr double turn = 2.0 * std::numbers::pi;
    limits.position.row(i) << (endless ? -turn : given->lower), (endless ? turn : given->upper);
    limits.velocity[i] = given->velocity;
  }

  const urdf::ModelInterface& model_;
  std::string file_;
  std::vector<UrdfJoint> joints_;
  std::vector<Pose> origins_;
  UrdfJoint last_;
  Pose flange_;
  std::map<std::string, Pose> fixed_;
};

}  // namespace

Robot read_urdf(const std::string& text, const std::string& file) {
  urdf::ModelInterfaceSharedPtr model;
  FirstError error;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& thrown) {
    throw ConfigError("urdf.syntax", thrown.what(), {file, 0, 0, ""});
  }
  if (!model || !model->getRoot()) throw ConfigError("urdf.syntax", error.text(), {file, 0, 0, ""});
  Robot robot = UrdfReader(*model, file).read();
  try {
    check(robot);
  } catch (const ConfigError& refusal) {
    throw ConfigError(refusal.id(), refusal.what(), {file, 0, 0, "/robot"});
  }
  return robot;
}

}  // namespace lfd
