#include "lfdtools/dmp.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/random.hpp"
#include "lfdtools/trajectory.hpp"
#include "refusal.hpp"

using namespace lfd;

namespace {

Dmp random_dmp(const DmpSettings& settings, double tau, Eigen::Index D, std::uint64_t seed, double size = 3000) {
  Random random(seed);
  Dmp dmp;
  dmp.settings = settings;
  dmp.tau = tau;
  dmp.start = Vector::Zero(D);
  dmp.goal = Vector::Zero(D);
  dmp.weights = Matrix::Zero(D, settings.bases());
  for (double& v : dmp.start) v = random.uniform(-1, 1);
  for (double& v : dmp.goal) v = random.uniform(-1, 1);
  for (double& v : dmp.weights.reshaped()) v = random.uniform(-size, size);
  return dmp;
}

// Second opinion: Dormand and Prince's 5(4) pair with its own step control, straight from eq. (8), (10)-(13), in time
// t, for one axis. Returns y and y' at t.
class Solver {
 public:
  explicit Solver(const Dmp& dmp) : dmp_(dmp), y_{1, dmp.start[0], 0} {}

  void to(double t) {
    while (t_ < t) {
      h_ = std::min(h_, t - t_);
      static constexpr long double a[7][6] = {
          {},
          {1.0L / 5},
          {3.0L / 40, 9.0L / 40},
          {44.0L / 45, -56.0L / 15, 32.0L / 9},
          {19372.0L / 6561, -25360.0L / 2187, 64448.0L / 6561, -212.0L / 729},
          {9017.0L / 3168, -355.0L / 33, 46732.0L / 5247, 49.0L / 176, -5103.0L / 18656},
          {35.0L / 384, 0, 500.0L / 1113, 125.0L / 192, -2187.0L / 6784, 11.0L / 84}};
      static constexpr long double low[7] = {
          5179.0L / 57600, 0, 7571.0L / 16695, 393.0L / 640, -92097.0L / 339200, 187.0L / 2100, 1.0L / 40};
      State k[7];
      State high = y_;
      for (int i = 0; i < 7; ++i) {
        State at = y_;
        for (int j = 0; j < i; ++j) at = add(at, k[j], h_ * a[i][j]);
        k[i] = slope(at);
        high = at;  // the last stage is the fifth-order result
      }
      State other = y_;
      for (int i = 0; i < 7; ++i) other = add(other, k[i], h_ * low[i]);
      const long double error = std::max(std::abs(high.y - other.y), std::abs(high.z - other.z) / 100);
      const long double tolerance = 1e-13L;
      if (error <= tolerance) {
        t_ += h_;
        y_ = high;
      }
      h_ *= std::clamp(0.9L * std::pow(tolerance / std::max(error, 1e-30L), 0.2L), 0.2L, 5.0L);
    }
  }
  [[nodiscard]] double y() const { return static_cast<double>(y_.y); }
  [[nodiscard]] double velocity() const { return static_cast<double>(y_.z / dmp_.tau); }

 private:
  struct State {
    long double x, y, z;
  };
  static State add(State a, const State& b, long double h) { return {a.x + h * b.x, a.y + h * b.y, a.z + h * b.z}; }
  [[nodiscard]] State slope(const State& at) const {
    const auto& s = dmp_.settings;
    long double top = 0;
    long double bottom = 0;
    for (Eigen::Index i = 0; i < s.bases(); ++i) {
      const long double u = (at.x - s.centers[i]) / s.widths[i];
      const long double psi = std::exp(-u * u / 2);
      top += psi * dmp_.weights(0, i);
      bottom += psi;
    }
    const long double scale = s.scaling == DmpScaling::goal ? dmp_.goal[0] - dmp_.start[0] : 1;
    const long double f = top / bottom * at.x * scale;
    const long double spring = s.alpha_z * (static_cast<long double>(s.beta_z) * (dmp_.goal[0] - at.y) - at.z);
    return {-s.alpha_x * at.x / dmp_.tau, at.z / dmp_.tau, (spring + f) / dmp_.tau};
  }

  const Dmp& dmp_;
  State y_;
  long double t_ = 0;
  long double h_ = 1e-4L;
};

}  // namespace

TEST_CASE("a rollout agrees with an adaptive solver of the differential equations, past tau as well") {
  struct Case {
    int bases;
    double alpha_z;
    double ratio;
    DmpScaling scaling;
  };
  for (const Case c :
       {Case{15, 25, 0.25, DmpScaling::none}, Case{15, 25, 0.25, DmpScaling::goal}, Case{5, 5, 0.25, DmpScaling::none},
        Case{5, 200, 0.25, DmpScaling::none}, Case{15, 25, 0.05, DmpScaling::none}, Case{15, 25, 2.0, DmpScaling::none},
        Case{40, 100, 0.25, DmpScaling::goal}, Case{100, 25, 0.25, DmpScaling::none},
        Case{2, 10, 1.0, DmpScaling::none}}) {
    INFO("bases " << c.bases << " alpha_z " << c.alpha_z << " ratio " << c.ratio);
    const DmpSettings settings = make_dmp_settings(c.bases, c.scaling, c.alpha_z, c.alpha_z * c.ratio);
    const Dmp dmp = random_dmp(settings, 2.5, 1, static_cast<std::uint64_t>(c.bases));
    const Motion motion = rollout(dmp, linspace(0, 5, 41));
    Solver solver(dmp);
    for (int k = 0; k <= 40; ++k) {
      solver.to(motion.times[k]);
      REQUIRE(std::abs(motion.positions(k, 0) - solver.y()) < 1e-9);
      REQUIRE(std::abs(motion.velocities(k, 0) - solver.velocity()) < 1e-8);
    }
  }
}

TEST_CASE("without weights the motion is the free response, and that is the closed form of critical damping") {
  Dmp dmp = random_dmp(make_dmp_settings(), 3, 2, 5, 0);
  const Vector t = linspace(0, 6, 61);
  const Motion motion = rollout(dmp, t);
  const Motion free = free_response(dmp.settings, 3, t, dmp.start, dmp.goal);
  CHECK((motion.positions - free.positions).cwiseAbs().maxCoeff() < 1e-14);
  CHECK((motion.velocities - free.velocities).cwiseAbs().maxCoeff() < 1e-14);
  CHECK((motion.accelerations - free.accelerations).cwiseAbs().maxCoeff() < 1e-13);
  for (int k = 0; k < 61; ++k) {
    const double a = 12.5 * t[k] / 3;
    const double left = (1 + a) * std::exp(-a);
    CHECK(free.positions(k, 1) == Approx(dmp.goal[1] + left * (dmp.start[1] - dmp.goal[1])).margin(1e-14));
  }
}

TEST_CASE("position, velocity and acceleration are derivatives of one another") {
  const Dmp dmp = random_dmp(make_dmp_settings(15), 1.7, 3, 11);
  const double h = 1e-4;
  for (const double t : {0.2, 0.777, 1.3, 1.7, 2.4}) {
    Vector around(5);
    around << t - 2 * h, t - h, t, t + h, t + 2 * h;
    const Motion m = rollout(dmp, around);
    // Five-point differences: error of fourth order.
    const auto slope = [&](const Samples& y) -> Vector {
      return ((y.row(0) - y.row(4)) + 8 * (y.row(3) - y.row(1))).transpose() / (12 * h);
    };
    CHECK((slope(m.positions) - m.velocities.row(2).transpose()).cwiseAbs().maxCoeff() < 1e-8);
    CHECK((slope(m.velocities) - m.accelerations.row(2).transpose()).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("the motion starts at rest on its start, and the result at a time does not depend on the other times") {
  const Dmp dmp = random_dmp(make_dmp_settings(15), 2, 3, 3);
  const Motion fine = rollout(dmp, linspace(0, 3, 3001));
  CHECK((fine.positions.row(0).transpose() - dmp.start).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(fine.velocities.row(0).cwiseAbs().maxCoeff() == 0);
  for (const int step : {7, 100, 999}) {
    for (int k = 0; k <= 3000; k += step) {
      const Motion one = rollout(dmp, Vector::Constant(1, fine.times[k]));
      REQUIRE(one.positions.row(0) == fine.positions.row(k));
      REQUIRE(one.accelerations.row(0) == fine.accelerations.row(k));
    }
  }
}

TEST_CASE("responses are the linear map from weights to the motion") {
  for (const DmpScaling scaling : {DmpScaling::none, DmpScaling::goal}) {
    const Dmp dmp = random_dmp(make_dmp_settings(12, scaling, 40, 8.0), 1.6, 2, 21, 500);
    const Vector t = linspace(0, 3, 31);
    const Motion base = rollout(dmp, t);
    const Motion free = free_response(dmp.settings, dmp.tau, t, dmp.start, dmp.goal);
    const DmpResponse R = response(dmp.settings, dmp.tau, t);
    const Vector s = dmp.scale();
    for (int d = 0; d < 2; ++d) {
      const Vector w = s[d] * dmp.weights.row(d).transpose();
      CHECK((free.positions.col(d) + R.position * w - base.positions.col(d)).cwiseAbs().maxCoeff() < 1e-11);
      CHECK((free.velocities.col(d) + R.velocity * w - base.velocities.col(d)).cwiseAbs().maxCoeff() < 1e-10);
      CHECK((free.accelerations.col(d) + R.acceleration * w - base.accelerations.col(d)).cwiseAbs().maxCoeff() < 1e-9);
    }
    // Differences of rollouts, one weight at a time.
    for (int i = 0; i < 12; ++i) {
      Dmp moved = dmp;
      moved.weights(1, i) += 1;
      const Motion m = rollout(moved, t);
      CHECK((m.positions.col(1) - base.positions.col(1) - s[1] * R.position.col(i)).cwiseAbs().maxCoeff() < 1e-9);
      CHECK((m.velocities.col(1) - base.velocities.col(1) - s[1] * R.velocity.col(i)).cwiseAbs().maxCoeff() < 1e-9);
      CHECK((m.accelerations.col(1) - base.accelerations.col(1) - s[1] * R.acceleration.col(i)).cwiseAbs().maxCoeff() <
            1e-9);
      CHECK(m.positions.col(0) == base.positions.col(0));
    }
  }
}

TEST_CASE("a longer duration stretches time and nothing else") {
  Dmp dmp = random_dmp(make_dmp_settings(15), 1, 2, 8);
  const Vector s = linspace(0, 2, 41);
  const Motion quick = rollout(dmp, s);
  dmp.tau = 4;
  const Motion slow = rollout(dmp, 4 * s);
  CHECK((quick.positions - slow.positions).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((quick.velocities - 4 * slow.velocities).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((response_matrix(dmp.settings, 1, s) - response_matrix(dmp.settings, 4, 4 * s)).cwiseAbs().maxCoeff() < 1e-16);
}

TEST_CASE("long after tau the motion lies on its goal, however late it is asked for") {
  const Dmp dmp = random_dmp(make_dmp_settings(15), 2, 3, 31);
  Vector t(3);
  t << 20, 60, 1e9;
  const Motion m = rollout(dmp, t);
  for (int k = 0; k < 3; ++k) CHECK((m.positions.row(k).transpose() - dmp.goal).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(m.velocities.row(2).cwiseAbs().maxCoeff() == 0);
}

TEST_CASE("the settling time is the first of the grid after which everything stays inside, checked on a finer grid") {
  const Dmp dmp = random_dmp(make_dmp_settings(15), 2, 3, 41);
  const double settled = settle_time(dmp);
  REQUIRE(settled > 2.02);
  const Vector t = linspace(settled, 20, 20001);
  const Motion after = rollout(dmp, t);
  CHECK((after.positions.rowwise() - dmp.goal.transpose()).cwiseAbs().maxCoeff() <= 1e-4);
  CHECK(after.velocities.cwiseAbs().maxCoeff() <= 1e-3);
  const Motion before = rollout(dmp, Vector::Constant(1, settled - 0.01));
  const double distance = (before.positions.row(0) - dmp.goal.transpose()).cwiseAbs().maxCoeff();
  CHECK((distance > 1e-4 || before.velocities.cwiseAbs().maxCoeff() > 1e-3));
  Dmp still = dmp;
  still.goal = still.start;
  still.weights.setZero();
  CHECK(settle_time(still) == still.tau);
  Dmp endless = dmp;
  endless.settings.alpha_x = 1e-3;
  CHECK(refused_as(Fault::data, [&] { (void)settle_time(endless); }) == "dmp.does_not_settle");
}

TEST_CASE("primitives and times that cannot be used are refused") {
  const Dmp good = random_dmp(make_dmp_settings(5), 1, 2, 1);
  const Vector t = linspace(0, 1, 3);
  const auto refused = [&](const auto& change) {
    Dmp bad = good;
    change(bad);
    return refused_as(Fault::data, [&] { (void)rollout(bad, t); });
  };
  CHECK(refused([](Dmp&) {}) == "");
  CHECK(refused([](Dmp& d) { d.tau = 0; }) == "dmp.duration");
  CHECK(refused([](Dmp& d) { d.tau = std::nan(""); }) == "dmp.duration");
  CHECK(refused([](Dmp& d) { d.weights(0, 0) = std::nan(""); }) == "dmp.not_finite");
  CHECK(refused([](Dmp& d) { d.goal = Vector::Zero(3); }) == "dmp.shape");
  CHECK(refused([](Dmp& d) { d.weights = Matrix::Zero(2, 4); }) == "dmp.shape");
  CHECK(refused([](Dmp& d) { d.settings.widths[1] = 0; }) == "dmp.basis");
  CHECK(refused([](Dmp& d) { d.settings.beta_z = -1; }) == "dmp.spring");
  CHECK(refused([](Dmp& d) { d.settings.alpha_x = 0; }) == "dmp.alpha_x");
  CHECK(refused_as(Fault::data, [&] { (void)rollout(good, -t); }) == "dmp.times");
  CHECK(refused_as(Fault::data, [&] { (void)rollout(good, t.reverse()); }) == "dmp.times");
  CHECK(refused_as(Fault::data, [&] { (void)rollout(good, Vector::Constant(1, INFINITY)); }) == "dmp.times");
  CHECK(rollout(good, Vector()).positions.rows() == 0);
}
