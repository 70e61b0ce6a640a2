#include "lfdtools/semidefinite.hpp"

#include <algorithm>
#include <cmath>

namespace lfd {

bool try_thin_cholesky(const Matrix& A, Matrix& L) {
  L.resize(A.rows(), 0);
  if (A.rows() != A.cols() || !A.allFinite()) return false;
  if (A.rows() == 0) return true;
  const double largest = A.diagonal().maxCoeff();
  const double allowed = 1e-6 * std::max(largest, 0.0);
  Matrix columns(A.rows(), std::min<Eigen::Index>(A.rows(), 16));
  Eigen::Index rank = 0;
  Vector left = A.diagonal();
  for (; rank < A.rows(); ++rank) {
    if (left.minCoeff() < -allowed) return false;
    Eigen::Index pivot = 0;
    const double variance = left.maxCoeff(&pivot);
    if (!(variance > 1e-10 * largest)) break;
    if (rank == columns.cols()) columns.conservativeResize(Eigen::NoChange, std::min(A.rows(), 2 * rank));
    columns.col(rank) =
        (A.col(pivot) - columns.leftCols(rank) * columns.row(pivot).head(rank).transpose()) / std::sqrt(variance);
    left -= columns.col(rank).cwiseAbs2();
  }
  L = columns.leftCols(rank);
  // What the diagonal does not show: [[0, 1], [1, 0]].
  return (A - L * L.transpose()).cwiseAbs().maxCoeff() <= allowed;
}

}  // namespace lfd
