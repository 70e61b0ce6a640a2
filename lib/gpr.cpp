#include "lfdtools/gpr.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include "lfdtools/mvgp.hpp"

namespace lfd {
namespace {

/// One weight: value = mean + sd times a process.
struct Scalar {
  double mean = 0;
  double sd = 0;  // 0: the same in every row
  double noise_variance = 0;
  std::shared_ptr<const MvgpPredictor> process;
};

Scalar train_scalar(const Matrix& X, Vector values, std::uint64_t seed) {
  Scalar scalar;
  scalar.mean = values.mean();
  values.array() -= scalar.mean;
  scalar.sd = std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
  if (!(scalar.sd > 1e-12 * std::abs(scalar.mean))) {
    scalar.sd = 0;
    return scalar;
  }
  MvgpOptions options;
  options.kernel = se_ard_kernel(static_cast<int>(X.cols()));
  options.omega = OmegaRule::ml;  // of one output: the signal variance at its maximum
  options.starts = 2;
  options.seed = seed;
  const MvgpModel model = train_mvgp(X, values / scalar.sd, {}, options);
  scalar.noise_variance = model.noise_variance;
  scalar.process = std::make_shared<const MvgpPredictor>(model);
  return scalar;
}

}  // namespace

Predictor train_gpr(const Fold& fold, const PreparationOptions& options) {
  const Dmp first = fold.front()->examples.front().primitive;
  std::vector<const Example*> rows;
  for (const auto* target : fold) {
    for (const auto& example : target->examples) rows.push_back(&example);
  }
  Matrix X(rows.size(), first.dimensions());
  for (std::size_t i = 0; i < rows.size(); ++i) X.row(static_cast<Eigen::Index>(i)) = rows[i]->change().transpose();
  std::vector<Scalar> weights;  // by signal, then by basis
  for (Eigen::Index j = 0; j < first.dimensions(); ++j) {
    for (Eigen::Index b = 0; b < first.settings.bases(); ++b) {
      Vector values(X.rows());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        values[static_cast<Eigen::Index>(i)] = rows[i]->primitive.weights(j, b);
      }
      weights.push_back(train_scalar(X, std::move(values), options.seed));
    }
  }
  return [first, weights](const Query& query) {
    Dmp dmp = first;
    dmp.tau = 1;
    dmp.start = query.start;
    dmp.goal = query.goal;
    Matrix variances = Matrix::Zero(dmp.weights.rows(), dmp.weights.cols());
    for (Eigen::Index j = 0; j < variances.rows(); ++j) {
      for (Eigen::Index b = 0; b < variances.cols(); ++b) {
        const Scalar& scalar = weights[static_cast<std::size_t>(j * variances.cols() + b)];
        dmp.weights(j, b) = scalar.mean;
        if (!scalar.process) continue;
        const MvgpPrediction prediction = scalar.process->predict(query.change());
        const double noise = scalar.noise_variance / query.repetitions;
        dmp.weights(j, b) += scalar.sd * prediction.mean[0];
        variances(j, b) = scalar.sd * scalar.sd * scalar.process->weight_covariance(prediction.variance + noise)(0, 0);
      }
    }
    const Matrix R = response_matrix(dmp.settings, dmp.tau, linspace(0, 1, phase_count));
    return Predicted{rollout(dmp, linspace(0, 1, phase_count)).positions,
                     normal_band(R.cwiseAbs2() * variances.transpose())};
  };
}

}  // namespace lfd
