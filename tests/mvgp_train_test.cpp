// Training: the optimum, degenerate data, determinism, refusals.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/mvgp.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

Matrix random_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return Matrix::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

struct Rows {
  Matrix X, Y;
};

/// Smooth outputs: random sinusoids of the inputs, the last `idle` inputs without effect.
Rows smooth_rows(int n, int p, int d, double noise, std::uint64_t seed, int idle = 0) {
  Rows rows{0.3 * random_matrix(n, p, seed), Matrix::Zero(n, d)};
  const Matrix slopes = 2.5 * random_matrix(p - idle, 6, seed + 1);
  const Matrix amplitudes = random_matrix(6, d, seed + 2);
  const Matrix phases = 3.0 * random_matrix(1, 6, seed + 3);
  const Matrix waves = (rows.X.leftCols(p - idle) * slopes).rowwise() + phases.row(0);
  rows.Y = waves.array().sin().matrix() * amplitudes + noise * random_matrix(n, d, seed + 4);
  return rows;
}

/// The documented box of a kernel of se-ard terms.
bool in_box(const Vector& theta, const Matrix& X, const Kernel& kernel) {
  const Kernel moved = with_log_hyperparameters(kernel, theta.head(theta.size() - 1));
  bool inside = std::exp(theta(theta.size() - 1)) >= 1e-14 && std::exp(theta(theta.size() - 1)) <= 1e2;
  for (const auto& term : moved.terms) {
    inside = inside && term.variance >= 1e-12 && term.variance <= 1e4;
    if (term.type != KernelType::se_ard) continue;
    for (std::size_t q = 0; q < term.inputs.size(); ++q) {
      const auto x = X.col(term.inputs[q]);
      const double l = term.length_scales(static_cast<Eigen::Index>(q)) / (x.maxCoeff() - x.minCoeff());
      inside = inside && l >= 1e-3 && l <= 1e3;
    }
  }
  return inside;
}

/// Highest log evidence among draws of length scales, variances and noise over four decades each.
double best_of_draws(const Rows& rows, const MvgpModel& model, int draws, std::uint64_t seed) {
  Evidence evidence(rows.X, rows.Y, model.kernel, {model.omega_rule, model.mean, model.psi, model.nu, {}});
  const Vector fitted = log_hyperparameters(model.kernel);
  Random random(seed);
  double best = -1e300;
  for (int i = 0; i < draws; ++i) {
    Vector theta(evidence.size());
    for (auto& value : theta) value = random.uniform(std::log(1e-2), std::log(1e2));
    theta(theta.size() - 1) = random.uniform(std::log(1e-4), 0.0);
    if (i % 2 == 1) {  // every other draw near what was found: a descent that stopped early loses to these
      theta.head(fitted.size()) = fitted;
      theta(theta.size() - 1) = std::log(model.noise_variance);
      for (auto& value : theta) value += random.uniform(-0.7, 0.7);
    }
    if (!in_box(theta, rows.X, model.kernel)) continue;
    best = std::max(best, -evidence(theta));
  }
  return best;
}

bool all_finite(const MvgpModel& model) {
  const MvgpPrediction prediction = predict(model, model.X.row(0).transpose());
  return log_hyperparameters(model.kernel).allFinite() && std::isfinite(model.noise_variance) &&
         model.noise_variance > 0 && model.omega.allFinite() && std::isfinite(model.log_marginal_likelihood) &&
         prediction.mean.allFinite() && std::isfinite(prediction.variance);
}

template <typename Call>
std::string id_of(Call&& call) {
  try {
    (void)call();
  } catch (const DataError& error) {
    return error.id();
  }
  return "";
}

}  // namespace

TEST_CASE("no random draw beats the hyperparameters found by 0.05 nats") {
  const auto seed = static_cast<std::uint64_t>(GENERATE(range(0, 6))) * 100;
  Rows rows = smooth_rows(9, 3, 15, 0.05, seed + 1);
  SECTION("nine rows, three inputs") {}
  SECTION("one input") {
    rows = smooth_rows(9, 1, 15, 0.02, seed + 2);
  }
  SECTION("more outputs than a joint model of three axes") {
    rows = smooth_rows(6, 3, 45, 0.1, seed + 3);
  }
  SECTION("without noise") {
    rows = smooth_rows(9, 2, 15, 0, seed + 4);
  }
  SECTION("two inputs without effect: their length scales lie at infinity") {
    rows = smooth_rows(12, 3, 8, 0.05, seed + 5, 2);
  }
  SECTION("noise alone") {
    rows.Y = random_matrix(9, 15, seed + 6);
  }
  SECTION("rows that coincide") {
    rows.X.row(5) = rows.X.row(2);
    rows.X.row(7) = rows.X.row(2);
  }
  SECTION("all rows on a line") {
    rows.X = rows.X.col(0) * random_matrix(1, 3, seed + 7);
  }
  SECTION("outputs that are all in proportion") {
    rows.Y = rows.Y.col(0) * random_matrix(1, 15, seed + 8);
  }
  SECTION("two rows") {
    rows = smooth_rows(2, 3, 15, 0.05, seed + 9);
  }
  SECTION("more rows than outputs") {
    rows = smooth_rows(40, 2, 3, 0.2, seed + 10);
  }
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, paper_mvgp_options(static_cast<int>(rows.X.cols())));
  CHECK(best_of_draws(rows, model, 4000, seed) < model.log_marginal_likelihood + 0.05);
}

TEST_CASE("no random draw beats a sum of kernels") {
  const auto seed = static_cast<std::uint64_t>(GENERATE(range(0, 4))) * 10;
  const Rows rows = smooth_rows(15, 2, 10, 0.1, seed);
  MvgpOptions options;
  options.kernel = sum_kernel(2);
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, options);
  CHECK(best_of_draws(rows, model, 4000, seed) < model.log_marginal_likelihood + 0.05);
}

TEST_CASE("many rows, where the starts compete on a part of them, end as well as a descent on all") {
  const Rows rows = smooth_rows(200, 2, 5, 0.3, 7);
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, paper_mvgp_options(2));
  CHECK(best_of_draws(rows, model, 200, 1) < model.log_marginal_likelihood + 0.05);
  // The noise that was put in is found again: Omega is shared out, so compare its product with the noise.
  const double noise = model.noise_variance * model.omega.trace() / 5;
  CHECK(std::sqrt(noise) == Approx(0.3).epsilon(0.1));
}

TEST_CASE("an irrelevant input and a smooth one are told apart") {
  const Rows rows = smooth_rows(30, 2, 10, 0.05, 3, 1);
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, paper_mvgp_options(2));
  const Vector l = model.kernel.terms.front().length_scales;
  CHECK(l(1) > 20 * l(0));
}

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

TEST_CASE("evidence to a power p is evidence beside priors that are wider by 1 / p in variance") {
  // p (E + z^2 / (2 s^2 p)) = p E + z^2 / (2 s^2)
  const Rows rows = smooth_rows(14, 2, 6, 0.3, 31);
  constexpr double p = 0.3;
  MvgpOptions options = default_mvgp_options(2);
  const MvgpModel full = train_mvgp(rows.X, rows.Y, {}, options);
  options.evidence_power = p;
  const MvgpModel weak = train_mvgp(rows.X, rows.Y, {}, options);
  options.evidence_power = 1;
  for (LogNormalPrior* prior : {&options.length_scale, &options.variance, &options.noise})
    prior->log_sd *= std::sqrt(p);
  const MvgpModel narrow = train_mvgp(rows.X, rows.Y, {}, options);
  const auto theta = [](const MvgpModel& model) {
    Vector all(log_hyperparameters(model.kernel).size() + 1);
    all << log_hyperparameters(model.kernel), std::log(model.noise_variance);
    return all;
  };
  CHECK((theta(weak) - theta(narrow)).cwiseAbs().maxCoeff() < 0.02);
  CHECK((theta(weak) - theta(full)).cwiseAbs().maxCoeff() > 0.2);

  // Without priors the power changes nothing.
  MvgpOptions paper = paper_mvgp_options(2);
  const MvgpModel one = train_mvgp(rows.X, rows.Y, {}, paper);
  paper.evidence_power = 0.5;
  CHECK((theta(train_mvgp(rows.X, rows.Y, {}, paper)) - theta(one)).cwiseAbs().maxCoeff() < 0.02);
  paper.evidence_power = 0;
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y, {}, paper); }) == "mvgp.bad_prior");
  paper.evidence_power = 1.5;
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y, {}, paper); }) == "mvgp.bad_prior");
}

TEST_CASE("no point of a fine grid beats evidence to a power times priors") {
  const Rows rows = smooth_rows(12, 1, 3, 0.2, 41);
  const double range = rows.X.maxCoeff() - rows.X.minCoeff();
  MvgpOptions options = paper_mvgp_options(1);
  options.evidence_power = 0.25;
  options.length_scale = {2.0, 1.0};
  options.noise = {0.1, 2.0};
  const MvgpModel model = train_mvgp(rows.X, rows.Y, {}, options);
  Evidence evidence(rows.X, rows.Y, model.kernel, {model.omega_rule, model.mean, model.psi, model.nu, {}});
  const auto objective = [&](double log_l, double log_noise) {
    Vector theta(2);
    theta << log_l, log_noise;
    return 0.25 * evidence(theta) + std::pow(log_l - std::log(2 * range), 2) / 2 +
           std::pow((log_noise - std::log(0.1)) / 2, 2) / 2;
  };
  double best = 1e300;
  for (double log_l = std::log(0.01 * range); log_l < std::log(100 * range); log_l += 0.05) {
    for (double log_noise = std::log(1e-6); log_noise < std::log(10.0); log_noise += 0.05) {
      best = std::min(best, objective(log_l, log_noise));
    }
  }
  const double found = objective(std::log(model.kernel.terms[0].length_scales(0)), std::log(model.noise_variance));
  CHECK(found < best + 1e-6);
  CHECK(found > best - 0.01);  // the grid is that fine
}

TEST_CASE("outputs in which nothing happens do not speak for the hyperparameters of the others") {
  const Rows rows = smooth_rows(10, 2, 4, 0.1, 51);
  const MvgpOptions options = default_mvgp_options(2);
  const MvgpModel alone = train_mvgp(rows.X, rows.Y, {}, options);
  const auto beside = [&](double size) {
    return train_mvgp(rows.X, std::vector<Matrix>{rows.Y, size * random_matrix(10, 4, 52)}, {}, options);
  };
  // Shares of the mean square: 0, under 1e-7, over 1e-7.
  for (const double size : {0.0, 1e-5}) {
    const auto models = beside(size);
    CHECK(log_hyperparameters(models[0].kernel) == log_hyperparameters(alone.kernel));
    CHECK(models[1].noise_variance == alone.noise_variance);
    CHECK(models[0].log_marginal_likelihood == alone.log_marginal_likelihood);
  }
  CHECK(beside(1e-2)[0].noise_variance > 1.1 * alone.noise_variance);

  // Two outputs turned into five dimensions: the evidence of the two, Omega's prior marginalised with them.
  MvgpOptions known = options;
  known.psi = Matrix::Constant(1, 1, 0.4);
  const MvgpModel two = train_mvgp(rows.X, rows.Y.leftCols(2), {}, known);
  const Matrix turn = Eigen::HouseholderQR<Matrix>(random_matrix(5, 5, 53)).householderQ();
  const MvgpModel five = train_mvgp(rows.X, rows.Y.leftCols(2) * turn.topRows(2), {}, known);
  CHECK((log_hyperparameters(five.kernel) - log_hyperparameters(two.kernel)).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(five.noise_variance == Approx(two.noise_variance).epsilon(1e-3));
  known.smallest_share = 0;  // the three empty directions of five are then proof of no noise
  CHECK(train_mvgp(rows.X, rows.Y.leftCols(2) * turn.topRows(2), {}, known).noise_variance !=
        Approx(two.noise_variance));
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

TEST_CASE("priors draw hyperparameters towards their medians") {
  const Rows rows = smooth_rows(9, 2, 5, 0.05, 15, 1);
  MvgpOptions options = paper_mvgp_options(2);
  const double free = train_mvgp(rows.X, rows.Y, {}, options).kernel.terms[0].length_scales(1);
  options.length_scale = {2.0, 0.01};
  const double held = train_mvgp(rows.X, rows.Y, {}, options).kernel.terms[0].length_scales(1);
  const double range = rows.X.col(1).maxCoeff() - rows.X.col(1).minCoeff();
  CHECK(held == Approx(2 * range).epsilon(0.02));
  CHECK(std::abs(free - 2 * range) > 0.5 * range);
}

TEST_CASE("what cannot be trained is refused by name") {
  const Rows rows = smooth_rows(6, 2, 4, 0.1, 17);
  const MvgpOptions paper = paper_mvgp_options(2);
  const auto with = [&](auto&& change) {
    MvgpOptions options = paper;
    change(options);
    return id_of([&] { return train_mvgp(rows.X, rows.Y, {}, options); });
  };
  CHECK(with([](MvgpOptions&) {}) == "");
  CHECK(with([](MvgpOptions& o) { o.psi = Matrix::Zero(1, 1); }) == "mvgp.bad_prior");
  CHECK(with([](MvgpOptions& o) { o.nu = 3; }) == "mvgp.bad_prior");
  CHECK(with([](MvgpOptions& o) { o.row_noise = Vector::Zero(6); }) == "mvgp.shape");
  CHECK(with([](MvgpOptions& o) { o.kernel = se_ard_kernel(3); }) == "kernel.bad_inputs");
  CHECK(id_of([&] { return train_mvgp(Matrix(0, 2), Matrix(0, 4), {}, paper); }) == "mvgp.no_rows");
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y.topRows(3), {}, paper); }) == "mvgp.shape");
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y * std::nan(""), {}, paper); }) == "mvgp.not_finite");
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y, Matrix::Ones(4, 4), paper); }) == "mvgp.bad_transform");
  MvgpOptions linear = paper;
  linear.mean = MeanType::linear;
  CHECK(id_of([&] { return train_mvgp(rows.X.topRows(2), rows.Y.topRows(2), {}, linear); }) == "mvgp.mean_rank");
  MvgpOptions ml = paper;
  ml.omega = OmegaRule::ml;
  CHECK(id_of([&] { return train_mvgp(rows.X, rows.Y, {}, ml); }) == "");
  CHECK(id_of([&] { return train_mvgp(rows.X.topRows(4), rows.Y.topRows(4), {}, ml); }) == "mvgp.omega_unbounded");
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
  CHECK(id_of([&] { return train_mvgp(X, equal, {}, options); }) == "mvgp.bad_prior");
  options = paper_mvgp_options(2);
  options.process = ProcessType::student_t;
  options.omega = OmegaRule::ml;
  CHECK(id_of([&] { return train_mvgp(X, equal, {}, options); }) == "mvgp.omega_unbounded");
}
