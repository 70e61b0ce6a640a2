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

/// The robot of a file.
/// @throws as Input, JsonStream::next (ConfigError) and read_robot
[[nodiscard]] Robot load_robot(const std::string& path, Messages& messages, bool strict = false);

/// The robot of a file, for programs that need its body.
/// @throws as load_robot; ConfigError [robot.no_links] unless a link moves
[[nodiscard]] Robot load_robot_with_links(const std::string& path, Messages& messages, bool strict = false);

/// One line.
void write_robot(const Robot& robot, Output& out);

}  // namespace lfd
