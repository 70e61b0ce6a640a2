// Hyperparameters: the optimum that is found, beside draws and grids, priors and powers of the evidence.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/mvgp.hpp"
#include "lfdtools/random.hpp"
#include "process_fixture.hpp"

using namespace lfd;

namespace {

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
  CHECK_THROWS_AS(train_mvgp(rows.X, rows.Y, {}, paper), DataError);
  paper.evidence_power = 1.5;
  CHECK_THROWS_AS(train_mvgp(rows.X, rows.Y, {}, paper), DataError);
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
