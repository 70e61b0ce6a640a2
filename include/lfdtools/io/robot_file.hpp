// Robot descriptions as files, format lfdtools.robot.
#pragma once

#include <string>

#include "lfdtools/dh.hpp"
#include "lfdtools/io/json.hpp"
#include "lfdtools/io/output.hpp"

namespace lfd {

/// The document's JsonOptions should have Fault::config, so that refusals are ConfigError.
/// @throws as JsonView and check(Robot), with the pointer
[[nodiscard]] Robot read_robot(const JsonDocument& document);

/// The robot of a file: lfdtools.robot, or by its ending a UR calibration (.yaml, .yml) or a URDF (.urdf).
/// @throws as Input, JsonStream::next (ConfigError) and read_robot; ConfigError [yaml.*], [urdf.*], [robot.not_dh],
///         [robot.unknown_model], [robot.too_long]; [robot.no_yaml], [robot.no_urdf] where it was built without them
[[nodiscard]] Robot load_robot(const std::string& path, Messages& messages, bool strict = false);

/// The robot of a file, for programs that need its body.
/// @throws as load_robot; ConfigError [robot.no_links] unless every frame 1..6 has a link
[[nodiscard]] Robot load_robot_with_links(const std::string& path, Messages& messages, bool strict = false);

/// One line.
void write_robot(const Robot& robot, Output& out);

}  // namespace lfd
