#include "lfdtools/io/transform_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>

namespace lfd {

Pose read_transform(const JsonDocument& document) {
  document.expect("lfdtools.transform");
  const JsonView root = document.root();
  root.only({"format", "version", "matrix", "provenance"});
  const JsonView view = root.at("matrix");
  const Matrix M = view.matrix(4, 4);
  const Matrix3 R = M.topLeftCorner(3, 3);
  const double off = (R.transpose() * R - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= 1e-5) || !(R.determinant() > 0)) {
    view.fail(
        "transform.not_rigid",
        fmt::format("the upper left 3 x 3 is no rotation: R^T R is {:.2g} off the identity, the determinant {:.6g}",
                    off, R.determinant()));
  }
  Eigen::RowVector4d last;
  last << 0, 0, 0, 1;
  if (!((M.row(3) - last).cwiseAbs().maxCoeff() <= 1e-9)) {
    view.at(3).fail("transform.not_rigid", "the last row of a rigid transform is 0, 0, 0, 1");
  }
  return {R, M.topRightCorner(3, 1)};
}

Pose load_transform(const std::string& path, Messages& messages, bool strict) {
  JsonOptions options;
  options.fault = Fault::config;
  options.strict = strict;
  return read_transform(read_json(path, messages, options));
}

}  // namespace lfd
