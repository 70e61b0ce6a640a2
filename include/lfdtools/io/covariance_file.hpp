// How far a generated motion may be off, as files, format lfdtools.covariance.
#pragma once

#include "lfdtools/io/provenance.hpp"
#include "lfdtools/posterior.hpp"

namespace lfd {

/// The spread of one motion.
struct CovarianceFile {
  FileHeader header;  ///< columns: D signals
  Spread spread = Spread::latent;
  Vector calibration;              ///< D factors on the covariance that held on targets left out; empty: not calibrated
  Vector degrees_of_freedom;       ///< D, of the Student-t of each signal; infinite ones are written as null
  Vector times;                    ///< T [s]
  Samples mean;                    ///< T x D [m]
  std::vector<Matrix> covariance;  ///< D of T x T, or one D T x D T, by signal, then by time [m^2]
  Matrix goal_factor;  ///< F, D T x D: F F^T, of `covariance`, comes of the goal; empty: it is exactly known
};

/// @throws as read_header and JsonView; [json.wrong_length] where mean or covariance do not fit columns and times,
///         [covariance.time_not_rising], [covariance.not_symmetric] to 1e-9 of the largest entry,
///         [covariance.not_positive]
[[nodiscard]] CovarianceFile read_covariance(const JsonDocument& document);

/// The covariance times its calibration: of signals a and b, the root of the product of theirs. What comes of the goal
/// stays as it is.
[[nodiscard]] std::vector<Matrix> calibrated(const CovarianceFile& file);

/// One line.
/// @throws DataError [covariance.too_large] over 2 10^7 numbers: a larger time step makes fewer
void write_covariance(const CovarianceFile& file, Output& out);

}  // namespace lfd
