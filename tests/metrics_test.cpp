#include "lfdtools/metrics.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"

using namespace lfd;

namespace {
Trajectory sampled(int n, double duration, const std::function<Vector(double)>& y) {
  Trajectory motion{linspace(2.0, 2.0 + duration, n), Samples(n, y(0).size())};
  for (int i = 0; i < n; ++i) motion.positions.row(i) = y(duration * i / (n - 1)).transpose();
  return motion;
}
Vector vec(double x, double y, double z) {
  return (Vector(3) << x, y, z).finished();
}
}  // namespace

TEST_CASE("phases are linear in time, whatever the first time stamp, and rest after the last sample") {
  const auto motion = sampled(50, 4, [](double t) { return vec(t, 1, t * t); });
  const Samples whole = at_phases(motion, 5);
  for (int k = 0; k < 5; ++k) CHECK(whole(k, 2) == Approx(k * k).margin(1e-12));
  const Samples longer = at_phases(motion, 5, 8);
  CHECK(longer(1, 0) == Approx(2));
  CHECK(longer(4, 0) == Approx(4));
}

TEST_CASE("the mean path of two lines is the line between them") {
  const auto a = sampled(20, 1, [](double t) { return vec(t, 0, 0); });
  const auto b = sampled(31, 3, [](double t) { return vec(t / 3, 0.2, 0); });
  const Samples mean = mean_path({a, b}, 11);
  CHECK(mean(5, 0) == Approx(0.5));
  CHECK(mean(5, 1) == Approx(0.1));
  CHECK(rms_distance(at_phases(a, 11), mean) == Approx(0.1));
  CHECK_THROWS_AS(mean_path({}, 11), DataError);
}

TEST_CASE("a path that bends 30 mm before its end arrives along its last straight stretch") {
  Samples path(4, 3);
  path << 0, 0, 0.03, 0.001, 0, 0.03, 0, 0, 0.03, 0, 0, 0;
  const Arrival a = arrival(path);
  CHECK((a.direction - vec(0, 0, -1)).norm() < 1e-12);
  CHECK(angle_between(a.direction, vec(0, std::sin(0.1), -std::cos(0.1))) == Approx(0.1).epsilon(1e-12));
  CHECK(angle_between(a.direction, a.direction) == 0);
  CHECK(angle_between(a.direction, -a.direction) == Approx(M_PI));
}

TEST_CASE("a path that never leaves the ball has no direction of arrival") {
  Samples path = Samples::Zero(3, 3);
  path(0, 0) = 0.001;
  CHECK(arrival(path).direction.norm() == 0);
}

TEST_CASE("lateral deviation is the distance from the line, inside the ball alone") {
  Samples path(4, 3);
  path << 0.5, 0, 0.5, 0.004, 0.003, 0.015, 0.002, 0, 0.005, 0, 0, 0;
  CHECK(lateral_deviation(path, Arrival{vec(0, 0, 0), vec(0, 0, -1)}) == Approx(0.005));
}

TEST_CASE("the jerk of a cubic is its constant third derivative, the length of a line its distance") {
  const auto motion = sampled(200, 2, [](double t) { return vec(t * t * t, 0, 0); });
  CHECK(rms_jerk(motion.positions, 2) == Approx(6).epsilon(1e-6));
  CHECK(path_length(sampled(9, 1, [](double t) { return vec(3 * t, 4 * t, 0); }).positions) == Approx(5));
}

TEST_CASE("overshoot is the depth beyond the end along the direction of arrival") {
  Samples path(3, 3);
  path << 0, 0, 0.1, 0.01, 0, -0.02, 0, 0, 0;
  CHECK(overshoot(path, Arrival{vec(0, 0, 0), vec(0, 0, -1)}) == Approx(0.02));
  CHECK(overshoot(path.topRows(1), Arrival{vec(0, 0, 0), vec(0, 0, -1)}) == 0);
}
