// Training: fields, degenerate data, determinism, refusals, Student-t.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/mvgp.hpp"
#include "lfdtools/random.hpp"
#include "process_fixture.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

bool all_finite(const MvgpModel& model) {
  const MvgpPrediction prediction = predict(model, model.X.row(0).transpose());
  return log_hyperparameters(model.kernel).allFinite() && std::isfinite(model.noise_variance) &&
         model.noise_variance > 0 && model.omega.allFinite() && std::isfinite(model.log_marginal_likelihood) &&
         prediction.mean.allFinite() && std::isfinite(prediction.variance);
}

}  // namespace

TEST_CASE("degenerate data give finite models") {
  MvgpOptions options;
  SECTION("paper") {
    options = paper_mvgp_options(2);
  }
  SECTION("default") {
    options = default_mvgp_options(2);
  }
  SECTION("constant mean") {
    options.mean = MeanType::constant;
  }
  Rows rows = smooth_rows(6, 2, 4, 0.1, 5);
  CHECK(all_finite(train_mvgp(rows.X, rows.Y, {}, options)));
  CHECK(all_finite(train_mvgp(rows.X.topRows(1), rows.Y.topRows(1), {}, options)));
  CHECK(all_finite(train_mvgp(rows.X, Matrix::Zero(6, 4), {}, options)));
  CHECK(all_finite(train_mvgp(rows.X, Matrix::Constant(6, 4, 0.3), {}, options)));
  CHECK(all_finite(train_mvgp(Matrix::Constant(6, 2, 0.4), rows.Y, {}, options)));
  CHECK(all_finite(train_mvgp(Matrix::Zero(6, 2), rows.Y, {}, options)));
  CHECK(all_finite(train_mvgp(1e-9 * rows.X, 1e-9 * rows.Y, {}, options)));
  CHECK(all_finite(train_mvgp(rows.X, 1e6 * rows.Y, {}, options)));
  const MvgpModel zero = train_mvgp(rows.X, Matrix::Zero(6, 4), {}, options);
  const MvgpPredictor predictor(zero);
  const MvgpPrediction far = predictor.predict(Vector::Constant(2, 10.0));
  CHECK(far.mean.norm() == 0);
  CHECK(predictor.weight_covariance(far.variance).trace() < 1e-12);
}

TEST_CASE("the fields of a trained model are what the documentation says") {
  const Rows rows = smooth_rows(9, 2, 6, 0.05, 9);
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, paper_mvgp_options(2));
  CHECK(model.psi(0, 0) == Approx(rows.Y.squaredNorm() / 54));
  CHECK(model.nu == 8);
  CHECK(model.kernel.terms.size() == 1);
  CHECK(model.kernel.terms[0].variance == 1);
  CHECK(model.noise_variance >= 1e-8 * (1 - 1e-12));
  const Matrix S = rows.Y.transpose() * noisy_covariance(model).inverse() * rows.Y;
  const Matrix Omega = (model.psi(0, 0) * Matrix::Identity(6, 6) + S) / (9 + 8 - 6 - 1);
  CHECK((model.omega - Omega).cwiseAbs().maxCoeff() < 1e-8 * Omega.norm());
  CHECK(log_evidence(model) == model.log_marginal_likelihood);

  // Rows that are means of ten demonstrations have a tenth of the noise.
  MvgpOptions options = paper_mvgp_options(2);
  options.row_noise = Vector::Constant(9, 0.1);
  const MvgpModel means = train_mvgp(rows.X, rows.Y, {}, options);
  CHECK((means.noise.array() - 0.1 * means.noise_variance).abs().maxCoeff() < 1e-15);
  CHECK(means.log_marginal_likelihood == Approx(model.log_marginal_likelihood).margin(1e-3));
  CHECK(log_evidence(means) == Approx(means.log_marginal_likelihood).epsilon(1e-12));

  // An explicit mean: coefficients of generalised least squares, whose residual is orthogonal to the basis.
  options.row_noise.resize(0);
  options.mean = MeanType::linear;
  const MvgpModel linear = train_mvgp(rows.X, rows.Y, {}, options);
  const Matrix H = mean_basis(MeanType::linear, rows.X);
  const Matrix R = rows.Y - H * linear.coefficients;
  CHECK((H.transpose() * noisy_covariance(linear).inverse() * R).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("the result is the same for any number of threads, and for the same seed") {
  const Rows rows = smooth_rows(12, 3, 8, 0.05, 13);
  MvgpOptions options = default_mvgp_options(3);
  const MvgpModel one = train_mvgp(rows.X, rows.Y, {}, options);
  options.jobs = 3;
  const MvgpModel three = train_mvgp(rows.X, rows.Y, {}, options);
  CHECK(log_hyperparameters(one.kernel) == log_hyperparameters(three.kernel));
  CHECK(one.noise_variance == three.noise_variance);
  CHECK(one.omega == three.omega);
}

TEST_CASE("what cannot be trained is refused by name") {
  const Rows rows = smooth_rows(6, 2, 4, 0.1, 17);
  const MvgpOptions paper = paper_mvgp_options(2);
  const auto with = [&](auto&& change) {
    MvgpOptions options = paper;
    change(options);
    return refused_as(Fault::data, [&] { return train_mvgp(rows.X, rows.Y, {}, options); });
  };
  CHECK(with([](MvgpOptions&) {}) == "");
  CHECK(with([](MvgpOptions& o) { o.psi = Matrix::Zero(1, 1); }) == "mvgp.bad_prior");
  CHECK(with([](MvgpOptions& o) { o.nu = 3; }) == "mvgp.bad_prior");
  CHECK(with([](MvgpOptions& o) { o.row_noise = Vector::Zero(6); }) == "mvgp.shape");
  CHECK(with([](MvgpOptions& o) { o.kernel = se_ard_kernel(3); }) == "kernel.bad_inputs");
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(Matrix(0, 2), Matrix(0, 4), {}, paper); }) == "mvgp.no_rows");
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X, rows.Y.topRows(3), {}, paper); }) == "mvgp.shape");
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X, rows.Y * std::nan(""), {}, paper); }) ==
        "mvgp.not_finite");
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X, rows.Y, Matrix::Ones(4, 4), paper); }) ==
        "mvgp.bad_transform");
  MvgpOptions linear = paper;
  linear.mean = MeanType::linear;
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X.topRows(2), rows.Y.topRows(2), {}, linear); }) ==
        "mvgp.mean_rank");
  MvgpOptions ml = paper;
  ml.omega = OmegaRule::ml;
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X, rows.Y, {}, ml); }) == "");
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(rows.X.topRows(4), rows.Y.topRows(4), {}, ml); }) ==
        "mvgp.omega_unbounded");
}

TEST_CASE(
    "groups of outputs with one kernel: one group is the plain training, several lie where their sum is greatest") {
  const Rows rows = smooth_rows(12, 2, 4, 0.05, 91);
  MvgpOptions options = default_mvgp_options(2);
  const MvgpModel plain = train_mvgp(rows.X, rows.Y, {}, options);
  const auto groups = train_mvgp(rows.X, std::vector<Matrix>{rows.Y, 3 * rows.Y.leftCols(2)}, {}, options);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].noise_variance == groups[1].noise_variance);
  CHECK(log_hyperparameters(groups[0].kernel) == log_hyperparameters(groups[1].kernel));
  CHECK(groups[1].Y.cols() == 2);
  const auto one = train_mvgp(rows.X, std::vector<Matrix>{rows.Y}, {}, options);
  CHECK(log_hyperparameters(one.front().kernel) == log_hyperparameters(plain.kernel));
}

TEST_CASE("a mean that is known beforehand leaves its residual to the process") {
  const Rows rows = smooth_rows(12, 2, 4, 0.05, 91);
  Matrix A = Matrix::Identity(rows.Y.cols(), rows.Y.cols());
  A.diagonal().array() += 0.5;
  MvgpOptions options = default_mvgp_options(2);
  options.mean = MeanType::linear;
  options.coefficients = Matrix::Constant(3, rows.Y.cols(), 0.7);
  const MvgpModel model = train_mvgp(rows.X, rows.Y, A, options);
  const Matrix M = mean_basis(MeanType::linear, rows.X) * options.coefficients;
  options.mean = MeanType::zero;
  const Matrix coefficients = options.coefficients;
  options.coefficients = {};
  const MvgpModel rest = train_mvgp(rows.X, rows.Y - M, A, options);
  CHECK(model.coefficients == coefficients * A);
  CHECK((log_hyperparameters(model.kernel) - log_hyperparameters(rest.kernel)).norm() < 1e-6);
  CHECK(model.log_marginal_likelihood == Approx(rest.log_marginal_likelihood).epsilon(1e-9));
  const Vector x = rows.X.row(1).transpose() * 1.1;
  const Vector expected =
      predict(rest, x).mean + (mean_basis(MeanType::linear, x.transpose()) * coefficients).transpose();
  CHECK((predict(model, x).mean - expected).norm() < 1e-6 * (1 + expected.norm()));
  CHECK(log_evidence(model) == Approx(model.log_marginal_likelihood).epsilon(1e-12));
}

TEST_CASE("a Student-t process has at least the evidence of the Gaussian one, and finds how sure its prior is") {
  const Matrix X = smooth_rows(14, 2, 8, 0.05, 301).X;
  // Outputs of one size and of sizes that differ by a hundred, so that a prior of equal ones is right and wrong.
  const Matrix equal = smooth_rows(14, 2, 8, 0.05, 301).Y;
  const Matrix unequal = equal * Vector(Vector::LinSpaced(8, 0, -4.6).array().exp()).asDiagonal();
  MvgpOptions options = paper_mvgp_options(2);
  std::vector<double> delta;
  for (const Matrix& Y : {equal, unequal}) {
    options.process = ProcessType::gaussian;
    const MvgpModel gaussian = train_mvgp(X, Y, {}, options);
    options.process = ProcessType::student_t;
    const MvgpModel student = train_mvgp(X, Y, {}, options);
    CHECK(student.log_marginal_likelihood >= gaussian.log_marginal_likelihood - 1e-6);
    delta.push_back(student.nu - 9);
    CHECK(student.psi(0, 0) == Approx(delta.back() * gaussian.psi(0, 0)).epsilon(1e-12));
    CHECK(predict(student, X.row(0).transpose()).degrees_of_freedom == Approx(delta.back() + 2 + 14));
    // The file's fields say the same again.
    CHECK(log_evidence(student) == Approx(student.log_marginal_likelihood).epsilon(1e-12));
  }
  CHECK(delta[1] < delta[0]);

  // One nu for groups that share their hyperparameters; taken as it is where nothing is searched for.
  const auto shared = train_mvgp(X, {equal, unequal}, {}, options);
  CHECK(shared[0].nu == shared[1].nu);
  options.optimise = false;
  options.nu = shared[0].nu;
  CHECK(train_mvgp(X, equal, {}, options).psi.isApprox(shared[0].psi, 1e-12));
  options.nu = 9;
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(X, equal, {}, options); }) == "mvgp.bad_prior");
  options = paper_mvgp_options(2);
  options.process = ProcessType::student_t;
  options.omega = OmegaRule::ml;
  CHECK(refused_as(Fault::data, [&] { return train_mvgp(X, equal, {}, options); }) == "mvgp.omega_unbounded");
}
