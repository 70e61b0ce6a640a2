// Movement primitives as files, format lfdtools.dmp.
#pragma once

#include "lfdtools/dmp.hpp"
#include "lfdtools/io/provenance.hpp"

namespace lfd {

/// One primitive and what it was made from.
struct DmpFile {
  FileHeader header;  ///< columns: D signals
  Dmp dmp;
};

/// Words of the formats for the two choices.
[[nodiscard]] const char* word(DmpScaling scaling);
[[nodiscard]] const char* word(DmpFitMethod fit);

/// Members scaling, alpha_z, beta_z, alpha_x, centers, widths of an object (also inside lfdtools.skill). At most 1000
/// bases.
/// @throws as JsonView and check(DmpSettings), with the pointer
[[nodiscard]] DmpSettings read_dmp_settings(const JsonView& object);
void write_dmp_settings(JsonWriter& json, const DmpSettings& settings);

/// @throws as JsonView and check(Dmp); [dmp.not_symmetric], [dmp.not_positive_definite] of a covariance of weights,
/// which
///         may be zero in some directions
[[nodiscard]] DmpFile read_dmp(const JsonDocument& document);

/// One line.
void write_dmp(const DmpFile& file, Output& out);

}  // namespace lfd
