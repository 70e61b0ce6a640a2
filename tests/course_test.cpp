#include "lfdtools/course.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/trajectory.hpp"

using namespace lfd;

namespace {

Dmp some_primitive(DmpScaling scaling = DmpScaling::none) {
  Random random(5);
  Dmp dmp;
  dmp.settings = make_dmp_settings(12, scaling);
  dmp.tau = 1.7;
  dmp.start = Vector::Zero(2);
  dmp.goal = Vector(2);
  dmp.goal << 0.3, -0.2;
  dmp.rmse = Vector::Zero(2);
  dmp.weights = Matrix(2, 12);
  for (Eigen::Index i = 0; i < 24; ++i) dmp.weights(i % 2, i / 2) = 20 * random.normal();
  return dmp;
}

Course some_course(double time, DmpScaling scaling = DmpScaling::none) {
  Course course{some_primitive(scaling), {}, {}};
  Vector goal(2);
  goal << 0.35, -0.1;
  course.changes.push_back({time, goal, 0.8 * course.primitive.weights});
  return course;
}

}  // namespace

TEST_CASE("a course without change or speed is the primitive's own motion, to the byte") {
  const Course course{some_primitive(), {}, {}};
  const Vector times = linspace(0, 3, 77);
  CHECK(rollout(course, times).positions == rollout(course.primitive, times).positions);
  CHECK(settle_time(course) == settle_time(course.primitive));
}

TEST_CASE("before a change the motion is the old one, and it closes up with that of the new goal") {
  for (const auto scaling : {DmpScaling::none, DmpScaling::goal}) {
    const Course course = some_course(0.2, scaling);
    Dmp next = course.primitive;
    next.goal = course.goal();
    next.weights = course.changes.back().weights;
    const Motion motion = rollout(course, linspace(0, 3.4, 341));
    const Motion old = rollout(course.primitive, motion.times);
    const Motion after = rollout(next, motion.times);
    CHECK((motion.positions.topRows(21) - old.positions.topRows(21)).norm() < 1e-12);
    CHECK((motion.positions.row(340) - after.positions.row(340)).norm() < 1e-6);
    CHECK((motion.positions.row(170) - after.positions.row(170)).norm() <
          0.1 * (old.positions.row(170) - after.positions.row(170)).norm());
  }
}

TEST_CASE("positions, velocities and accelerations go through a change without a jump") {
  const Course course = some_course(0.6);
  const double begin = 0.6;
  const double end = 0.6 + course.blend * course.primitive.tau;
  for (const double at : {begin, end, 1.1}) {
    Vector times(2);
    times << at - 1e-7, at + 1e-7;
    const Motion motion = rollout(course, times);
    CHECK((motion.positions.row(1) - motion.positions.row(0)).norm() < 1e-6);
    CHECK((motion.velocities.row(1) - motion.velocities.row(0)).norm() < 1e-5);
    CHECK((motion.accelerations.row(1) - motion.accelerations.row(0)).norm() < 1e-4);
  }
  // The derivatives are those of the positions, and of the velocities.
  const double h = 1e-5;
  for (const double at : {0.3, 0.7, 0.9, 1.3, 2.0}) {
    Vector times(3);
    times << at - h, at, at + h;
    const Motion motion = rollout(course, times);
    CHECK(((motion.positions.row(2) - motion.positions.row(0)) / (2 * h) - motion.velocities.row(1)).norm() < 1e-7);
    CHECK(((motion.velocities.row(2) - motion.velocities.row(0)) / (2 * h) - motion.accelerations.row(1)).norm() <
          1e-6);
  }
}

TEST_CASE("the motion at a time does not depend on the other times asked for") {
  Course course = some_course(0.61234);
  course.start_velocity = Vector::Constant(2, 0.1);
  const Motion coarse = rollout(course, linspace(0, 4, 5));
  const Motion fine = rollout(course, linspace(0, 4, 4001));
  for (Eigen::Index i = 0; i < 5; ++i) {
    CHECK((coarse.positions.row(i) - fine.positions.row(1000 * i)).norm() < 1e-12);
  }
}

TEST_CASE("a motion that begins at speed has that speed") {
  Course course{some_primitive(), Vector::Constant(2, 0.3), {}};
  const Motion motion = rollout(course, linspace(0, 1, 11));
  CHECK((motion.velocities.row(0).transpose() - course.start_velocity).norm() < 1e-15);
  const Motion still = rollout(course.primitive, motion.times);
  // The difference is the spring's own answer, t v exp(-alpha_z t / (2 tau)) at critical damping.
  for (Eigen::Index i = 0; i < 11; ++i) {
    const double t = motion.times[i];
    CHECK(motion.positions(i, 0) - still.positions(i, 0) ==
          Approx(0.3 * t * std::exp(-12.5 * t / course.primitive.tau)).margin(1e-12));
  }
}

TEST_CASE("a late change is followed until the motion rests on the last goal") {
  for (const double time : {0.5, 1.69, 2.5}) {
    Course course = some_course(time);
    course.changes.push_back({time + 0.05, course.changes.back().goal * 1.1, course.primitive.weights});
    const Motion motion = generate(course);
    const Eigen::Index last = motion.times.size() - 1;
    CHECK(motion.times[last] > time + 0.05 + course.blend * course.primitive.tau);
    CHECK((motion.positions.row(last).transpose() - course.goal()).norm() <= 1e-4);
    CHECK(motion.velocities.row(last).norm() <= 2e-3);
  }
}

TEST_CASE("courses that make no sense are refused") {
  const Vector times = linspace(0, 1, 3);
  CHECK_THROWS_AS(rollout(some_course(0), times), DataError);
  CHECK_THROWS_AS(rollout(some_course(-1), times), DataError);
  CHECK_THROWS_AS(rollout(some_course(1e9), times), DataError);
  Course twice = some_course(0.5);
  twice.changes.push_back(twice.changes.front());
  CHECK_THROWS_AS(rollout(twice, times), DataError);
  Course odd = some_course(0.5);
  odd.changes.front().goal = Vector::Zero(3);
  CHECK_THROWS_AS(rollout(odd, times), DataError);
}
