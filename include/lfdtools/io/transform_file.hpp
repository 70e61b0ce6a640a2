// Rigid transforms as files, format lfdtools.transform: where a camera stands.
#pragma once

#include <string>

#include "lfdtools/io/json.hpp"
#include "lfdtools/rotation.hpp"

namespace lfd {

/// Reads `matrix`, 4 x 4: the pose of the camera in base coordinates, so p_base = rotation p_camera + position [m].
/// @throws as JsonView; [transform.not_rigid] unless the upper left is a rotation to 1e-5 (R^T R = I, determinant
///         positive) and the last row 0, 0, 0, 1
[[nodiscard]] Pose read_transform(const JsonDocument& document);

/// The transform of a file. @throws as Input, JsonStream::next and read_transform, as ConfigError
[[nodiscard]] Pose load_transform(const std::string& path, Messages& messages, bool strict = false);

}  // namespace lfd
