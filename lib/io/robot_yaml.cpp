// Built where yaml-cpp is.
#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/joint_chain.hpp"
#include "lfdtools/ur_geometry.hpp"
#include "robot_formats.hpp"

namespace lfd {
namespace {

// No calibration moves a joint so far.
constexpr double far_lengths = 0.02;  // [m]
constexpr double far_turned = 0.1;    // [rad]
const std::array<std::string, 6> joint_keys = {"shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"};
const std::array<std::string, 7> models = {"ur10", "ur10e", "ur3", "ur5", "ur3e", "ur5e", "ur16e"};

class CalibrationReader {
 public:
  CalibrationReader(std::string file, Messages& messages, bool strict)
      : file_(std::move(file)), messages_(messages), strict_(strict) {}

  [[nodiscard]] JointChain read(const YAML::Node& root) {
    const YAML::Node kinematics = member(root, "kinematics", "");
    only(root, "", {"kinematics"}, "");
    only(kinematics, "/kinematics", {joint_keys.begin(), joint_keys.end()}, "hash");
    JointChain chain;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string at = "/kinematics/" + joint_keys[i];
      const YAML::Node joint = member(kinematics, joint_keys[i], "/kinematics");
      only(joint, at, {"x", "y", "z", "roll", "pitch", "yaw"}, "");
      const auto value = [&](const char* key) { return number(member(joint, key, at), at + "/" + key); };
      chain.origins[i].position << value("x"), value("y"), value("z");
      chain.origins[i].rotation = rotation_from_rpy(Vector3(value("roll"), value("pitch"), value("yaw")));
    }
    return chain;
  }

 private:
  [[nodiscard]] Place place(const YAML::Node& node, const std::string& pointer) const {
    const YAML::Mark mark = node.Mark();
    return {file_, mark.is_null() ? 0 : static_cast<std::size_t>(mark.line) + 1, 0, pointer};
  }

  [[nodiscard]] YAML::Node member(const YAML::Node& node, const std::string& key, const std::string& pointer) const {
    if (!node.IsMap()) throw ConfigError("yaml.wrong_type", "there must be keys with values", place(node, pointer));
    const YAML::Node found = node[key];
    if (!found) throw ConfigError("yaml.missing_key", "there is no " + key, place(node, pointer));
    return found;
  }

  [[nodiscard]] double number(const YAML::Node& node, const std::string& pointer) const {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
      throw ConfigError("yaml.wrong_type", "a finite number is needed", place(node, pointer));
    }
    return value;
  }

  /// Keys beyond those known are warned of, or refused; each known one at most once.
  void only(const YAML::Node& node, const std::string& pointer, const std::vector<std::string>& known,
            const std::string& tolerated) {
    if (!node.IsMap()) throw ConfigError("yaml.wrong_type", "there must be keys with values", place(node, pointer));
    std::vector<std::string> seen;
    for (const auto& pair : node) {
      const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        throw ConfigError("yaml.duplicate_key", "the key " + key + " stands twice", place(pair.first, pointer));
      }
      seen.push_back(key);
      if (key == tolerated || std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::string text = "unknown key " + key;
      if (strict_) throw ConfigError("yaml.unknown_key", text, place(pair.first, pointer));
      messages_.warning("yaml.unknown_key", text, place(pair.first, pointer));
    }
  }

  std::string file_;
  Messages& messages_;
  bool strict_;
};

double difference(const UrGeometry& a, const UrGeometry& b) {
  return std::max({std::abs(a.d1 - b.d1), std::abs(a.a2 - b.a2), std::abs(a.a3 - b.a3), std::abs(a.d4 - b.d4),
                   std::abs(a.d5 - b.d5), std::abs(a.d6 - b.d6)});
}

/// Whether a joint's axis, z of its frame, wherever on it the frame lies, or the whole frame, is elsewhere.
bool far_apart(const Pose& own, const Pose& nominal, bool whole) {
  const Vector3 off = nominal.position - own.position;
  if (whole) return off.norm() > far_lengths || distance(own, nominal).rotation > far_turned;
  const Vector3 axis = own.rotation.col(2);
  return axis.cross(off).norm() > far_lengths || axis.cross(nominal.rotation.col(2)).norm() > far_turned ||
         axis.dot(nominal.rotation.col(2)) < 0;
}

}  // namespace

Robot read_calibration(const std::string& text, const std::string& file, Messages& messages, bool strict) {
  const Place kinematics{file, 0, 0, "/kinematics"};
  Robot robot;
  try {
    const YAML::Node root = YAML::Load(text);
    const DhForm form = dh_form(CalibrationReader(file, messages, strict).read(root));
    robot.dh = form.rows;
    const Pose base = inverse(form.base);
    robot.frames["base"] = base;
    robot.frames["base_link"] = base * frame_in_base({}, "base_link");
  } catch (const YAML::DeepRecursion& error) {
    throw ConfigError("yaml.syntax", "it is nested too deeply",
                      {file, static_cast<std::size_t>(error.mark.line) + 1, 0, ""});
  } catch (const YAML::ParserException& error) {
    throw ConfigError("yaml.syntax", error.msg, {file, static_cast<std::size_t>(error.mark.line) + 1, 0, ""});
  } catch (const YAML::Exception& error) {
    throw ConfigError("yaml.syntax", error.msg, {file, 0, 0, ""});
  }

  double nearest = far_lengths;
  Robot model;
  try {
    const UrGeometry geometry = ur_geometry(robot);
    for (const std::string& name : models) {
      const Robot candidate = load_robot(find_data_file(name, "robots"), messages, strict);
      const double apart = difference(geometry, ur_geometry(candidate));
      if (!(apart < nearest)) continue;
      nearest = apart;
      model = candidate;
    }
  } catch (const ConfigError& error) {
    if (!error.place().file.empty()) throw;
    throw ConfigError(error.id(), error.what(), kinematics);
  }
  if (model.name.empty()) {
    throw ConfigError("robot.unknown_model", "the lengths are not within 20 mm of those of any robot here", kinematics);
  }
  messages.note("robot.model",
                fmt::format("the lengths are those of a {}, by up to {:.2g} mm: its limits and links are taken",
                            model.name, 1e3 * nearest),
                kinematics);
  robot.name = model.name;
  robot.limits = model.limits;
  // The bodies stay where they are at q = 0: DH frames of a calibrated arm may lie far from them.
  const auto nominal = joint_frames(model, Joints::Zero()), own = joint_frames(robot, Joints::Zero());
  const Pose base = robot.frames["base"];
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!far_apart(own[i], base * nominal[i], i == 6)) continue;
    const std::string key = joint_keys[std::min<std::size_t>(i, 5)];
    throw ConfigError(
        "robot.far_from_model",
        fmt::format("{} of {} is over {:g} mm or {:g} rad from where a {} has it",
                    i == 6 ? "the flange" : "the joint axis", key, 1e3 * far_lengths, far_turned, model.name),
        {file, 0, 0, "/kinematics/" + key});
  }
  for (Capsule link : model.links) {
    const auto i = static_cast<std::size_t>(link.frame);
    const Pose moved = inverse(own[i]) * base * nominal[i];
    link.from = moved.rotation * link.from + moved.position;
    link.to = moved.rotation * link.to + moved.position;
    robot.links.push_back(link);
  }
  check(robot);
  return robot;
}

}  // namespace lfd
