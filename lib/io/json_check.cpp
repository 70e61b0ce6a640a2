#include "json_check.hpp"

#include <cmath>

namespace lfd {

void require_symmetric(const JsonView& at, const Matrix& A, const char* id) {
  constexpr double tolerance = 1e-9;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double allowed = tolerance * std::sqrt(std::abs(A(i, i) * A(j, j)));
      if (!(std::abs(A(i, j) - A(j, i)) <= allowed)) {
        at.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).fail(id, "the matrix is not symmetric");
      }
    }
  }
}

}  // namespace lfd
