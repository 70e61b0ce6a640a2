#include "lfdtools/affine.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace lfd {
namespace {

/// Rows of a regression, n x p and n x d.
struct Rows {
  Matrix inputs;
  Matrix outputs;
};

/// What a map is affine in.
using Input = std::function<Vector(const Vector& start, const Vector& goal)>;

Vector change_input(const Vector& start, const Vector& goal) {
  return goal - start;
}

Vector ends_input(const Vector& start, const Vector& goal) {
  Vector ends(start.size() + goal.size());
  ends << start, goal;
  return ends;
}

Eigen::Index examples_in(const Fold& fold) {
  std::size_t n = 0;
  for (const auto* target : fold) n += target->examples.size();
  return static_cast<Eigen::Index>(n);
}

/// Weights over dP, by signal, then by basis.
Predictor least_squares(const Fold& fold, bool means) {
  const Dmp& first = fold.front()->examples.front().primitive;
  const Eigen::Index n = means ? static_cast<Eigen::Index>(fold.size()) : examples_in(fold);
  Rows rows{Matrix::Zero(n, first.dimensions()), Matrix::Zero(n, first.weights.size())};
  Eigen::Index i = 0;
  for (const auto* target : fold) {
    const double share = means ? 1.0 / static_cast<double>(target->examples.size()) : 1.0;
    for (const auto& example : target->examples) {
      const Samples weights = example.primitive.weights;
      rows.inputs.row(i) += share * example.change().transpose();
      rows.outputs.row(i) += share * Eigen::Map<const Eigen::RowVectorXd>(weights.data(), weights.size());
      if (!means) ++i;
    }
    if (means) ++i;
  }
  const Matrix B = fit_affine(rows.inputs, rows.outputs);
  return [B, first](const Query& query) {
    Vector x(B.rows());
    x << 1.0, query.change();
    const Vector flat = B.transpose() * x;
    Dmp dmp = first;
    dmp.tau = 1;
    dmp.start = query.start;
    dmp.goal = query.goal;
    dmp.weights = Eigen::Map<const Samples>(flat.data(), first.weights.rows(), first.weights.cols());
    return Predicted{rollout(dmp, linspace(0, 1, phase_count)).positions, {}};
  };
}

/// Deviations from the straight line, all signals of a phase side by side, over an input.
Predictor with_prior(const Fold& fold, const Input& input) {
  const Eigen::Index D = fold.front()->start.size();
  Rows rows{Matrix(examples_in(fold), input(fold.front()->start, fold.front()->goal).size()),
            Matrix(examples_in(fold), phase_count * D)};
  Eigen::Index i = 0;
  for (const auto* target : fold) {
    for (const auto& example : target->examples) {
      const Samples deviation = example.deviation();
      rows.inputs.row(i) = input(example.start, example.goal).transpose();
      rows.outputs.row(i++) = Eigen::Map<const Eigen::RowVectorXd>(deviation.data(), deviation.size());
    }
  }
  const AffinePosterior fit = fit_affine_prior(rows.inputs, rows.outputs);
  return [fit, input](const Query& query) {
    const Vector flat = fit(input(query.start, query.goal));
    const Eigen::Map<const Samples> deviation(flat.data(), phase_count, query.start.size());
    return Predicted{straight_line(query.start, query.goal, linspace(0, 1, phase_count)) + deviation, {}};
  };
}

}  // namespace

Matrix fit_affine(const Matrix& X, const Matrix& Y) {
  Matrix inputs(X.rows(), 1 + X.cols());
  inputs << Vector::Ones(X.rows()), X;
  return inputs.completeOrthogonalDecomposition().solve(Y);
}

AffinePosterior fit_affine_prior(const Matrix& X, const Matrix& Y) {
  AffinePosterior fit;
  fit.mean_x = X.colwise().mean().transpose();
  fit.mean_y = Y.colwise().mean().transpose();
  const Matrix A = X.rowwise() - fit.mean_x.transpose();
  const Matrix Yc = Y.rowwise() - fit.mean_y.transpose();
  const double scale = A.squaredNorm() / static_cast<double>(A.size());
  if (scale <= 0 || Yc.squaredNorm() <= 0) {  // nothing varies: no slope
    fit.slopes = Matrix::Zero(X.cols(), Y.cols());
    return fit;
  }
  // In the singular vectors of A everything is diagonal, so a value of the evidence costs min(n, p) operations.
  const Eigen::JacobiSVD<Matrix> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Matrix turned = svd.matrixU().transpose() * Yc;
  const Vector along = turned.rowwise().squaredNorm();
  const Vector e = svd.singularValues().cwiseAbs2();
  const double outside = std::max(0.0, Yc.squaredNorm() - along.sum());
  const auto d = static_cast<double>(Y.cols());
  const auto n = static_cast<double>(X.rows());
  double least = std::numeric_limits<double>::infinity();
  constexpr int steps = 480;  // 40 a decade
  for (int k = 0; k <= steps; ++k) {
    const double penalty = scale * std::pow(10.0, -6 + 12.0 * k / steps);
    const auto share = 1 + e.array() / penalty;
    const double value =
        d / 2 * share.log().sum() + (n - 1) * d / 2 * std::log(outside + (along.array() / share).sum());
    if (value < least) {
      least = value;
      fit.penalty = penalty;
    }
  }
  const Vector gain = svd.singularValues().array() / (e.array() + fit.penalty);
  fit.slopes = svd.matrixV() * gain.asDiagonal() * turned;
  return fit;
}

Predictor train_affine(const Fold& fold, const PreparationOptions&) {
  return least_squares(fold, false);
}

Predictor train_affine_means(const Fold& fold, const PreparationOptions&) {
  return least_squares(fold, true);
}

Predictor train_affine_prior(const Fold& fold, const PreparationOptions&) {
  return with_prior(fold, change_input);
}

Predictor train_affine_ends(const Fold& fold, const PreparationOptions&) {
  return with_prior(fold, ends_input);
}

}  // namespace lfd
