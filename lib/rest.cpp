#include "lfdtools/rest.hpp"

#include <Eigen/LU>

#include "lfdtools/error.hpp"

namespace lfd {

RestConditions::RestConditions(const DmpSettings& settings, const Matrix& A) : settings_(settings) {
  const Eigen::Index N = settings.bases();
  if (N < 5) throw DataError("rest.too_few_bases", "resting at the goal takes four conditions and so at least five bases");
  const DmpResponse R = response(settings, 1.0, Vector::Ones(1));
  C_.resize(4, N);
  C_.row(0) = R.position.row(0);
  C_.row(1) = R.velocity.row(0);
  C_.row(2) = normalized_activations(settings.basis(), settings.canonical().phase(1.0)).transpose();
  C_.row(3) = normalized_activations(settings.basis(), 0.0).transpose();
  // In v = w A the change is the one of least Euclidean length: v -= D^T (D D^T)^-1 (D v - c) with D = C A^-T.
  const Eigen::PartialPivLU<Matrix> lu(A);
  const Matrix D = lu.solve(C_.transpose()).transpose();
  const Matrix DDt = D * D.transpose();
  const Matrix change_of_v = D.transpose() * DDt.fullPivLu().inverse();
  correct_ = A.transpose().partialPivLu().solve(change_of_v);
}

Matrix RestConditions::apply(const Dmp& dmp) const {
  Matrix weights = dmp.weights;
  const Vector scale = dmp.scale();
  const Motion free = free_response(settings_, 1.0, Vector::Ones(1), dmp.start, dmp.goal);
  for (Eigen::Index j = 0; j < weights.rows(); ++j) {
    if (scale[j] == 0) continue;
    Vector c = Vector::Zero(4);
    c[0] = (dmp.goal[j] - free.positions(0, j)) / scale[j];
    c[1] = -free.velocities(0, j) / scale[j];
    weights.row(j) -= (correct_ * (C_ * weights.row(j).transpose() - c)).transpose();
  }
  return weights;
}

}  // namespace lfd
