#include "lfdtools/box_minimum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"

using namespace lfd;

namespace {

const double infinity = std::numeric_limits<double>::infinity();

double rosenbrock(const Vector& x, Vector& g) {
  const double a = 1 - x(0);
  const double b = x(1) - x(0) * x(0);
  g(0) = -2 * a - 400 * x(0) * b;
  g(1) = 200 * b;
  return a * a + 100 * b * b;
}

Vector pair_of(double a, double b) {
  return (Vector(2) << a, b).finished();
}

}  // namespace

TEST_CASE("the minimum of a curved valley is found") {
  const auto result = minimize_in_box(rosenbrock, pair_of(-1.2, 1), pair_of(-5, -5), pair_of(5, 5));
  CHECK(result.converged);
  CHECK(result.x(0) == Approx(1).margin(1e-4));
  CHECK(result.x(1) == Approx(1).margin(1e-4));
  CHECK(result.evaluations < 100);
}

TEST_CASE("a bound that holds the minimum back is kept exactly") {
  // With x <= 1/2 the minimum of Rosenbrock's function lies on the bound, at (1/2, 1/4).
  const auto result = minimize_in_box(rosenbrock, pair_of(-1.2, 1), pair_of(-5, -5), pair_of(0.5, 5));
  CHECK(result.converged);
  CHECK(result.x(0) == 0.5);
  CHECK(result.x(1) == Approx(0.25).margin(1e-5));
  // And a start outside of the box is taken into it.
  const auto corner = minimize_in_box(rosenbrock, pair_of(9, 9), pair_of(2, 5), pair_of(3, 6));
  CHECK(corner.x(0) == Approx(std::sqrt(5.0)).margin(1e-3));
  CHECK(corner.x(1) == 5);
}

TEST_CASE("a minimum at infinity is followed until the slope is small or the box ends") {
  const Objective decay = [](const Vector& x, Vector& g) {
    g(0) = -std::exp(-x(0));
    return std::exp(-x(0));
  };
  const auto result = minimize_in_box(decay, Vector::Zero(1), Vector::Constant(1, -50), Vector::Constant(1, 50));
  CHECK(result.value < 1e-3);
  const auto bounded = minimize_in_box(decay, Vector::Zero(1), Vector::Constant(1, -1), Vector::Constant(1, 2));
  CHECK(bounded.x(0) == 2);
}

TEST_CASE("values that are not finite shorten the step") {
  // u - 0.1 ln u with u = x - 0.9 has its minimum at x = 1; a first step of length one from 1.5 leaves the domain.
  int outside = 0;
  const Objective barrier = [&](const Vector& x, Vector& g) {
    const double u = x(0) - 0.9;
    if (u <= 0) ++outside;
    g(0) = 1 - 0.1 / u;
    return u <= 0 ? infinity : u - 0.1 * std::log(u);
  };
  const auto result =
      minimize_in_box(barrier, Vector::Constant(1, 1.5), Vector::Constant(1, -9), Vector::Constant(1, 9));
  CHECK(outside > 0);
  CHECK(result.x(0) == Approx(1).margin(1e-3));
  const Objective nowhere = [](const Vector&, Vector&) { return std::nan(""); };
  CHECK_THROWS_AS(minimize_in_box(nowhere, Vector::Zero(1), Vector::Constant(1, -1), Vector::Ones(1)), DataError);
}

TEST_CASE("however early it is stopped, the result is no higher than the start, a flat function stops at once") {
  const Objective flat = [](const Vector&, Vector& g) {
    g.setZero();
    return 3.0;
  };
  CHECK(minimize_in_box(flat, Vector::Zero(2), pair_of(-1, -1), pair_of(1, 1)).evaluations == 1);
  Vector unused(2);
  const double start = rosenbrock(pair_of(-1.2, 1), unused);
  for (int budget = 1; budget < 40; ++budget) {
    BoxMinimumOptions options;
    options.max_iterations = budget;
    const auto result = minimize_in_box(rosenbrock, pair_of(-1.2, 1), pair_of(-5, -5), pair_of(5, 5), options);
    CHECK(result.value <= start);
    CHECK(result.value == rosenbrock(result.x, unused));
  }
}
