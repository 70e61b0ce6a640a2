#include "lfdtools/interpolation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/random.hpp"
#include "lfdtools/trajectory.hpp"

using namespace lfd;

TEST_CASE("a not-a-knot spline reproduces a cubic exactly, values and slopes, on uneven samples") {
  Vector t(7);
  t << 0, 0.1, 0.35, 0.4, 0.8, 1.1, 1.5;
  Samples y(7, 2);
  for (int i = 0; i < 7; ++i) y.row(i) << 1 + t[i] - 2 * t[i] * t[i] + 3 * t[i] * t[i] * t[i], -t[i] * t[i];
  const CubicSpline spline(t, y);
  const Vector q = linspace(0, 1.5, 101);
  const Samples value = spline(q);
  const Samples slope = spline.derivative(q);
  for (int k = 0; k < 101; ++k) {
    const double s = q[k];
    CHECK(value(k, 0) == Approx(1 + s - 2 * s * s + 3 * s * s * s).margin(1e-12));
    CHECK(value(k, 1) == Approx(-s * s).margin(1e-12));
    CHECK(slope(k, 0) == Approx(1 - 4 * s + 9 * s * s).margin(1e-10));
  }
}

TEST_CASE("a spline through a sine converges with the fourth order") {
  const auto worst = [](int n) {
    const Vector t = linspace(0, 3, n);
    Samples y(n, 1);
    for (int i = 0; i < n; ++i) y(i, 0) = std::sin(t[i]);
    const Vector q = linspace(0, 3, 1001);
    const Samples value = CubicSpline(t, y)(q);
    double error = 0;
    for (int k = 0; k < 1001; ++k) error = std::max(error, std::abs(value(k, 0) - std::sin(q[k])));
    return error;
  };
  const double order = std::log2(worst(41) / worst(81));
  CHECK(order > 3.7);
  CHECK(order < 5.5);
}

TEST_CASE("two and three samples give a line and a parabola") {
  Vector t2(2);
  t2 << 0, 2;
  Samples y2(2, 1);
  y2 << 1, 5;
  CHECK(CubicSpline(t2, y2)(Vector::Constant(1, 0.5))(0, 0) == Approx(2));
  Vector t3(3);
  t3 << 0, 1, 3;
  Samples y3(3, 1);
  y3 << 0, 1, 9;
  CHECK(CubicSpline(t3, y3)(Vector::Constant(1, 2.0))(0, 0) == Approx(4));
}

TEST_CASE("a spline at rest at its ends is exact for cubics that are, and joins its parts smoothly") {
  Vector t(5);
  t << 0, 0.1, 0.7, 0.75, 1;
  Samples y(5, 1);
  for (int i = 0; i < 5; ++i) y(i, 0) = t[i] * t[i] * (3 - 2 * t[i]);
  const CubicSpline exact(t, y, SplineEnds::at_rest);
  const Vector q = linspace(0, 1, 101);
  const Samples value = exact(q);
  for (int k = 0; k < 101; ++k) CHECK(value(k, 0) == Approx(q[k] * q[k] * (3 - 2 * q[k])).margin(1e-14));

  Samples rough(5, 1);
  rough << 3, -1, 4, -1, 5;
  const CubicSpline spline(t, rough, SplineEnds::at_rest);
  CHECK((spline(t) - rough).norm() < 1e-13);
  CHECK(std::abs(spline.derivative(t.head(1))(0, 0)) < 1e-12);
  CHECK(std::abs(spline.derivative(t.tail(1))(0, 0)) < 1e-12);
  constexpr double h = 1e-9;
  for (int i = 1; i < 4; ++i) {
    Vector sides(2);
    sides << t[i] - h, t[i] + h;
    const Samples slopes = spline.derivative(sides);
    CHECK(slopes(1, 0) - slopes(0, 0) == Approx(2 * h * spline.second_derivatives()(i, 0)).margin(1e-4));
  }
  Samples two(2, 1);
  two << 0, 1;
  Vector ends(2);
  ends << 0, 1;
  CHECK(CubicSpline(ends, two, SplineEnds::at_rest)(Vector::Constant(1, 0.25))(0, 0) == Approx(0.15625));
}

TEST_CASE("PCHIP meets its data and keeps rising data rising") {
  Random random(7);
  Vector x(20);
  Vector y(20);
  x[0] = y[0] = 0;
  for (int i = 1; i < 20; ++i) {
    x[i] = x[i - 1] + random.uniform(0.01, 1);
    y[i] = y[i - 1] + std::pow(random.uniform(0.01, 1), 4);
  }
  const Pchip curve(x, y);
  CHECK((curve(x) - y).cwiseAbs().maxCoeff() < 1e-15);
  const Vector q = linspace(0, x[19], 5000);
  const Vector value = curve(q);
  for (int k = 1; k < 5000; ++k) REQUIRE(value[k] > value[k - 1]);
}
