#include "lfdtools/mvgp.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "random_matrix.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

/// A model with given hyperparameters: nothing optimised.
MvgpModel plain_model(const Matrix& X, const Matrix& W, const Matrix& A, const Kernel& kernel,
                      MeanType mean = MeanType::zero) {
  MvgpOptions options;
  options.kernel = kernel;
  options.mean = mean;
  options.noise_variance = 0.07;
  options.optimise = false;
  return train_mvgp(X, W, A, options);
}

Kernel sum_of_two() {
  Kernel kernel = sum_kernel(2);
  kernel.terms[2].variance = 0.6;
  kernel.terms[4].length_scales << 0.8, 1.7;
  return kernel;
}

}  // namespace

TEST_CASE("one output is textbook Gaussian process regression") {
  const Matrix X = random_matrix(6, 1, 1);
  const Matrix y = random_matrix(6, 1, 2);
  const double l = 0.8;
  Kernel kernel = se_ard_kernel(1);
  kernel.terms[0].length_scales(0) = l;
  const MvgpPredictor predictor(plain_model(X, y, {}, kernel));
  for (const double x : {-1.5, 0.0, 0.3, 4.0}) {
    Matrix K(6, 6);
    Vector k(6);
    for (int i = 0; i < 6; ++i) {
      k(i) = std::exp(-0.5 * std::pow((x - X(i, 0)) / l, 2));
      for (int j = 0; j < 6; ++j) K(i, j) = std::exp(-0.5 * std::pow((X(i, 0) - X(j, 0)) / l, 2)) + (i == j ? 0.07 : 0);
    }
    const MvgpPrediction prediction = predictor.predict(Vector::Constant(1, x));
    CHECK(prediction.mean(0) == Approx(k.dot(K.inverse() * y.col(0))).epsilon(1e-10));
    CHECK(prediction.variance == Approx(1 - k.dot(K.inverse() * k)).epsilon(1e-10));
  }
}

TEST_CASE("a prediction is the plain formula over the model's fields") {
  const MeanType mean = GENERATE(MeanType::zero, MeanType::constant, MeanType::linear);
  const Matrix X = random_matrix(9, 2, 11);
  const Matrix W = random_matrix(9, 5, 12);
  const Matrix A = random_matrix(5, 5, 13) + 4 * Matrix::Identity(5, 5);
  MvgpModel model = plain_model(X, W, A, sum_of_two(), mean);
  CHECK((model.Y - W * A).norm() < 1e-12);
  if (mean == MeanType::constant) model.noise = random_matrix(9, 1, 14).array().square() + 0.01;
  const Vector x = random_matrix(2, 1, 15);

  Matrix K = covariance(model.kernel, model.X, model.X);
  K +=
      model.noise.size() > 0 ? Matrix(model.noise.asDiagonal()) : Matrix(model.noise_variance * Matrix::Identity(9, 9));
  const auto m = [&](const Matrix& rows) -> Matrix {
    Matrix value = Matrix::Zero(rows.rows(), 5);
    if (mean != MeanType::zero) value.rowwise() += model.coefficients.row(0);
    if (mean == MeanType::linear) value += rows * model.coefficients.bottomRows(2);
    return value;
  };
  const Matrix k = covariance(model.kernel, x.transpose(), model.X);
  const Matrix row = m(x.transpose()) + k * K.inverse() * (model.Y - m(model.X));
  const MvgpPrediction prediction = predict(model, x);
  CHECK((prediction.mean_transformed.transpose() - row).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((prediction.mean.transpose() - row * A.inverse()).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(prediction.variance ==
        Approx(prior_variance(model.kernel, x) - (k * K.inverse() * k.transpose()).value()).epsilon(1e-10));
  CHECK(prediction.degrees_of_freedom == model.nu + 9 - 5 + 1);

  const Matrix C = MvgpPredictor(model).weight_covariance(0.3);
  CHECK((A.transpose() * C * A - 0.3 * model.omega).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("the covariance of several rows is separable, eq. (21)-(23)") {
  // Condition the joint normal of all n d + m d numbers, rows after rows, with covariance K' kron Omega.
  const Matrix X = random_matrix(4, 2, 21);
  const Matrix Xs = random_matrix(3, 2, 22);
  const MvgpModel model = plain_model(X, random_matrix(4, 2, 23), {}, sum_of_two());
  Matrix all(7, 2);
  all << X, Xs;
  Matrix K = covariance(model.kernel, all);
  K.diagonal().head(4).array() += model.noise_variance;
  Matrix joint(14, 14);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) joint.block(2 * i, 2 * j, 2, 2) = K(i, j) * model.omega;
  }
  const Matrix cross = joint.bottomLeftCorner(6, 8);
  const Matrix gain = cross * joint.topLeftCorner(8, 8).inverse();
  const Matrix conditional = joint.bottomRightCorner(6, 6) - gain * cross.transpose();

  const MvgpPredictor predictor(model);
  const Matrix Sigma = predictor.latent_covariance(Xs);
  for (int i = 0; i < 3; ++i) {
    CHECK(Sigma(i, i) == Approx(predictor.predict(Xs.row(i).transpose()).variance).epsilon(1e-10));
    for (int j = 0; j < 3; ++j) {
      CHECK((conditional.block(2 * i, 2 * j, 2, 2) - Sigma(i, j) * model.omega).cwiseAbs().maxCoeff() < 1e-10);
    }
  }
  const Samples rows = model.Y;  // row by row
  const Vector mean = gain * Eigen::Map<const Vector>(rows.data(), 8);
  for (int i = 0; i < 3; ++i) {
    CHECK((mean.segment(2 * i, 2) - predictor.predict(Xs.row(i).transpose()).mean).cwiseAbs().maxCoeff() < 1e-10);
  }
}

TEST_CASE("a noisy row is a Student-t with the stated freedom: the evidence of one more row says so") {
  const int d = GENERATE(1, 3);
  const Matrix X = random_matrix(5, 2, 31);
  const Matrix Y = random_matrix(5, d, 32);
  MvgpModel more = plain_model(X, Y, {}, sum_of_two());
  MvgpModel model = more;
  model.X = X.topRows(4);
  model.Y = Y.topRows(4);
  const Matrix K = noisy_covariance(model);
  const Matrix scatter = more.psi(0, 0) * Matrix::Identity(d, d) + model.Y.transpose() * K.inverse() * model.Y;
  model.omega = scatter / (4 + model.nu - d - 1);

  const MvgpPrediction prediction = predict(model, X.row(4).transpose());
  const double freedom = prediction.degrees_of_freedom;
  // Covariance variance * omega of a t is freedom / (freedom - 2) times its scale matrix.
  const Matrix scale = (prediction.variance + model.noise_variance) * model.omega * (freedom - 2) / freedom;
  const Vector r = Y.row(4).transpose() - prediction.mean;
  const double log_t = std::lgamma((freedom + d) / 2) - std::lgamma(freedom / 2) -
                       0.5 * d * std::log(freedom * std::numbers::pi) - 0.5 * std::log(scale.determinant()) -
                       0.5 * (freedom + d) * std::log1p(r.dot(scale.inverse() * r) / freedom);
  CHECK(log_evidence(more) - log_evidence(model) == Approx(log_t).epsilon(1e-10));
}

TEST_CASE("the mean of a given K' depends neither on Omega nor on the transform") {
  const Matrix X = random_matrix(8, 2, 41);
  const Matrix W = random_matrix(8, 4, 42);
  const Matrix A = random_matrix(4, 4, 43) + 3 * Matrix::Identity(4, 4);
  const Vector x = random_matrix(2, 1, 44);
  const MvgpPrediction none = predict(plain_model(X, W, {}, sum_of_two()), x);
  const MvgpModel identity = plain_model(X, W, Matrix::Identity(4, 4), sum_of_two());
  const MvgpPrediction same = predict(identity, x);
  const MvgpPrediction other = predict(plain_model(X, W, A, sum_of_two()), x);
  CHECK((none.mean - same.mean).cwiseAbs().maxCoeff() < 1e-14);
  CHECK((none.mean - other.mean).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(none.variance == other.variance);
}

TEST_CASE("what is left of a group that is left out is what a model without it misses") {
  const Matrix X = random_matrix(12, 2, 71);
  const Matrix W = random_matrix(12, 3, 72);
  const Matrix A = random_matrix(3, 3, 73) + 3 * Matrix::Identity(3, 3);
  const std::vector<std::vector<std::size_t>> groups = {{0, 5, 6}, {1}, {2, 3, 4, 7, 8}, {10, 9}};  // 11 is in none
  MvgpOptions options;
  options.kernel = sum_of_two();
  options.optimise = false;
  options.noise_variance = 0.07;
  SECTION("zero mean") {}
  SECTION("a mean that is known") {
    options.mean = MeanType::linear;
    options.coefficients = random_matrix(3, 3, 74);
  }
  SECTION("rows with a noise of their own") {
    options.row_noise = random_matrix(12, 1, 75).array().square() + 0.1;
  }
  const Matrix left_out = left_out_residuals(train_mvgp(X, W, A, options), groups);
  CHECK(left_out.row(11).norm() == 0);
  for (const auto& group : groups) {
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < 12; ++i) {
      if (std::find(group.begin(), group.end(), i) == group.end()) rest.push_back(i);
    }
    MvgpOptions of_rest = options;
    if (options.row_noise.size() > 0) of_rest.row_noise = options.row_noise(rest);
    const MvgpPredictor without(train_mvgp(X(rest, Eigen::all), W(rest, Eigen::all), A, of_rest));
    for (const std::size_t i : group) {
      const auto row = static_cast<Eigen::Index>(i);
      const Vector missed = A.transpose() * (W.row(row).transpose() - without.predict(X.row(row).transpose()).mean);
      CHECK((left_out.row(row).transpose() - missed).cwiseAbs().maxCoeff() < 1e-9);
    }
  }
}

TEST_CASE("with a free Omega the row is Gaussian") {
  MvgpOptions options = paper_mvgp_options(2);
  options.omega = OmegaRule::ml;
  options.optimise = false;
  const MvgpModel model = train_mvgp(random_matrix(8, 2, 51), random_matrix(8, 3, 52), {}, options);
  CHECK(predict(model, Vector::Zero(2)).degrees_of_freedom == std::numeric_limits<double>::infinity());
  CHECK(log_evidence(model) == model.log_marginal_likelihood);
  const Matrix S = model.Y.transpose() * noisy_covariance(model).inverse() * model.Y;
  CHECK((model.omega - S / 8).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("models and queries that do not fit are refused") {
  const MvgpModel good = plain_model(random_matrix(5, 2, 61), random_matrix(5, 3, 62), {}, se_ard_kernel(2));
  const auto id_of = [](const MvgpModel& model, const Vector& x) {
    return refused_as(Fault::data, [&] { (void)predict(model, x); });
  };
  const Vector x = Vector::Zero(2);
  CHECK(id_of(good, x) == "");
  CHECK(id_of(good, Vector::Zero(3)) == "mvgp.shape");
  CHECK(id_of(good, Vector::Constant(2, std::nan(""))) == "mvgp.not_finite");
  const auto spoiled = [&](auto&& spoil) {
    MvgpModel model = good;
    spoil(model);
    return id_of(model, x);
  };
  const std::string bad = "mvgp.bad_model";
  CHECK(spoiled([](MvgpModel& m) { m.Y = Matrix::Zero(4, 3); }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.Y(1, 1) = std::nan(""); }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.noise_variance = -1; }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.noise = Vector::Ones(4); }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.omega = Matrix::Identity(2, 2); }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.mean = MeanType::constant; }) == bad);
  CHECK(spoiled([](MvgpModel& m) { m.output_transform = Matrix::Zero(3, 3); }) == bad);
  CHECK(spoiled([](MvgpModel& m) {
          m.X.row(1) = m.X.row(0);  // without noise two equal rows leave K' singular
          m.noise_variance = 0;
        }) == bad);
}
