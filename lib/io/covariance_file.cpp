#include "lfdtools/io/covariance_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/io/json_writer.hpp"

namespace lfd {

void write_covariance(const CovarianceFile& file, Output& out) {
  double numbers = 0;
  for (const Matrix& part : file.covariance) numbers += static_cast<double>(part.size());
  if (numbers > 2e7) {
    throw DataError("covariance.too_large",
                    fmt::format("the covariance of a motion of {} samples has {:.3g} numbers, over 2e7: take a larger "
                                "time step",
                                file.times.size(), numbers));
  }
  JsonWriter json;
  write_header(json, "lfdtools.covariance", file.header);
  json.member("spread", file.spread == Spread::latent ? "latent" : "predictive");
  json.key("degrees_of_freedom").begin_array();
  for (const double nu : file.degrees_of_freedom) std::isfinite(nu) ? json.number(nu) : json.null();
  json.end_array().member("t", file.times).key("mean").matrix(file.mean).key("covariance");
  if (file.covariance.size() == 1 && file.header.columns.size() > 1) {
    json.matrix(file.covariance.front());
  } else {
    json.begin_array();
    for (const Matrix& part : file.covariance) json.matrix(part);
    json.end_array();
  }
  write_provenance(json, file.header);
  json.write_line(out);
}

}  // namespace lfd
