#include "lfdtools/hand_spread.hpp"

#include "lfdtools/error.hpp"
#include "lfdtools/semidefinite.hpp"

namespace lfd {
namespace {

Matrix thin_factor(const Matrix& A) {
  if (A.rows() != A.cols() || !A.allFinite()) {
    throw DataError("hand_spread.shape", "a covariance is not square or not finite");
  }
  Matrix L;
  if (!try_thin_cholesky(A, L)) {
    throw DataError("hand_spread.not_positive", "a covariance is not positive semidefinite");
  }
  return L;
}

}  // namespace

HandSpread hand_spread(const std::vector<Matrix>& covariance, const Matrix3& rotation) {
  if (covariance.size() != 1 && covariance.size() != 3) {
    throw DataError("hand_spread.shape", "there must be three covariances of T x T, or one of 3 T x 3 T");
  }
  const bool joint = covariance.size() == 1;
  const Eigen::Index T = joint ? covariance[0].rows() / 3 : covariance[0].rows();
  if (T < 1 || (joint && covariance[0].rows() != 3 * T))
    throw DataError("hand_spread.shape", "the covariance is not 3 T x 3 T");
  std::vector<Matrix> factors;
  Eigen::Index K = 0;
  for (const Matrix& part : covariance) {
    factors.push_back(thin_factor(part));
    if (factors.back().rows() != (joint ? 3 * T : T))
      throw DataError("hand_spread.shape", "covariances differ in size");
    K += factors.back().cols();
  }
  HandSpread spread{Matrix::Zero(3 * T, K)};
  for (Eigen::Index t = 0; t < T; ++t) {
    Eigen::Index column = 0;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const Matrix& L = factors[joint ? 0 : static_cast<std::size_t>(a)];
      spread.factor.row(3 * t + a).segment(column, L.cols()) = L.row(joint ? a * T + t : t);
      if (!joint) column += L.cols();
    }
    spread.factor.middleRows(3 * t, 3) = (rotation * spread.factor.middleRows(3 * t, 3)).eval();
  }
  return spread;
}

Vector share_of_way(const Samples& positions) {
  Vector way = Vector::Zero(positions.rows());
  for (Eigen::Index k = 1; k < way.size(); ++k) {
    way[k] = way[k - 1] + (positions.row(k) - positions.row(k - 1)).norm();
  }
  const double whole = way.size() > 0 ? way[way.size() - 1] : 0.0;
  return whole > 0 ? Vector(way / whole) : Vector(Vector::Ones(way.size()));
}

HandSpread hand_shift(const Vector3& sd, const Vector& share, const Matrix3& rotation) {
  HandSpread spread{Matrix(3 * share.size(), 3)};
  const Matrix3 shift = rotation * sd.asDiagonal();
  for (Eigen::Index t = 0; t < share.size(); ++t) spread.factor.middleRows<3>(3 * t) = share[t] * shift;
  return spread;
}

HandSpread together(const HandSpread& a, const HandSpread& b) {
  if (a.samples() != b.samples()) throw DataError("hand_spread.shape", "two spreads differ in samples");
  HandSpread both{Matrix(a.factor.rows(), a.factor.cols() + b.factor.cols())};
  both.factor << a.factor, b.factor;
  return both;
}

}  // namespace lfd
