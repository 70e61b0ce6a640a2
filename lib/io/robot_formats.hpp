// Robots as other people's files have them. Each reader is built where its library is.
#pragma once

#include <string>

#include "lfdtools/dh.hpp"
#include "lfdtools/io/message.hpp"

namespace lfd {

/// A UR calibration as ur_calibration extracts it: kinematics: {shoulder, upper_arm, forearm, wrist_1, wrist_2,
/// wrist_3}, each {x, y, z [m], roll, pitch, yaw [rad]}. It says nothing of limits and bodies: they are those of the
/// model, among the robots that come along, whose lengths are nearest.
/// @throws ConfigError [yaml.syntax], [yaml.missing_key], [yaml.wrong_type], [yaml.unknown_key] (strict; else a
///         warning), [robot.unknown_model] if no model's lengths are within 20 mm; with a pointer
[[nodiscard]] Robot read_calibration(const std::string& text, const std::string& file, Messages& messages, bool strict);

/// The one chain of six turning joints of a URDF. The flange is the link tool0 where it belongs to the last joint, else
/// that joint's own child. Links that do not move are frames, and so is "base", the root link unless there is a link of
/// that name.
/// @throws ConfigError [urdf.syntax], [urdf.chain], [urdf.limits], [robot.not_dh]; the pointer names the joint
[[nodiscard]] Robot read_urdf(const std::string& text, const std::string& file);

}  // namespace lfd
