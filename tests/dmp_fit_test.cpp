#include "lfdtools/dmp_fit.hpp"

#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

Trajectory sampled(const Vector& times, const auto& position) {
  Trajectory trajectory{times, Samples(times.size(), 1)};
  for (Eigen::Index k = 0; k < times.size(); ++k) trajectory.positions(k, 0) = position(times[k]);
  return trajectory;
}

// A bump of 10 cm on a minimum-jerk reach of 30 cm, over one second.
double bump(double s) {
  return 0.3 * s * s * s * (10 - 15 * s + 6 * s * s) + 0.1 * std::exp(-0.5 * std::pow((s - 0.5) / 0.08, 2));
}

double rms(const Samples& difference) {
  return std::sqrt(difference.squaredNorm() / static_cast<double>(difference.size()));
}

std::vector<Trajectory> recordings(const std::string& set) {
  std::vector<Trajectory> demos;
  std::ifstream file(std::string(LFD_DATA_DIR) + "/" + set + "/demos.csv");
  std::string line;
  std::string last;
  std::vector<std::array<double, 4>> rows;
  const auto close = [&] {
    if (rows.empty()) return;
    const auto T = static_cast<Eigen::Index>(rows.size());
    Trajectory demo{Vector(T), Samples(T, 3)};
    for (Eigen::Index k = 0; k < T; ++k) {
      const auto& [t, x, y, z] = rows[static_cast<std::size_t>(k)];
      demo.times[k] = t;
      demo.positions.row(k) << x, y, z;
    }
    demos.push_back(std::move(demo));
    rows.clear();
  };
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string target;
    std::string demo;
    char comma = 0;
    std::array<double, 4> v{};
    std::getline(cells, target, ',');
    std::getline(cells, demo, ',');
    cells >> v[0] >> comma >> v[1] >> comma >> v[2] >> comma >> v[3];
    if (std::exchange(last, target + "," + demo) != last) close();
    rows.push_back(v);
  }
  close();
  return demos;
}

}  // namespace

TEST_CASE("differences are exact on cubics over uneven times, ends included, and of second order") {
  Random random(4);
  Vector t(12);
  t[0] = 3;
  for (int k = 1; k < 12; ++k) t[k] = t[k - 1] + random.uniform(0.01, 0.2);
  const Derivatives d = difference(sampled(t, [](double s) { return 1 - s + 2 * s * s - 0.5 * s * s * s; }));
  for (int k = 0; k < 12; ++k) {
    CHECK(d.first(k, 0) == Approx(-1 + 4 * t[k] - 1.5 * t[k] * t[k]).margin(1e-9));
    CHECK(d.second(k, 0) == Approx(4 - 3 * t[k]).margin(1e-8));
  }
  const auto worst = [](int n) {
    Vector times(n);  // spacing that varies by a factor of three
    for (int k = 0; k < n; ++k) times[k] = (k + 0.25 * std::sin(2.0 * k)) / n;
    const Derivatives e = difference(sampled(times, [](double s) { return std::sin(6 * s); }));
    double error = 0;
    for (int k = 0; k < n; ++k) error = std::max(error, std::abs(e.second(k, 0) + 36 * std::sin(6 * times[k])));
    return error;
  };
  CHECK(std::log2(worst(200) / worst(400)) > 1.8);
  Vector three(3);
  three << 0, 1, 3;
  CHECK(difference(sampled(three, [](double s) { return s * s; })).second(1, 0) == Approx(2));
}

TEST_CASE("the target of the forcing term is what drives a motion along the samples, with an error of second order") {
  Dmp dmp{make_dmp_settings(8), 1.5, Vector::Zero(1), Vector::Ones(1), Matrix(1, 8), {}, {}, {}};
  Random random(9);
  for (double& v : dmp.weights.reshaped()) v = random.uniform(-300, 300);
  const auto relative_error = [&](int samples) {
    const Vector t = linspace(0, 1.5, samples);
    const Samples f = forcing_target({t, rollout(dmp, t).positions}, dmp.settings.spring(), dmp.goal);
    const Vector exact =
        forcing_features(dmp.settings.basis(), dmp.settings.canonical().phase(t, 1.5)) * dmp.weights.row(0).transpose();
    return (f.col(0) - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  };
  CHECK(relative_error(1501) < 0.005);
  CHECK(relative_error(1501) / relative_error(3001) > 3.5);
}

TEST_CASE("lwr is the weighted mean of equation 14 and ls its least-squares optimum") {
  const Vector t = linspace(0, 2, 400);
  const Trajectory demo = sampled(t, [](double s) { return bump(s / 2); });
  DmpFitOptions options;
  options.bases = 9;
  options.fit = DmpFitMethod::lwr;
  const Dmp lwr = fit_dmp(demo, options);
  options.fit = DmpFitMethod::ls;
  const Dmp ls = fit_dmp(demo, options);
  const Samples f = forcing_target(demo, lwr.settings.spring(), lwr.goal);
  for (int i = 0; i < 9; ++i) {
    long double top = 0;
    long double bottom = 0;
    for (int k = 0; k < 400; ++k) {
      const long double x = std::exp(-std::log(100.0L) * t[k] / 2);
      const long double psi = std::exp(-0.5L * std::pow((x - lwr.settings.centers[i]) / lwr.settings.widths[i], 2.0L));
      top += psi * x * f(k, 0);
      bottom += psi * x * x;
    }
    CHECK(lwr.weights(0, i) == Approx(static_cast<double>(top / bottom)).epsilon(1e-10));
  }
  const Matrix Phi = forcing_features(ls.settings.basis(), ls.settings.canonical().phase(t, 2));
  const Vector best = (Phi.transpose() * Phi).ldlt().solve(Phi.transpose() * f.col(0));
  CHECK((Phi * (ls.weights.row(0).transpose() - best)).norm() < 1e-7 * f.norm());
}

TEST_CASE("the trajectory fit is the optimum of its weighted, constrained problem, and so is its covariance") {
  const int T = 150;
  const int N = 10;
  const Vector t = linspace(0, 1.2, T);
  Trajectory demo = sampled(t, [](double s) { return bump(s / 1.2); });
  DmpFitOptions options;
  options.bases = N;
  options.sd.resize(T, 1);
  for (int k = 0; k < T; ++k) options.sd(k, 0) = 0.001 + 0.004 * std::pow(std::sin(5 * t[k]), 2);
  const Dmp dmp = fit_dmp(demo, options);
  // Independently: normal equations with the end as an exact constraint, solved as one saddle-point system.
  const double typical = 1 / std::sqrt(options.sd.array().inverse().square().mean());
  const double hold = typical / (10 * std::sqrt(2.0 * T / 40));
  const Matrix R = response_matrix(dmp.settings, 1.2, t);
  const Vector y = demo.positions - free_response(dmp.settings, 1.2, t, dmp.start, dmp.goal).positions;
  const Vector later = 1.2 * linspace(1.05, 3, 40);
  const Matrix Rh = response_matrix(dmp.settings, 1.2, later);
  const Vector yh =
      Vector::Constant(40, dmp.goal[0]) - free_response(dmp.settings, 1.2, later, dmp.start, dmp.goal).positions;
  const Vector precision = options.sd.array().inverse().square();
  const Matrix normal = R.transpose() * precision.asDiagonal() * R + Rh.transpose() * Rh / (hold * hold);
  Matrix saddle = Matrix::Zero(N + 1, N + 1);
  saddle.topLeftCorner(N, N) = normal;
  saddle.col(N).head(N) = R.row(T - 1).transpose();
  saddle.row(N).head(N) = R.row(T - 1);
  Vector right(N + 1);
  right << R.transpose() * (precision.asDiagonal() * y) + Rh.transpose() * yh / (hold * hold), y[T - 1];
  const Vector w = saddle.fullPivLu().solve(right).head(N);
  CHECK((R * (w - dmp.weights.row(0).transpose())).cwiseAbs().maxCoeff() < 1e-8);
  REQUIRE(dmp.weights_covariance.size() == 1);
  // The covariance under the constraint is the leading block of the inverse of the saddle-point matrix.
  const Matrix expected = R * saddle.inverse().topLeftCorner(N, N) * R.transpose();
  const Matrix found = R * dmp.weights_covariance[0] * R.transpose();
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-6 * expected.cwiseAbs().maxCoeff());
  // One standard deviation everywhere changes nothing but the size of the covariance.
  options.sd.setConstant(0.002);
  const Dmp even = fit_dmp(demo, options);
  options.sd.resize(0, 0);
  CHECK((even.weights - fit_dmp(demo, options).weights).cwiseAbs().maxCoeff() <
        1e-6 * even.weights.cwiseAbs().maxCoeff());
}

TEST_CASE("figures of the three fits on a bump of 10 cm at 500 Hz, clean and with noise of 0.5 mm") {
  const Vector t = linspace(0, 1, 501);
  const Trajectory clean = sampled(t, bump);
  Trajectory noisy = clean;
  Random random(3);
  for (double& v : noisy.positions.reshaped()) v += 0.0005 * random.normal();
  const auto millimetres = [&](DmpFitMethod fit, const Trajectory& demo) {
    DmpFitOptions options;
    options.fit = fit;
    return 1e3 * rms(rollout(fit_dmp(demo, options), t).positions - clean.positions);
  };
  CHECK(millimetres(DmpFitMethod::lwr, clean) == Approx(9.70).margin(0.05));
  CHECK(millimetres(DmpFitMethod::lwr, noisy) == Approx(10.0).margin(0.5));
  CHECK(millimetres(DmpFitMethod::ls, clean) == Approx(0.136).margin(0.01));
  CHECK(millimetres(DmpFitMethod::ls, noisy) > 1);
  CHECK(millimetres(DmpFitMethod::trajectory, clean) < 0.14);
  CHECK(millimetres(DmpFitMethod::trajectory, noisy) < 0.25);
}

TEST_CASE("the scaling changes the weights, not the motion, times may start anywhere, rmse is that of the rollout") {
  Trajectory demo = sampled(linspace(0, 1, 120), bump);
  for (const DmpFitMethod fit : {DmpFitMethod::trajectory, DmpFitMethod::ls, DmpFitMethod::lwr}) {
    DmpFitOptions options;
    options.fit = fit;
    const Dmp plain = fit_dmp(demo, options);
    CHECK(plain.rmse[0] == Approx(rms(rollout(plain, demo.times).positions - demo.positions)).epsilon(1e-9));
    options.scaling = DmpScaling::goal;
    const Dmp goal = fit_dmp(demo, options);
    CHECK((goal.weights * 0.3 - plain.weights).cwiseAbs().maxCoeff() < 1e-6 * plain.weights.cwiseAbs().maxCoeff());
    CHECK((rollout(goal, demo.times).positions - rollout(plain, demo.times).positions).cwiseAbs().maxCoeff() < 1e-10);
    Trajectory later = demo;
    later.times.array() += 64;
    CHECK((fit_dmp(later, options).weights - goal.weights).cwiseAbs().maxCoeff() < 1e-5 * goal.weights.norm());
  }
}

TEST_CASE("measured ends replace those of the samples") {
  const Trajectory demo = sampled(linspace(0, 1, 120), bump);
  DmpFitOptions options;
  options.start = Vector::Constant(1, 0.002);
  options.goal = Vector::Constant(1, 0.303);
  const Dmp dmp = fit_dmp(demo, options);
  CHECK(dmp.start[0] == 0.002);
  CHECK(rollout(dmp, Vector::Ones(1)).positions(0, 0) == Approx(0.303).epsilon(1e-8));
}

TEST_CASE("an axis that stands still has zero weights, one whose goal is its start is refused under goal scaling") {
  const Vector t = linspace(0, 1, 100);
  Trajectory demo{t, Samples(100, 3)};
  for (int k = 0; k < 100; ++k) {
    demo.positions.row(k) << bump(t[k]), 0.7, 0.05 * std::pow(std::sin(std::numbers::pi * t[k]), 2);
  }
  demo.positions(99, 2) = demo.positions(0, 2);
  for (const DmpFitMethod fit : {DmpFitMethod::trajectory, DmpFitMethod::ls, DmpFitMethod::lwr}) {
    DmpFitOptions options;
    options.fit = fit;
    const Dmp plain = fit_dmp(demo, options);
    CHECK(plain.weights.row(1).cwiseAbs().maxCoeff() == 0);
    CHECK(plain.weights.row(2).cwiseAbs().maxCoeff() > 1);
    options.scaling = DmpScaling::goal;
    CHECK(refused_as(Fault::data, [&] { (void)fit_dmp(demo, options); }) == "dmp.zero_scale");
    options.allow_small_scale = true;
    const Dmp lifted = fit_dmp(demo, options);
    CHECK(lifted.weights.allFinite());
    CHECK(lifted.weights.row(2).cwiseAbs().maxCoeff() == 0);
  }
  const std::vector<bool> small = small_goal_change(demo, demo.start(), demo.goal());
  CHECK(small == std::vector<bool>{false, false, true});
  Vector goal = demo.goal();
  goal[2] = demo.start()[2] + 0.000499;
  CHECK(small_goal_change(demo, demo.start(), goal)[2]);
  goal[2] = demo.start()[2] + 0.000501;
  CHECK_FALSE(small_goal_change(demo, demo.start(), goal)[2]);
}

TEST_CASE("as many bases as samples, and springs and phases far from the default, keep weights finite") {
  const Trajectory demo = sampled(linspace(0, 1, 40), bump);
  for (const double alpha_x : {1.0, 4.6, 20.0}) {
    for (const double alpha_z : {5.0, 25.0, 200.0}) {
      DmpFitOptions options;
      options.bases = 40;
      options.alpha_x = alpha_x;
      options.alpha_z = alpha_z;
      const Dmp dmp = fit_dmp(demo, options);
      INFO("alpha_x " << alpha_x << " alpha_z " << alpha_z << " weight " << dmp.weights.cwiseAbs().maxCoeff());
      CHECK(dmp.weights.allFinite());
      // A spring slower than the motion cannot be held after it: there the hold costs accuracy.
      if (alpha_z >= 25) CHECK(dmp.rmse[0] < 0.01);
    }
  }
}

TEST_CASE("what cannot be fitted is refused") {
  const Trajectory demo = sampled(linspace(0, 1, 20), bump);
  const auto refused = [&](const auto& change) {
    DmpFitOptions options;
    change(options);
    return refused_as(Fault::data, [&] { (void)fit_dmp(demo, options); });
  };
  CHECK(refused([](DmpFitOptions&) {}) == "");
  CHECK(refused([](DmpFitOptions& o) { o.bases = 21; }) == "dmp.more_bases_than_samples");
  CHECK(refused([](DmpFitOptions& o) { o.bases = 1; }) == "dmp.basis");
  CHECK(refused([](DmpFitOptions& o) { o.alpha_z = 0; }) == "dmp.spring");
  CHECK(refused([](DmpFitOptions& o) { o.alpha_x = -1; }) == "dmp.alpha_x");
  CHECK(refused([](DmpFitOptions& o) { o.goal = Vector::Zero(2); }) == "dmp.shape");
  CHECK(refused([](DmpFitOptions& o) { o.start = Vector::Constant(1, NAN); }) == "dmp.not_finite");
  CHECK(refused([](DmpFitOptions& o) { o.sd = Samples::Ones(19, 1); }) == "dmp.shape");
  CHECK(refused([](DmpFitOptions& o) { o.sd = -Samples::Ones(20, 1); }) == "dmp.not_finite");
  DmpFitOptions endless;
  endless.hold_weight = INFINITY;
  CHECK_THROWS_AS(fit_dmp(demo, endless), UsageError);
  Trajectory two{linspace(0, 1, 2), Samples::Zero(2, 1)};
  CHECK(refused_as(Fault::data, [&] { (void)fit_dmp(two); }) == "dmp.too_few_samples");
}

TEST_CASE("real recordings are reproduced, and the motion ends and rests on its goal") {
  struct Bound {
    const char* set;
    int bases;
    double fit;      // root mean square over all axes [m]
    double stay;     // greatest distance from the goal after tau [m]
    double settled;  // latest settling time [tau]
  };
  for (const Bound& bound :
       {Bound{"hug_reach_S01", 15, 0.0005, 0.0005, 1.6}, Bound{"hug_reach_S01", 30, 0.0002, 0.0003, 1.2},
        Bound{"panda_peg", 15, 0.0047, 0.0001, 1.0}, Bound{"panda_peg", 25, 0.0017, 0.0001, 1.0}}) {
    INFO(bound.set << ", " << bound.bases << " bases");
    double squares = 0;
    double values = 0;
    double settled = 1;
    for (const Trajectory& demo : recordings(bound.set)) {
      DmpFitOptions options;
      options.bases = bound.bases;
      const Dmp dmp = fit_dmp(demo, options);
      squares += dmp.rmse.squaredNorm() * static_cast<double>(demo.samples());
      values += static_cast<double>(demo.positions.size());
      const Matrix off = rollout(dmp, dmp.tau * linspace(1, 4, 301)).positions.rowwise() - dmp.goal.transpose();
      REQUIRE(off.row(0).cwiseAbs().maxCoeff() < 1e-8);
      REQUIRE(off.cwiseAbs().maxCoeff() < bound.stay);
      REQUIRE(dmp.weights.cwiseAbs().maxCoeff() < 4000);
      settled = std::max(settled, settle_time(dmp) / dmp.tau);
    }
    if (values == 0) continue;  // the recordings are not part of the project
    CHECK(std::sqrt(squares / values) < bound.fit);
    CHECK(settled <= bound.settled);
  }
}
