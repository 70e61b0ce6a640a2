#include "lfdtools/retime.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "lfdtools/error.hpp"
#include "lfdtools/interpolation.hpp"
#include "lfdtools/motion.hpp"
#include "lfdtools/path.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur_geometry.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;
constexpr SplineEnds both_ends[] = {SplineEnds::not_a_knot, SplineEnds::at_rest};

/// From rest to rest over a distance, one joint alone: full acceleration, perhaps full speed, full deceleration.
double fastest(double distance, double velocity, double acceleration) {
  const double ramps = velocity * velocity / acceleration;
  return distance > ramps ? distance / velocity + velocity / acceleration : 2.0 * std::sqrt(distance / acceleration);
}

Samples smooth_joints(Random& random, Eigen::Index T) {
  Samples joints(T, 6);
  for (int j = 0; j < 6; ++j) {
    const double size = random.uniform(0.2, 1.0), shift = random.uniform(0.0, 2 * pi), turns = random.uniform(0.3, 1.5);
    for (Eigen::Index t = 0; t < T; ++t) {
      const double s = static_cast<double>(t) / static_cast<double>(T - 1);
      joints(t, j) = size * std::sin(2 * pi * turns * s + shift) + 0.3 * size * std::sin(5.0 * s + 2 * shift);
    }
  }
  return joints;
}

RetimeOptions limits(double velocity, double acceleration) {
  RetimeOptions options;
  options.velocity.setConstant(velocity);
  options.acceleration.setConstant(acceleration);
  return options;
}

/// Largest share of a limit along the law, at ten times as many instants as it has rows.
double largest_share(const Retiming& law, const RetimeOptions& options) {
  double largest = 0.0;
  const Eigen::Index n = 10 * law.times().size();
  for (Eigen::Index k = 0; k <= n; ++k) {
    const auto state = law(law.duration() * static_cast<double>(k) / static_cast<double>(n));
    largest = std::max({largest, state.velocity.cwiseAbs().cwiseQuotient(options.velocity).maxCoeff(),
                        state.acceleration.cwiseAbs().cwiseQuotient(options.acceleration).maxCoeff()});
  }
  return largest;
}

}  // namespace

TEST_CASE("one joint alone runs as its two limits say in closed form") {
  const Robot robot = nominal_ur10();
  for (const double distance : {0.05, 0.4, 3.0}) {
    Samples joints = Samples::Zero(50, 6);
    for (Eigen::Index t = 0; t < 50; ++t) joints(t, 1) = distance * std::pow(static_cast<double>(t) / 49.0, 1.5);
    RetimeOptions options = limits(1.2, 2.5);
    options.of_rows = false;
    const Retiming law = retime(robot, joints, options);
    CHECK(law.duration() == Approx(fastest(distance, 1.2, 2.5)).epsilon(1e-5));
    CHECK(law.stretch() == Approx(1.0).margin(1e-5));
    CHECK(law(0.0).velocity.norm() < 1e-12);
    CHECK(law(law.duration()).velocity.norm() < 1e-6);
    for (Eigen::Index t = 0; t < 50; ++t) {
      CHECK((law(law.times()[t]).position - joints.row(t).transpose()).norm() < 1e-9);
    }
  }
}

/// The same of the cubic spline through the rows over their times.
double largest_share_of_rows(const Retiming& law, const Samples& joints, const RetimeOptions& options,
                             SplineEnds ends) {
  const CubicSpline spline(law.times(), joints, ends);
  const Eigen::Index T = joints.rows();
  double largest = 0.0;
  for (Eigen::Index k = 0; k < 10 * T; ++k) {
    const Eigen::Index row = std::min(k / 10, T - 2);
    const double share = static_cast<double>(k - 10 * row) / 10.0;
    const double t = law.times()[row] + std::min(share, 1.0) * (law.times()[row + 1] - law.times()[row]);
    const Joints speed = spline.derivative(Vector::Constant(1, t)).row(0).transpose();
    const Joints bend = ((1.0 - std::min(share, 1.0)) * spline.second_derivatives().row(row) +
                         std::min(share, 1.0) * spline.second_derivatives().row(row + 1))
                            .transpose();
    largest = std::max({largest, speed.cwiseAbs().cwiseQuotient(options.velocity).maxCoeff(),
                        bend.cwiseAbs().cwiseQuotient(options.acceleration).maxCoeff()});
  }
  return largest;
}

TEST_CASE("limits hold on a grid ten times as fine, the path is the same, and states belong together") {
  const Robot robot = nominal_ur10();
  Random random(1);
  double worst_stretch = 1.0, worst_share = 0.0, least_share = 1.0, worst_rows = 0.0, slowest = 0.0;
  for (int i = 0; i < 60; ++i) {
    const Samples joints = smooth_joints(random, 150);
    RetimeOptions options = limits(random.uniform(0.3, 3.0), random.uniform(0.5, 5.0));
    options.acceleration[i % 6] *= 0.3;
    const Retiming careful = retime(robot, joints, options);
    worst_share = std::max(worst_share, largest_share(careful, options));
    for (const SplineEnds ends : both_ends) {
      worst_rows = std::max(worst_rows, largest_share_of_rows(careful, joints, options, ends));
    }
    options.of_rows = false;
    const Retiming law = retime(robot, joints, options);
    slowest = std::max(slowest, careful.duration() / law.duration());
    worst_stretch = std::max(worst_stretch, law.stretch());
    const double share = largest_share(law, options);
    worst_share = std::max(worst_share, share);
    least_share = std::min(least_share, share);
    Robot limited = robot;
    limited.limits.velocity = options.velocity;
    limited.limits.acceleration = options.acceleration;
    const MotionFigures figures = motion_figures(limited, law.times(), joints);
    CHECK(worst(figures.speed_ratio).value <= 1.0 + 1e-9);
    CHECK(worst(figures.acceleration_ratio).value <= 1.0 + 1e-6);
    for (Eigen::Index t = 0; t < joints.rows(); ++t) {
      CHECK((law(law.times()[t]).position - joints.row(t).transpose()).norm() < 1e-7);
    }
    constexpr double h = 1e-5;
    for (int k = 1; k < 20; ++k) {
      const double t = law.duration() * k / 20.0;
      const Joints difference = (law(t + h).position - law(t - h).position) / (2 * h);
      CHECK((difference - law(t).velocity).norm() < 1e-4);
    }
  }
  INFO("stretched by up to " << worst_stretch << ", largest share of a limit " << worst_share << ", of the rows "
                             << worst_rows << ", which cost up to " << slowest - 1.0);
  CHECK(worst_rows <= 1.0 + 1e-5);
  CHECK(slowest < 1.04);
  CHECK(worst_share <= 1.0 + 1e-9);
  CHECK(least_share > 0.98);  // some limit is always used up
  CHECK(worst_stretch < 1.01);
}

TEST_CASE("where one joint sets the limit, the duration is within 5 % of what it could do alone") {
  const Robot robot = nominal_ur10();
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const int lead = i % 6;
    Samples joints = 0.2 * smooth_joints(random, 200);
    const double distance = random.uniform(0.5, 4.0);
    for (Eigen::Index t = 0; t < 200; ++t) {
      const double s = static_cast<double>(t) / 199.0;
      joints(t, lead) = distance * s * s * (3.0 - 2.0 * s);
    }
    RetimeOptions options = limits(20.0, 60.0);
    options.velocity[lead] = random.uniform(0.5, 2.0);
    options.acceleration[lead] = random.uniform(0.5, 2.0);
    const double bound = fastest(distance, options.velocity[lead], options.acceleration[lead]);
    const Retiming law = retime(robot, joints, options);
    CHECK(law.duration() >= bound * (1.0 - 1e-6));
    worst = std::max(worst, law.duration() / bound);
  }
  INFO("longest, as a factor of the bound: " << worst);
  CHECK(worst < 1.05);
}

TEST_CASE("no slower than the best that dynamic programming finds on a small problem") {
  // Half a circle of two joints: the speed limits bind on its sides, the accelerations all along.
  constexpr Eigen::Index T = 61;
  constexpr double v = 0.8, a = 1.0, radius = 0.7;
  Samples joints = Samples::Zero(T, 6);
  for (Eigen::Index t = 0; t < T; ++t) {
    const double angle = pi * static_cast<double>(t) / (T - 1.0);
    joints.row(t).head(2) << radius * (1.0 - std::cos(angle)), radius * std::sin(angle);
  }
  RetimeOptions options = limits(v, a);
  options.of_rows = false;
  const Retiming law = retime(nominal_ur10(), joints, options);

  // Over the arc length s: q' = (sin, cos), q'' = (cos, -sin) / radius, at angle s / radius.
  constexpr int N = 120, levels = 400;
  const double most = v * v * 2.0, step = pi * radius / N;
  const auto allowed = [&](int i, double x, double u) {
    const double angle = pi * i / N;
    const double first[2] = {std::sin(angle), std::cos(angle)};
    const double second[2] = {std::cos(angle) / radius, -std::sin(angle) / radius};
    for (int j = 0; j < 2; ++j) {
      if (std::abs(first[j]) * std::sqrt(x) > v || std::abs(first[j] * u + second[j] * x) > a) return false;
    }
    return true;
  };
  std::vector<double> left(levels, 1e9);
  left[0] = 0.0;
  for (int i = N - 1; i >= 0; --i) {
    std::vector<double> here(levels, 1e9);
    for (int k = 0; k < levels; ++k) {
      for (int m = 0; m < levels; ++m) {
        const double x = most * k / levels, y = most * m / levels, u = (y - x) / (2.0 * step);
        if (left[static_cast<std::size_t>(m)] > 1e8 || k + m == 0 || !allowed(i, x, u) || !allowed(i + 1, y, u))
          continue;
        const double time = 2.0 * step / (std::sqrt(x) + std::sqrt(y)) + left[static_cast<std::size_t>(m)];
        here[static_cast<std::size_t>(k)] = std::min(here[static_cast<std::size_t>(k)], time);
      }
    }
    left = here;
  }
  INFO("duration " << law.duration() << " s, by dynamic programming " << left[0] << " s");
  CHECK(law.duration() < left[0] * 1.002);
  CHECK(law.duration() > left[0] * 0.97);
}

TEST_CASE("the tool tip keeps its speed limit too") {
  const Robot robot = nominal_ur10();
  Samples joints = Samples::Zero(80, 6);
  for (Eigen::Index t = 0; t < 80; ++t) joints(t, 0) = 2.0 * static_cast<double>(t) / 79.0;
  RetimeOptions options = limits(2.0, 10.0);
  options.tool.position << 0.0, 0.0, 0.2;
  const Vector3 tip = (forward_kinematics(robot, Joints::Zero()) * options.tool).position;
  const double radius = std::hypot(tip.x(), tip.y());
  options.tip_speed = 0.5;
  options.of_rows = false;
  const Retiming law = retime(robot, joints, options);
  CHECK(law.duration() == Approx(fastest(2.0, 0.5 / radius, 10.0)).epsilon(1e-5));
  CHECK(law(0.5 * law.duration()).velocity[0] * radius == Approx(0.5));
}

TEST_CASE("the tool tip keeps its speed limit on the splines through the rows, where they overshoot at corners") {
  const Robot robot = nominal_ur10();
  double worst = 0.0, longest = 0.0;
  for (const Eigen::Index T : {Eigen::Index{55}, Eigen::Index{120}}) {
    Samples joints = Samples::Zero(T, 6);  // three sides of a square in joints 1 and 2, gone along at one speed
    for (Eigen::Index t = 0; t < T; ++t) {
      const double s = 3.0 * static_cast<double>(t) / static_cast<double>(T - 1);
      joints.row(t) << 0.4 * std::clamp(s - 1.0, 0.0, 1.0), -1.2 + 0.4 * (std::min(s, 1.0) - std::max(s - 2.0, 0.0)),
          0.9, 0.0, 1.0, 0.0;
    }
    RetimeOptions options = limits(2.0, 1.4);
    options.tip_speed = 0.05;
    const Retiming law = retime(robot, joints, options);
    options.of_rows = false;
    longest = std::max(longest, law.duration() / retime(robot, joints, options).duration());
    for (const SplineEnds ends : both_ends) {
      const Vector times = Vector::LinSpaced(50 * T, 0.0, law.duration());
      const Samples path = CubicSpline(law.times(), joints, ends)(times);
      Vector3 before = forward_kinematics(robot, path.row(0).transpose()).position;
      for (Eigen::Index k = 1; k < times.size(); ++k) {
        const Vector3 here = forward_kinematics(robot, path.row(k).transpose()).position;
        worst = std::max(worst, (here - before).norm() / (times[k] - times[k - 1]) / *options.tip_speed);
        before = here;
      }
    }
  }
  INFO("largest share of the limit " << worst << ", which took up to " << longest << " times as long");
  CHECK(worst < 1.01);
  CHECK(longest < 1.08);  // 6.6 % with 55 rows: two stops at sharp corners
}

TEST_CASE("corners, rests, repeated rows and two rows have times that rise") {
  const Robot robot = nominal_ur10();
  RetimeOptions options = limits(1.0, 2.0);
  options.of_rows = false;
  const auto rising = [](const Vector& times) {
    return (times.tail(times.size() - 1) - times.head(times.size() - 1)).minCoeff() > 0.0;
  };
  Samples corner = Samples::Zero(41, 6);
  for (Eigen::Index t = 0; t < 41; ++t) {
    corner(t, 0) = 0.02 * static_cast<double>(std::min<Eigen::Index>(t, 20));
    corner(t, 1) = 0.02 * static_cast<double>(std::max<Eigen::Index>(t, 20) - 20);
  }
  const Retiming sharp = retime(robot, corner, options);
  CHECK(rising(sharp.times()));
  CHECK(largest_share(sharp, options) <= 1.0 + 1e-9);

  Samples resting(60, 6);
  for (Eigen::Index t = 0; t < 60; ++t) {  // comes to rest, then stays
    resting.row(t).setConstant(t < 50 ? 1.0 - std::exp(-0.4 * static_cast<double>(t)) : 1.0);
  }
  const Retiming rest = retime(robot, resting, options);
  CHECK(rising(rest.times()));
  CHECK(largest_share(rest, options) <= 1.0 + 1e-9);
  CHECK(rest.duration() == Approx(fastest(1.0, 1.0, 2.0)).epsilon(1e-3));

  CHECK(rising(retime(robot, Samples::Constant(5, 6, 0.3), options).times()));
  Samples two = Samples::Zero(2, 6);
  two(1, 3) = 1.0;
  CHECK(retime(robot, two, options).duration() == Approx(fastest(1.0, 1.0, 2.0)).epsilon(1e-5));
}

TEST_CASE("paths and limits that cannot be are refused") {
  const Robot robot = nominal_ur10();
  CHECK_THROWS_AS(retime(robot, Samples::Zero(1, 6), limits(1.0, 1.0)), DataError);
  CHECK_THROWS_AS(retime(robot, Samples::Zero(5, 5), limits(1.0, 1.0)), DataError);
  CHECK_THROWS_AS(retime(robot, Samples::Constant(5, 6, std::nan("")), limits(1.0, 1.0)), DataError);
  CHECK_THROWS_AS(retime(robot, Samples::Zero(5, 6), limits(0.0, 1.0)), UsageError);
  CHECK_THROWS_AS(retime(robot, Samples::Zero(5, 6), limits(1.0, -1.0)), UsageError);
  CHECK_THROWS_AS(retime(robot, Samples::Zero(5, 6), limits(1.0, 1e-7)), UsageError);
  CHECK_THROWS_AS(retime(robot, Samples::Zero(5, 6), limits(1e7, 1.0)), UsageError);
}

TEST_CASE("a joint that turns round takes hardly longer than its ways from rest to rest") {
  const Robot robot = nominal_ur10();
  double longest = 0.0, longest_of_rows = 0.0, share = 0.0;
  for (const int turns : {1, 3, 6}) {
    for (const Eigen::Index T : {97, 150, 400}) {
      Samples joints = Samples::Zero(T, 6);
      for (Eigen::Index t = 0; t < T; ++t) {
        joints(t, 0) = 0.8 * std::cos(turns * pi * static_cast<double>(t) / static_cast<double>(T - 1));
      }
      RetimeOptions options = limits(2.0, 1.4);
      const double bound = turns * fastest(1.6, 2.0, 1.4);
      const double of_rows = retime(robot, joints, options).duration() / bound;
      options.of_rows = false;
      const Retiming law = retime(robot, joints, options);
      share = std::max(share, largest_share(law, options));
      longest = std::max(longest, law.duration() / bound);
      longest_of_rows = std::max(longest_of_rows, of_rows);
    }
  }
  INFO("longest, as a factor of the bound: " << longest << ", with the spline through the rows " << longest_of_rows);
  CHECK(share <= 1.0 + 1e-9);
  CHECK(longest < 1.04);
  CHECK(longest_of_rows < 1.06);
}

TEST_CASE("a hand that settles, past its goal and back, keeps the limits between the last rows too") {
  const Robot robot = nominal_ur10();
  double worst = 0.0;
  for (const double past : {0.3e-3, 1.02e-3, 1.04e-3, 1.1e-3, 1.5e-3, 3e-3, 2e-2}) {
    constexpr Eigen::Index T = 401;
    // The step response of a damped oscillator that overshoots its goal by this much [rad].
    const double logarithm = std::log(past), damping = -logarithm / std::hypot(pi, logarithm);
    const double ringing = std::sqrt(1.0 - damping * damping);
    Samples joints(T, 6);
    for (Eigen::Index t = 0; t < T; ++t) {
      const double time = 5.0 * static_cast<double>(t) / (T - 1.0), frequency = 3.0;
      const double phase = ringing * frequency * time;
      const double left =
          std::exp(-damping * frequency * time) * (std::cos(phase) + damping / ringing * std::sin(phase));
      joints.row(t) << left, -0.4 * left, 0.6 * left, 0.35 * left, 0.4 * left, 0.0;
    }
    const std::vector<Eigen::Index> rows = moving_rows(joints, 1e-3);
    const Samples kept = joints(rows, Eigen::all);
    const RetimeOptions options = limits(2.0, 1.4);
    const Retiming law = retime(robot, kept, options);
    CHECK(largest_share(law, options) <= 1.0 + 1e-9);
    CHECK(law.duration() < 1.15 * (fastest(1.0 + past, 2.0, 1.4) + fastest(past, 2.0, 1.4)));
    for (const SplineEnds ends : both_ends) {
      worst = std::max(worst, largest_share_of_rows(law, kept, options, ends));
    }
  }
  INFO("largest share of a limit, of the splines through the rows: " << worst);
  CHECK(worst <= 1.0 + 1e-5);
}
