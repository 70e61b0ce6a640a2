// Covariances that may be singular.
#pragma once

#include "lfdtools/linalg.hpp"

namespace lfd {

/// True, and L set to d x r with A = L L^T to 1e-6 of the largest variance, if A is finite and positive semidefinite;
/// false otherwise. Pivoted: r is the rank to 1e-10 of the largest variance.
/// @param A  symmetric, d x d
[[nodiscard]] bool try_thin_cholesky(const Matrix& A, Matrix& L);

}  // namespace lfd
