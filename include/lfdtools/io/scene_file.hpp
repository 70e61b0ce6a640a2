// Obstacles as files, format lfdtools.scene.
#pragma once

#include "lfdtools/io/json.hpp"
#include "lfdtools/scene.hpp"

namespace lfd {

/// At most 10^4 obstacles. Sizes, radii and lengths are positive; a name may be missing.
/// @throws as JsonView; [scene.frame], [scene.type] for words that are not known, [rotation.not_unit]
[[nodiscard]] Scene read_scene(const JsonDocument& document);

/// The scene of a file.
/// @throws as Input, JsonStream::next (ConfigError) and read_scene
[[nodiscard]] Scene load_scene(const std::string& path, Messages& messages, bool strict = false);

}  // namespace lfd
