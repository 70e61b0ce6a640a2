#include "lfdtools/posture_graph.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;
using Layers = std::vector<std::vector<Posture>>;

/// A way written out in full, with all that the criteria ask.
struct Written {
  std::vector<int> posture;
  Samples joints;
  bool inside = true;
  int jumps = 0, changes = 0;
  double ratio = 0.0, seconds = 0.0, start = 0.0, from_seed = 0.0;
  [[nodiscard]] double bottleneck() const { return ratio + (jumps > 0 ? 1e6 : 0.0); }
};

Written write_out(const Layers& layers, const Vector& times, const JointLimits& limits, const GraphOptions& options,
                  const std::vector<int>& posture, const Joints& start) {
  Written w;
  w.posture = posture;
  w.joints.resize(times.size(), 6);
  w.joints.row(0) = start.transpose();
  w.start = start.squaredNorm();
  double slow = 0.0, jumping = 0.0;
  for (Eigen::Index t = 1; t < times.size(); ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Posture& to = layers[i][static_cast<std::size_t>(posture[i])];
    const Posture& from = layers[i - 1][static_cast<std::size_t>(posture[i - 1])];
    double seconds = 0.0, largest = 0.0;
    for (int j = 0; j < 6; ++j) {
      const double step = std::remainder(to.joints[j] - from.joints[j], 2 * pi);
      w.joints(t, j) = w.joints(t - 1, j) + step;
      seconds = std::max(seconds, std::abs(step) / limits.velocity[j]);
      largest = std::max(largest, std::abs(step));
    }
    const bool jump = largest > options.max_step;
    (jump ? jumping : slow) = std::max(jump ? jumping : slow, seconds / (times[t] - times[t - 1]));
    w.jumps += jump ? 1 : 0;
    w.changes += from.branch != to.branch ? 1 : 0;
    w.seconds += seconds;
  }
  w.ratio = w.jumps > 0 ? jumping : slow;
  for (int j = 0; j < 6; ++j) {
    w.inside = w.inside && w.joints.col(j).minCoeff() >= limits.position(j, 0) - 1e-12 &&
               w.joints.col(j).maxCoeff() <= limits.position(j, 1) + 1e-12;
  }
  if (options.seed) w.from_seed = (start - *options.seed).cwiseQuotient(limits.velocity).squaredNorm();
  return w;
}

/// Every way through: all postures, and all whole turns of the start from -1 to 1 with which the ranges are kept; or,
/// ranges left aside, the start's turns nearest to the seed.
std::vector<Written> all_ways(const Layers& layers, const Vector& times, const JointLimits& limits,
                              const GraphOptions& options, bool keep_ranges) {
  std::vector<Written> ways;
  const auto T = layers.size();
  std::vector<int> posture(T, 0);
  while (true) {
    Joints principal = layers[0][static_cast<std::size_t>(posture[0])].joints;
    if (!keep_ranges) {
      for (int j = 0; options.seed && j < 6; ++j) {
        principal[j] = (*options.seed)[j] + std::remainder(principal[j] - (*options.seed)[j], 2 * pi);
      }
      ways.push_back(write_out(layers, times, limits, options, posture, principal));
    }
    for (int code = 0; keep_ranges && code < 729; ++code) {
      Joints start = principal;
      for (int j = 0, rest = code; j < 6; ++j, rest /= 3) start[j] += 2 * pi * (rest % 3 - 1);
      Written w = write_out(layers, times, limits, options, posture, start);
      if (w.inside) ways.push_back(std::move(w));
    }
    std::size_t t = 0;
    while (t < T && ++posture[t] == static_cast<int>(layers[t].size())) posture[t++] = 0;
    if (t == T) return ways;
  }
}

/// The criteria of best_way, one after the other, on a complete list. Nothing if the list is empty.
std::optional<Written> best_of(const std::vector<Written>& ways, const GraphOptions& options) {
  if (ways.empty()) return std::nullopt;
  const auto slack = [&](double ratio) {
    return ratio < 1e6 ? ratio * options.step_slack : 1e6 + (ratio - 1e6) * options.step_slack;
  };
  double smallest = 1e300;
  for (const Written& w : ways) smallest = std::min(smallest, w.bottleneck());
  double allowed = slack(smallest), nearest = 0.0;
  if (options.seed) {
    const double admitted = smallest < 1e6 ? std::nextafter(1e6, 0.0) : slack(smallest);
    nearest = 1e300;
    for (const Written& w : ways) {
      if (w.bottleneck() <= admitted) nearest = std::min(nearest, w.from_seed);
    }
    allowed = 1e300;
    for (const Written& w : ways) {
      if (w.from_seed == nearest) allowed = std::min(allowed, w.bottleneck());
    }
    allowed = slack(allowed);
  }
  std::optional<Written> best;
  const auto key = [](const Written& w) { return std::make_tuple(w.jumps, w.changes, w.seconds, w.start); };
  for (const Written& w : ways) {
    if (w.bottleneck() > allowed + 1e-9 || (options.seed && w.from_seed != nearest)) continue;
    if (!best || key(w) < key(*best)) best = w;
  }
  return best;
}

}  // namespace

TEST_CASE("the best way is that of the complete list") {
  Random random(1);
  int found = 0, blocked = 0, with_jump = 0, kept = 0;
  for (int round = 0; round < 120; ++round) {
    const std::size_t T = 2 + random.below(2);
    JointLimits limits;
    limits.velocity << 2, 2, 3, 3, 3, 3;
    for (int j = 0; j < 6; ++j) limits.position.row(j) << random.uniform(-6.3, -2.0), random.uniform(2.0, 6.3);
    Vector times(static_cast<Eigen::Index>(T));
    for (std::size_t t = 0; t < T; ++t)
      times[static_cast<Eigen::Index>(t)] = static_cast<double>(t) + random.uniform(0.0, 0.5);
    // Every layer near the one before, so that small steps, branch changes and jumps all compete.
    Layers layers(T);
    const double spread = round % 3 == 0 ? 2.0 : 0.4;
    for (int i = 0; i < 3; ++i) {
      Joints q;
      for (double& angle : q) angle = random.uniform(-pi, pi);
      for (auto& layer : layers) {
        for (double& angle : q) angle = wrap_angle(angle + random.uniform(-spread, spread));
        layer.push_back({q, static_cast<int>(random.below(3))});
      }
    }
    GraphOptions options;
    if (round % 2 == 1) {
      options.seed = Joints::Zero();
      for (double& angle : *options.seed) angle = random.uniform(-4, 4);
    }
    auto expected = best_of(all_ways(layers, times, limits, options, false), options);
    REQUIRE(expected);
    kept += expected->inside ? 1 : 0;
    if (!expected->inside) expected = best_of(all_ways(layers, times, limits, options, true), options);
    const Way way = best_way(layers, times, limits, options);
    if (!expected) {
      ++blocked;
      CHECK(way.posture.empty());
      continue;
    }
    ++found;
    with_jump += expected->jumps > 0 ? 1 : 0;
    REQUIRE(way.posture.size() == T);
    const Written actual = write_out(layers, times, limits, options, way.posture, way.joints.row(0).transpose());
    CHECK(actual.inside);
    CHECK(way.posture == expected->posture);
    CHECK((way.joints - expected->joints).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((way.joints - actual.joints).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(way.largest_ratio == Approx(std::max(actual.ratio, 0.0)));
  }
  CHECK(found > 60);
  CHECK(blocked > 0);
  CHECK(with_jump > 10);
  CHECK(kept > 20);
  CHECK(kept < found - 20);
}

TEST_CASE("a joint that winds up starts a turn back where its range asks for it, and stops where no turn fits") {
  JointLimits limits;
  limits.velocity.setConstant(3.0);
  limits.position.col(0).setConstant(-2 * pi);
  limits.position.col(1).setConstant(2 * pi);
  const auto winding = [&](double turns) {
    constexpr int T = 101;
    Layers layers(T);
    for (int t = 0; t < T; ++t) {
      Joints q = Joints::Zero();
      q[5] = wrap_angle(2 * pi * turns * t / (T - 1.0));
      layers[static_cast<std::size_t>(t)].push_back({q, 0});
    }
    return best_way(layers, Vector::LinSpaced(T, 0.0, 10.0), limits);
  };
  CHECK(winding(0.9).joints(0, 5) == 0.0);
  const Way back = winding(1.7);
  REQUIRE(back.joints.rows() == 101);
  CHECK(back.joints(0, 5) == Approx(-2 * pi));
  CHECK(back.joints(100, 5) == Approx(0.7 * 2 * pi));
  const Way none = winding(2.5);
  CHECK(none.posture.empty());
  CHECK(none.blocked == 81);  // two turns are over after sample 80

  limits.position(5, 1) = -7.0;
  limits.position(5, 0) = -7.5;
  CHECK(winding(0.1).posture.empty());
  CHECK(winding(0.1).blocked == 0);
}

TEST_CASE("ranges of any width are looked at as far as the way winds") {
  JointLimits limits;
  limits.velocity.setConstant(3.0);
  const double width = GENERATE(4.0 * pi, 200.0 * pi, 1e9, 1e300);
  INFO("ranges up to " << width);
  limits.position.col(0).setConstant(-width);
  limits.position.col(1).setConstant(width);
  limits.position.row(2) << 0.0, 2.0 * pi;  // joint 3 has to start a turn up
  const bool jumping = GENERATE(false, true);
  constexpr int T = 201;
  Layers layers(T);
  const double turns = std::min(5.0, width / (2.0 * pi) + 1.0);
  for (int t = 0; t < T; ++t) {
    Joints q = Joints::Zero();
    q[2] = -1.0 + 0.5 * t / T;
    q[5] = wrap_angle(2 * pi * turns * t / (T - 1.0));
    if (jumping && t == T - 1) q[0] = 2.0;
    layers[static_cast<std::size_t>(t)].push_back({q, 0});
    q[5] = wrap_angle(q[5] + pi);
    layers[static_cast<std::size_t>(t)].push_back({q, 1});
  }
  const Way way = best_way(layers, Vector::LinSpaced(T, 0.0, 20.0), limits);
  REQUIRE(way.joints.rows() == T);
  CHECK(way.joints(0, 2) == Approx(2 * pi - 1.0));
  CHECK(way.joints(T - 1, 5) - way.joints(0, 5) == Approx(2 * pi * turns));
  for (int j = 0; j < 6; ++j) {
    CHECK(way.joints.col(j).minCoeff() >= limits.position(j, 0) - 1e-9);
    CHECK(way.joints.col(j).maxCoeff() <= limits.position(j, 1) + 1e-9);
  }

  GraphOptions far;  // joint 6 stands some turns up, as it may
  far.seed = way.joints.row(0).transpose();
  (*far.seed)[5] = std::min(width, 60.0 * pi) - turns * 2.0 * pi;
  const Way up = best_way(layers, Vector::LinSpaced(T, 0.0, 20.0), limits, far);
  REQUIRE(up.joints.rows() == T);
  CHECK(std::abs(up.joints(0, 5) - (*far.seed)[5]) < pi);
}
