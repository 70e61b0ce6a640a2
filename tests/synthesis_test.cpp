#include "lfdtools/synthesis.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "refusal.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

constexpr double pi = std::numbers::pi;

Vector xyz(double x, double y, double z) {
  return (Vector(3) << x, y, z).finished();
}

Experiment two_holes() {
  Experiment e;
  e.start = xyz(0.4, -0.3, 0.5);
  e.holes = {{"1", xyz(0.8, 0.2, 0.3)}, {"left", xyz(0.8, 0.4, 0.6)}};
  e.new_holes = {{"n1", xyz(0.8, 0.3, 0.4)}};
  e.repetitions = 3;
  return e;
}

/// A post between the start and the holes.
Experiment around_a_post() {
  Experiment e = two_holes();
  Obstacle post;
  post.center = xyz(0.6, 0.0, 0.0);
  post.axis = xyz(0, 0, 2);
  post.radius = 0.04;
  post.clearance = 0.06;
  post.ways = {xyz(-1, 1, 0), xyz(1, -1, 0)};
  e.obstacle = post;
  return e;
}

double nearest(const Samples& path, const Obstacle& post, double least_bump) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < path.rows(); ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(path.rows() - 1);
    if (std::pow(std::sin(pi * s), 2) < least_bump) continue;
    least = std::min(least, std::hypot(path(i, 0) - post.center[0], path(i, 1) - post.center[1]));
  }
  return least;
}

}  // namespace

TEST_CASE("without bumps the intention is a straight line at minimum jerk") {
  const Experiment e = two_holes();
  const Vector g = e.holes[0].position;
  const Vector s = linspace(0, 1, 101);
  const Samples y = intention(e, g, s);
  for (Index i = 0; i <= 100; ++i) {
    const double mj = 10 * std::pow(s[i], 3) - 15 * std::pow(s[i], 4) + 6 * std::pow(s[i], 5);
    REQUIRE((y.row(i).transpose() - (e.start + mj * (g - e.start))).norm() < 1e-14);
  }
  CHECK(y.row(0).transpose() == e.start);
  CHECK(y.row(100).transpose() == g);
}

TEST_CASE("bumps have their stated size at their stated phase, and the symmetric one is symmetric") {
  Experiment e = two_holes();
  const Vector g = xyz(0.7, 0.3, 0.45);
  e.origin = xyz(0.5, 0.1, 0.4);
  e.bumps.resize(3);
  e.bumps[0].constant = 0.05;
  e.bumps[0].linear = xyz(0.1, -0.2, 0.3);
  e.bumps[0].quadratic = Matrix::Identity(3, 3) * 0.5;
  e.bumps[0].quadratic(0, 1) = 1.0;
  e.bumps[1].sines = {{0.03, xyz(2, 0, 4), 0.5}};
  e.bumps[1].exponent = 2;
  e.bumps[2].gaussians = {{0.04, xyz(0.7, 0.3, 0.3), 0.1}};
  const Vector A = bump_sizes(e, g);  // u = (0.2, 0.2, 0.05)
  CHECK(A[0] == Approx(0.05 + 0.02 - 0.04 + 0.015 + 0.5 * (0.04 + 0.04 + 0.0025) + 0.04).epsilon(1e-12));
  CHECK(A[1] == Approx(0.03 * std::sin(0.4 + 0.2 + 0.5)).epsilon(1e-12));
  CHECK(A[2] == Approx(0.04 * std::exp(-0.5 * 2.25)).epsilon(1e-12));
  const Experiment straight = two_holes();
  const Vector s = (Vector(4) << 0.3, 0.7, 0.5, std::sqrt(0.5)).finished();
  const Samples bump = intention(e, g, s) - intention(straight, g, s);
  CHECK(bump(0, 0) == Approx(bump(1, 0)).epsilon(1e-12));
  CHECK(bump(0, 0) == Approx(A[0] * std::pow(std::sin(0.3 * pi), 2)).epsilon(1e-12));
  CHECK(bump(2, 0) == Approx(A[0]).epsilon(1e-12));
  CHECK(bump(3, 1) == Approx(A[1]).epsilon(1e-12));  // s^2 = 1/2
}

TEST_CASE("with an approach the last 20 mm come down the hole's axis") {
  Experiment e = two_holes();
  e.bumps.resize(3);
  for (Bump& bump : e.bumps) bump.constant = 0.05;
  e.approach.offset = xyz(0, 0, 0.1);
  for (const Hole& hole : e.holes) {
    const Samples y = intention(e, hole.position, linspace(0, 1, 4001));
    Index i = 4000;
    while ((y.row(i).transpose() - hole.position).norm() < 0.02) --i;
    const Vector arrival = (hole.position - y.row(i).transpose()).normalized();
    const Vector late = -(9 * e.approach.offset + xyz(0.05, 0.05, 0.05));
    CHECK(std::acos(arrival.dot(late.normalized())) < 5 * pi / 180);
    CHECK(std::acos(-arrival[2]) < 10 * pi / 180);
    const Vector last = (hole.position - y.row(3990).transpose()).normalized();
    CHECK(std::acos(last.dot(late.normalized())) < 0.5 * pi / 180);  // the limit is as stated
  }
}

TEST_CASE("the berth clears the post by its clearance, not much more, and changes smoothly with the hole") {
  Experiment e = around_a_post();
  const Obstacle& post = *e.obstacle;
  const double R = post.radius + post.clearance;
  Experiment bare = e;
  bare.obstacle.reset();
  const Vector s = linspace(0, 1, 501);
  for (double y = 0; y < 0.61; y += 0.1) {
    for (std::size_t way = 0; way < 2; ++way) {
      const Vector g = xyz(0.9, y, 0.4);
      const double B = berth(e, g, way);
      const Samples path = intention(e, g, s, way);
      REQUIRE(nearest(path, post, 0.2) >= R - 1e-4);  // the berth looks at 65 phases
      // The least berth that clears, by trying: at each size the path without obstacle plus that bump along the way.
      const Samples line = intention(bare, g, s);
      const Vector w = post.ways[way].normalized();
      const auto pushed = [&](double size) {
        Samples p = line;
        for (Index i = 0; i < 501; ++i) p.row(i) += size * std::pow(std::sin(pi * s[i]), 2) * w.transpose();
        return nearest(p, post, 0.2);
      };
      REQUIRE((pushed(B) - nearest(path, post, 0.2)) == Approx(0).margin(1e-12));
      double least = B;
      while (least > 0 && pushed(least - 0.001) >= R) least -= 0.001;
      REQUIRE(B - least < 0.06);
      const double h = 1e-4;
      const double left = (B - berth(e, g - xyz(0, h, 0), way)) / h;
      const double right = (berth(e, g + xyz(0, h, 0), way) - B) / h;
      REQUIRE(std::abs(left - right) < 0.02);
    }
  }
  CHECK(berth(e, xyz(0.3, -0.6, 0.4)) < 1e-3);  // away from the post
}

TEST_CASE("noise has the stated sizes over many repetitions") {
  Experiment e = two_holes();
  e.holes.resize(1);
  e.repetitions = 2000;
  e.noise.tempo_sd = 0;
  const DemonstrationSet set = synthesize(e);
  REQUIRE(set.demonstrations.size() == 2000);
  double duration = 0, duration2 = 0, first2 = 0, second2 = 0, tremor2 = 0, lag1 = 0;
  for (const Demonstration& demo : set.demonstrations) {
    const Trajectory& t = demo.trajectory;
    const Index T = t.samples();
    REQUIRE(t.start() == e.start);
    REQUIRE(t.goal() == e.holes[0].position);
    REQUIRE(t.times[1] == Approx(0.01).epsilon(1e-12));
    const Vector s = linspace(0, 1, T);
    Vector off = t.positions.col(1) - intention(e, e.holes[0].position, s).col(1);
    // Least squares on the two half-waves, which are orthogonal over the samples.
    const Vector one = (pi * s.array()).sin();
    const Vector two = (2 * pi * s.array()).sin();
    const double b1 = off.dot(one) / one.squaredNorm();
    const double b2 = off.dot(two) / two.squaredNorm();
    off -= b1 * one + b2 * two;
    duration += t.duration() / 2000;
    duration2 += std::pow(t.duration() - 3, 2) / 2000;
    first2 += b1 * b1 / 2000;
    second2 += b2 * b2 / 2000;
    tremor2 += off.squaredNorm() / static_cast<double>(T - 4) / 2000;
    lag1 += off.head(T - 1).dot(off.tail(T - 1)) / off.squaredNorm() / 2000;
  }
  const double four_errors = 4 / std::sqrt(2 * 2000.0);  // of a standard deviation from 2000 draws, relative
  CHECK(std::abs(duration - 3) < 4 * 0.4 / std::sqrt(2000.0));
  CHECK(std::sqrt(duration2) == Approx(0.4).epsilon(four_errors));
  CHECK(std::sqrt(first2) == Approx(0.006).epsilon(four_errors));
  CHECK(std::sqrt(second2) == Approx(0.004).epsilon(four_errors));
  CHECK(std::sqrt(tremor2) == Approx(0.0005).epsilon(4 / std::sqrt(2 * 2000 * 300.0)));
  CHECK(std::abs(lag1) < 0.01);  // white; the two fitted waves leave about -2 / 300
}

TEST_CASE("the tempo wanders by the stated share of the duration, and never backwards") {
  Experiment e = two_holes();
  e.holes.resize(1);
  e.repetitions = 2000;
  e.noise = {0.4, 0.05, Vector(), 0};
  const Vector g = e.holes[0].position;
  double sum2 = 0;
  for (const Demonstration& demo : synthesize(e).demonstrations) {
    const Trajectory& t = demo.trajectory;
    const Vector progress = (t.positions.rowwise() - e.start.transpose()) * (g - e.start) / (g - e.start).squaredNorm();
    REQUIRE((progress.tail(t.samples() - 1) - progress.head(t.samples() - 1)).minCoeff() >= 0);
    // Share of the motion's own time at half the clock, from the inverse of minimum jerk by bisection.
    const Index half = (t.samples() - 1) / 2;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double s = 0.5 * (low + high);
      (s * s * s * (10 + s * (6 * s - 15)) < progress[half] ? low : high) = s;
    }
    const double clock = static_cast<double>(half) / static_cast<double>(t.samples() - 1);
    sum2 += std::pow((low - clock) / std::sin(pi * clock), 2) / 2000;
  }
  CHECK(std::sqrt(sum2) == Approx(0.05).epsilon(4 / std::sqrt(2 * 2000.0)));
}

TEST_CASE("each demonstration depends on seed, target and repetition alone") {
  Experiment e = around_a_post();
  const DemonstrationSet before = synthesize(e);
  CHECK(synthesize(e).demonstrations[4].trajectory.positions == before.demonstrations[4].trajectory.positions);
  std::swap(e.holes[0], e.holes[1]);
  e.holes.insert(e.holes.begin(), {"extra", xyz(0.7, 0.5, 0.5)});
  e.repetitions = 5;
  const DemonstrationSet after = synthesize(e);
  for (const Demonstration& old : before.demonstrations) {
    int same = 0;
    for (const Demonstration& now : after.demonstrations) {
      if (!(now.labels == old.labels)) continue;
      CHECK(now.trajectory.times == old.trajectory.times);
      CHECK(now.trajectory.positions == old.trajectory.positions);
      ++same;
    }
    CHECK(same == 1);
  }
  e.seed = 2;
  CHECK(synthesize(e).demonstrations[0].trajectory.positions.row(1) !=
        after.demonstrations[0].trajectory.positions.row(1));
  e.noise.tremor_sd = 0;  // one kind of noise does not move the others
  CHECK(synthesize(e).demonstrations[0].trajectory.samples() == [&] {
    e.noise.tremor_sd = 0.001;
    return synthesize(e).demonstrations[0].trajectory.samples();
  }());
  int first_way = 0;
  for (Index r = 1; r <= 1000; ++r) first_way += way_taken(e, "1", r) == 0 ? 1 : 0;
  CHECK(std::abs(first_way - 500) < 4 * std::sqrt(250.0));
}

TEST_CASE("an experiment that cannot be made is refused by name") {
  const auto id_after = [](const std::function<void(Experiment&)>& change) {
    Experiment e = around_a_post();
    change(e);
    return refusal_of([&] { (void)synthesize(e); }).id;
  };
  CHECK(id_after([](Experiment&) {}) == "");
  CHECK(id_after([](Experiment& e) { e.start = Vector::Zero(2); }) == "synthesis.shape");
  CHECK(id_after([](Experiment& e) { e.bumps.resize(2); }) == "synthesis.shape");
  CHECK(id_after([](Experiment& e) { e.holes[1].position[0] = std::nan(""); }) == "synthesis.not_finite");
  CHECK(id_after([](Experiment& e) { e.holes.clear(); }) == "synthesis.no_holes");
  CHECK(id_after([](Experiment& e) { e.new_holes[0].target = e.holes[0].target; }) == "synthesis.repeated_target");
  CHECK(id_after([](Experiment& e) { e.repetitions = 0; }) == "synthesis.value");
  CHECK(id_after([](Experiment& e) { e.rate = -1; }) == "synthesis.value");
  CHECK(id_after([](Experiment& e) { e.noise.tremor_sd = -1; }) == "synthesis.value");
  CHECK(id_after([](Experiment& e) { e.obstacle->ways = {xyz(0, 0, 1)}; }) == "synthesis.way");
  CHECK(id_after([](Experiment& e) { e.obstacle->center = xyz(0.8, 0.2, 9); }) == "synthesis.end_in_obstacle");
  const Experiment e = around_a_post();
  CHECK(refusal_of([&] { (void)intention(e, e.start, Vector::Constant(1, 1.1)); }).id == "synthesis.value");
  CHECK(refusal_of([&] { (void)intention(e, e.start, Vector::Constant(1, 0.1), 2); }).id == "synthesis.value");
}
