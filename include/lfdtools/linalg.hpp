// Matrix types and the few checked decompositions that every column shares.
#pragma once

#include <Eigen/Core>

namespace lfd {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
/// Rows are samples, columns are dimensions; stored row by row, as it comes from a file.
using Samples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Lower Cholesky factor L with A = L L^T.
/// @param A  symmetric positive definite, d x d; only the lower triangle is read
/// @throws DataError [linalg.not_finite] or [linalg.not_positive_definite] (Eigen's LLT accepts NaN silently: checked
///         before and after)
[[nodiscard]] Matrix cholesky(const Matrix& A);

/// True, and L set to the lower Cholesky factor, if A is finite and positive definite; false otherwise.
[[nodiscard]] bool try_cholesky(const Matrix& A, Matrix& L);

/// ln|A| from its lower Cholesky factor.
[[nodiscard]] double log_determinant_from_cholesky(const Matrix& L);

/// A^-1 B from the lower Cholesky factor of A, d x d times d x m.
[[nodiscard]] Matrix cholesky_solve(const Matrix& L, const Matrix& B);

}  // namespace lfd
