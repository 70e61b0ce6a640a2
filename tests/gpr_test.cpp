#include "lfdtools/gpr.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "judge_fixture.hpp"
#include "lfdtools/metrics.hpp"
#include "lfdtools/mvgp.hpp"

using namespace lfd;

TEST_CASE("every weight is k (K + noise)^-1 y of the textbook, at its own hyperparameters") {
  const auto training = small_training();
  const Query query = small_query();
  std::vector<const Example*> rows;
  for (const auto& target : training) {
    for (const auto& example : target.examples) rows.push_back(&example);
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  Matrix X(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) X.row(i) = rows[static_cast<std::size_t>(i)]->change().transpose();
  Dmp dmp = rows[0]->primitive;
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index b = 0; b < dmp.weights.cols(); ++b) {
      Vector y(n);
      for (Eigen::Index i = 0; i < n; ++i) y[i] = rows[static_cast<std::size_t>(i)]->primitive.weights(j, b);
      const double mean = y.mean();
      const double sd = std::sqrt((y.array() - mean).square().mean());
      y = (y.array() - mean) / sd;
      MvgpOptions options;
      options.kernel = se_ard_kernel(3);
      options.omega = OmegaRule::ml;
      options.starts = 2;
      const MvgpModel model = train_mvgp(X, y, {}, options);
      const Vector l = model.kernel.terms[0].length_scales;
      const auto k = [&](const Vector& a, const Vector& c) {
        return std::exp(-0.5 * ((a - c).array() / l.array()).square().sum());
      };
      Matrix K(n, n);
      Vector cross(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index c = 0; c < n; ++c) K(i, c) = k(X.row(i), X.row(c));
        K(i, i) += model.noise_variance;
        cross[i] = k(X.row(i), query.change());
      }
      dmp.weights(j, b) = mean + sd * cross.dot(K.inverse() * y);
    }
  }
  dmp.start = query.start;
  dmp.goal = query.goal;
  const Samples expected = rollout(dmp, linspace(0, dmp.tau, phase_count)).positions;
  CHECK(rms_distance(train_gpr(all_of(training), {})(query).path, expected) < 1e-6);
}

TEST_CASE("a signal that never varies is predicted as it was") {
  auto training = small_training();
  for (auto& target : training) {
    for (auto& example : target.examples) example.primitive.weights.row(2).setConstant(0.25);
  }
  const Predicted predicted = train_gpr(all_of(training), {})(small_query());
  CHECK(predicted.path.allFinite());
  CHECK(predicted.band(BandKind::pointwise, 0.95).col(2).maxCoeff() == 0);
}
