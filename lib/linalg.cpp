#include "lfdtools/linalg.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "lfdtools/error.hpp"

namespace lfd {

bool try_cholesky(const Matrix& A, Matrix& L) {
  if (!A.allFinite()) return false;
  const Eigen::LLT<Matrix> llt(A);
  if (llt.info() != Eigen::Success) return false;
  L = llt.matrixL();
  return L.allFinite() && (L.diagonal().array() > 0).all();
}

Matrix cholesky(const Matrix& A) {
  if (!A.allFinite()) throw DataError("linalg.not_finite", "matrix has an entry that is not a finite number");
  Matrix L;
  if (!try_cholesky(A, L)) throw DataError("linalg.not_positive_definite", "matrix is not positive definite");
  return L;
}

double log_determinant_from_cholesky(const Matrix& L) {
  return 2 * L.diagonal().array().log().sum();
}

Matrix cholesky_solve(const Matrix& L, const Matrix& B) {
  Matrix X = L.triangularView<Eigen::Lower>().solve(B);
  L.transpose().triangularView<Eigen::Upper>().solveInPlace(X);
  return X;
}

}  // namespace lfd
