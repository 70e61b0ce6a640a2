#include "lfdtools/alignment.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "lfdtools/dtw.hpp"
#include "lfdtools/interpolation.hpp"
#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

constexpr double pi = std::numbers::pi;

/// A curved reach from (0, 0, 0) that rests at both ends, at share q of the motion.
Samples curve(const Vector& q) {
  Samples y(q.size(), 3);
  for (Index i = 0; i < q.size(); ++i) {
    const double s = q[i] * q[i] * q[i] * (10 + q[i] * (6 * q[i] - 15));
    y.row(i) << 0.5 * s, 0.1 * std::sin(pi * s), 0.2 * s * s;
  }
  return y;
}

/// The reach in `duration` seconds, at share q = s + c sin(pi s) of the motion after share s of the time, from time
/// `origin`.
Trajectory reach(double duration, double c, double origin = 0, Index samples = 301) {
  const Vector s = linspace(0, 1, samples);
  const Vector q = (s.array() + c * (pi * s.array()).sin()).min(1.0);
  return {duration * s.array() + origin, curve(q)};
}

/// Elapsed time of reach(duration, c) at share q of the motion, by bisection.
double elapsed_at(double q, double duration, double c) {
  double low = 0;
  double high = 1;
  for (int k = 0; k < 60; ++k) {
    const double s = 0.5 * (low + high);
    (s + c * std::sin(pi * s) < q ? low : high) = s;
  }
  return duration * high;
}

Samples linear_in_time(const Trajectory& d, Index samples) {
  Samples y(samples, d.dimensions());
  Index j = 0;
  for (Index i = 0; i < samples; ++i) {
    const double t = d.times[0] + d.duration() * static_cast<double>(i) / static_cast<double>(samples - 1);
    while (j + 2 < d.samples() && d.times[j + 1] < t) ++j;
    const double b = std::clamp((t - d.times[j]) / (d.times[j + 1] - d.times[j]), 0.0, 1.0);
    y.row(i) = (1 - b) * d.positions.row(j) + b * d.positions.row(j + 1);
  }
  return y;
}

/// Root mean square distance of paths to their mean, at equal samples.
double spread(const std::vector<Samples>& paths) {
  Samples mean = Samples::Zero(paths[0].rows(), paths[0].cols());
  for (const auto& path : paths) mean += path / static_cast<double>(paths.size());
  double sum = 0;
  for (const auto& path : paths) sum += (path - mean).rowwise().squaredNorm().mean();
  return std::sqrt(sum / static_cast<double>(paths.size()));
}

double squared_jerk(const Samples& y) {
  const Index n = y.rows() - 3;
  return (y.bottomRows(n) - 3 * y.middleRows(2, n) + 3 * y.middleRows(1, n) - y.topRows(n)).squaredNorm();
}

Vector step_lengths(const Samples& y) {
  return (y.bottomRows(y.rows() - 1) - y.topRows(y.rows() - 1)).rowwise().norm();
}

Index stairs(const Samples& y) {
  const Vector steps = step_lengths(y);
  return (steps.array() < 1e-3 * steps.mean()).count();
}

/// target,demo,t,x,y,z,... by target; empty when the file is not there.
std::map<std::string, std::vector<Trajectory>> recording(const std::string& name) {
  std::map<std::string, std::vector<std::vector<std::array<double, 4>>>> rows;
  std::ifstream file(std::string(LFD_DATA_DIR) + "/" + name + "/demos.csv");
  std::string line;
  std::string before;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string target;
    std::string demo;
    std::string cell;
    std::getline(cells, target, ',');
    std::getline(cells, demo, ',');
    if (target + "," + demo != before) rows[target].emplace_back();
    before = target + "," + demo;
    auto& row = rows[target].back().emplace_back();
    for (double& value : row) {
      std::getline(cells, cell, ',');
      value = std::stod(cell);
    }
  }
  std::map<std::string, std::vector<Trajectory>> out;
  for (const auto& [target, demos] : rows) {
    for (const auto& demo : demos) {
      Trajectory& t = out[target].emplace_back();
      t.times.resize(static_cast<Index>(demo.size()));
      t.positions.resize(static_cast<Index>(demo.size()), 3);
      for (Index i = 0; i < t.times.size(); ++i) {
        const auto& row = demo[static_cast<std::size_t>(i)];
        t.times[i] = row[0];
        t.positions.row(i) << row[1], row[2], row[3];
      }
    }
  }
  return out;
}

const std::vector<double> durations = {3.0, 2.4, 3.6, 2.8};
const std::vector<double> tempos = {0.0, 0.12, -0.15, 0.06};

std::vector<Trajectory> reaches() {
  std::vector<Trajectory> group;
  for (std::size_t m = 0; m < durations.size(); ++m) group.push_back(reach(durations[m], tempos[m], 10.0 * double(m)));
  return group;
}

}  // namespace

TEST_CASE("known warps are found, and the group's clock is the mean of the demonstrations' own") {
  const GroupAlignment group = align(reaches());
  CHECK(group.aligned[0].duration() == Approx(2.95).epsilon(1e-14));
  for (double q = 0.02; q < 1; q += 0.02) {  // at each share of the motion: own elapsed times, and their mean
    double mean = 0;
    for (std::size_t m = 0; m < 4; ++m) mean += elapsed_at(q, durations[m], tempos[m]) / 4;
    for (std::size_t m = 0; m < 4; ++m) {
      const double s = group.warps[m](Vector::Constant(1, mean / 2.95))[0] / durations[m];
      const Vector found = Vector::Constant(1, s + tempos[m] * std::sin(pi * s));
      REQUIRE((curve(found) - curve(Vector::Constant(1, q))).norm() < 0.005);  // 1 % of a reach of half a metre
    }
  }
  std::vector<Samples> before;
  std::vector<Samples> after;
  for (std::size_t m = 0; m < 4; ++m) {
    before.push_back(linear_in_time(reaches()[m], 301));
    after.push_back(group.aligned[m].positions);
  }
  CHECK(spread(after) < 0.03 * spread(before));
  Vector mean = Vector::Zero(group.warps[0].elapsed.size());
  for (const Warp& warp : group.warps) mean += warp.elapsed / 4;
  CHECK((mean - 2.95 * group.warps[0].phases).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("demonstrations share one even grid from 0 to the mean duration and keep their ends to the bit") {
  for (const Reference reference : {Reference::medoid, Reference::longest, Reference::barycentre, Reference::chosen}) {
    for (const Clock clock : {Clock::mean, Clock::reference}) {
      AlignmentOptions options;
      options.reference = reference;
      options.clock = clock;
      options.chosen = 3;
      options.samples = 137;
      const auto demos = reaches();
      const GroupAlignment group = align(demos, options);
      if (reference == Reference::longest) CHECK(group.reference == 2);
      if (reference == Reference::chosen) CHECK(group.reference == 3);
      for (std::size_t m = 0; m < 4; ++m) {
        const Trajectory& a = group.aligned[m];
        CHECK((a.times - linspace(0, 2.95, 137)).cwiseAbs().maxCoeff() < 1e-14);
        CHECK(a.start() == demos[m].start());
        CHECK(a.goal() == demos[m].goal());
        const Warp& warp = group.warps[m];
        CHECK((warp.phases.tail(warp.phases.size() - 1) - warp.phases.head(warp.phases.size() - 1)).minCoeff() > 0);
        CHECK((warp.elapsed.tail(warp.phases.size() - 1) - warp.elapsed.head(warp.phases.size() - 1)).minCoeff() > 0);
      }
      if (clock == Clock::reference) {  // its own timing, scaled
        const auto r = static_cast<std::size_t>(group.reference);
        const CubicSpline own(demos[r].times.array() - demos[r].times[0], demos[r].positions);
        CHECK((own(linspace(0, durations[r], 137)) - group.aligned[r].positions).cwiseAbs().maxCoeff() < 1e-9);
      }
    }
  }
}

TEST_CASE("a group of one is its spline on an even grid, as many samples as it had") {
  Trajectory demo = reach(2, 0.1, 5, 90);
  for (Index i = 1; i + 1 < 90; ++i) demo.times[i] += 0.005 * std::sin(3.0 * static_cast<double>(i));
  const GroupAlignment group = align({demo});
  const CubicSpline spline(demo.times.array() - 5, demo.positions);
  CHECK((group.aligned[0].positions - spline(linspace(0, 2, 90))).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a warp is a minimum of what its header states: bending it either way costs more") {
  const Trajectory r = reach(3, 0);
  const Trajectory x = reach(2.5, 0.1);
  const CubicSpline reference(r.times / 3, r.positions);
  const CubicSpline path(x.times / 2.5, x.positions);
  const Vector s = linspace(0, 1, 201);
  const Samples goal = reference(s);
  const double V = (goal.rowwise() - goal.colwise().mean()).rowwise().squaredNorm().mean();
  const auto objective = [&](const Vector& phi) {
    const Vector second = (phi.head(199) - 2 * phi.segment(1, 199) + phi.tail(199)) * 200 * 200;
    return (path(phi) - goal).rowwise().squaredNorm().mean() / V + warp_stiffness * second.squaredNorm() / 200;
  };
  const Vector phi = warp_onto(r, x).elapsed / 2.5;
  for (int k = 1; k <= 6; ++k) {
    const Vector wave = (k * pi * s.array()).sin();
    CHECK(objective(phi + 0.003 * wave) > objective(phi));
    CHECK(objective(phi - 0.003 * wave) > objective(phi));
  }
  CHECK(objective(phi) < 0.05 * objective(s));
}

TEST_CASE("a long wait is crossed within the slope limits and the band is kept") {
  Trajectory waits = reach(5, 0, 0, 501);  // 2 s still, then the reach
  const Vector share = (linspace(0, 5, 501).array() - 2).max(0.0) / 3;
  waits.positions = curve(share);
  const Warp warp = warp_onto(reach(3, 0), waits);
  const Vector slope = (warp.elapsed.tail(200) - warp.elapsed.head(200)) / 5 * 200;
  CHECK(slope.minCoeff() >= 1 / steepest_warp - 1e-9);
  CHECK(slope.maxCoeff() <= steepest_warp + 1e-9);
  const Warp banded = warp_onto(reach(3, 0), waits, 0.1);
  CHECK((banded.elapsed / 5 - banded.phases).cwiseAbs().maxCoeff() <= 0.1 + 1e-12);
  CHECK((warp.elapsed / 5 - warp.phases).cwiseAbs().maxCoeff() > 0.2);
}

TEST_CASE("samples at nearly the same time do not throw the spline off") {
  auto demos = reaches();
  Trajectory& d = demos[1];
  Trajectory doubled{Vector(2 * 301 - 1), Samples(2 * 301 - 1, 3)};
  for (Index i = 0; i < 301; ++i) {
    for (Index k = 2 * i; k < std::min<Index>(2 * i + 2, 601); ++k) {
      doubled.times[k] = d.times[i] + (k % 2 == 1 ? 1e-9 : 0.0);
      doubled.positions.row(k) = d.positions.row(i).array() + (k % 2 == 1 ? 1e-3 : 0.0);
    }
  }
  const Samples clean = align(demos).aligned[1].positions;
  demos[1] = doubled;
  AlignmentOptions options;
  options.samples = 301;
  const GroupAlignment group = align(demos, options);
  CHECK((group.aligned[1].positions - clean).cwiseAbs().maxCoeff() < 2e-3);
  CHECK(group.aligned[1].goal() == doubled.goal());
}

TEST_CASE("neither threads nor the origin of time change a bit of the result") {
  const auto demos = reaches();
  auto later = demos;
  for (auto& demo : later) demo.times.array() += 1024 - demo.times[0];
  auto sooner = demos;
  for (auto& demo : sooner) demo.times.array() -= demo.times[0];
  AlignmentOptions two;
  two.jobs = 2;
  for (std::size_t m = 0; m < 4; ++m) {
    CHECK(align(demos).aligned[m].positions == align(demos, two).aligned[m].positions);
    CHECK((align(later).aligned[m].positions - align(sooner).aligned[m].positions).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("costs are the textbook's, the medoid has the least sum, and a stranger is named and left out") {
  Random random(7);
  std::vector<Trajectory> demos;
  for (int m = 0; m < 9; ++m) {
    demos.push_back(reach(random.uniform(2.5, 3.5), random.uniform(-0.1, 0.1)));
    demos.back().positions.col(1).array() += 0.01 * random.normal();
  }
  demos[4].positions.col(1) *= -3.0;  // the other way round
  const Matrix costs = pairwise_costs(demos);
  CHECK(costs(2, 5) == dtw_cost(demos[5].positions, demos[2].positions));
  CHECK(costs == costs.transpose());
  CHECK(costs.diagonal().isZero(0));
  AlignmentOptions options;
  const GroupAlignment all = align(demos, options);
  CHECK(all.costs == costs);
  Index least = 0;
  costs.rowwise().sum().minCoeff(&least);
  CHECK(all.reference == least);
  CHECK(all.outliers == std::vector<bool>{false, false, false, false, true, false, false, false, false});
  CHECK(all.kept.size() == 9);
  options.leave_out_outliers = true;
  const GroupAlignment rest = align(demos, options);
  CHECK(rest.kept == std::vector<Index>{0, 1, 2, 3, 5, 6, 7, 8});
  CHECK(rest.aligned.size() == 8);
  CHECK(rest.trimmed.size() == 9);
}

TEST_CASE("idle ends are cut in spite of tremor, and what is cut is said") {
  Random random(3);
  Trajectory demo{linspace(7, 13, 601), Samples(601, 3)};  // 1 s still, 3 s of motion, 2 s still
  demo.positions = curve((linspace(0, 6, 601).array() - 1).max(0.0).min(3.0) / 3);
  for (Index i = 0; i < demo.positions.size(); ++i) demo.positions.data()[i] += 5e-4 * random.normal();
  const Trimmed cut = trim(demo);
  CHECK(cut.start == Approx(1.2).margin(0.25));  // a reach at minimum jerk is slow for its first 0.2 s
  CHECK(cut.end == Approx(2.2).margin(0.25));
  CHECK(cut.trajectory.duration() + cut.start + cut.end == Approx(6).epsilon(1e-12));
  CHECK(cut.trajectory.times[0] == Approx(7 + cut.start).epsilon(1e-12));
  AlignmentOptions options;
  options.trim = default_trim;
  const GroupAlignment group = align({demo, demo}, options);
  CHECK(group.trimmed[1].start == cut.start);
  CHECK(group.aligned[0].start() == cut.trajectory.start());
  CHECK(trim(reach(3, 0), 1e-9).trajectory.samples() > 295);
}

TEST_CASE("what cannot be aligned is refused by name") {
  const auto demos = reaches();
  AlignmentOptions options;
  CHECK(refusal_of([&] { (void)align({}); }).id == "alignment.empty");
  options.samples = 1;
  CHECK(refusal_of([&] { (void)align(demos, options); }).id == "alignment.samples");
  options = {};
  options.reference = Reference::chosen;
  options.chosen = 4;
  CHECK(refusal_of([&] { (void)align(demos, options); }).id == "alignment.chosen");
  options = {};
  options.trim = 1.0;
  CHECK(refusal_of([&] { (void)align(demos, options); }).id == "alignment.trim");
  options = {};
  options.window = 0.0;
  CHECK(refusal_of([&] { (void)align(demos, options); }).id == "dtw.window");
  CHECK(refusal_of([&] {
          (void)align({demos[0], {linspace(0, 1, 3), Samples::Zero(3, 2)}});
        }).id == "alignment.dimensions");
  CHECK(refusal_of([&] { (void)trim({linspace(0, 1, 9), Samples::Zero(9, 2)}); }).id == "alignment.no_motion");
  CHECK(align({{linspace(0, 1, 9), Samples::Zero(9, 2)}, {linspace(0, 2, 5), Samples::Zero(5, 2)}}).aligned.size() ==
        2);
  CHECK(
      align({{linspace(0, 1, 2), Samples::Random(2, 2)}, {linspace(0, 2, 2), Samples::Random(2, 2)}}).aligned.size() ==
      2);
}

TEST_CASE("recordings: closer together, no staircases, no rougher, first and last samples kept") {
  for (const std::string name : {"hug_reach_S01", "hug_reach_S02", "hug_reach_S03", "panda_peg", "point2point_97"}) {
    const auto targets = recording(name);
    if (targets.empty()) WARN(name << " is not there: skipped");
    for (const auto& [target, demos] : targets) {
      const GroupAlignment group = align(demos);
      const Index T = group.aligned[0].samples();
      std::vector<Samples> before;
      std::vector<Samples> after;
      double jerk_before = 0;
      double jerk_after = 0;
      Index more_stairs = 0;
      for (std::size_t m = 0; m < demos.size(); ++m) {
        before.push_back(linear_in_time(demos[m], T));
        after.push_back(group.aligned[m].positions);
        const Vector s = (demos[m].times.array() - demos[m].times[0]) / demos[m].duration();
        jerk_before += squared_jerk(CubicSpline(s, demos[m].positions)(linspace(0, 1, T)));
        jerk_after += squared_jerk(after[m]);
        more_stairs += stairs(after[m]) > stairs(before[m]) ? 1 : 0;
        REQUIRE(group.aligned[m].times == group.aligned[0].times);
        REQUIRE(group.aligned[m].start() == demos[m].start());
        REQUIRE(group.aligned[m].goal() == demos[m].goal());
        // A short step is no stair where the recording itself stands still: there it rests for the step's whole time.
        const Vector steps = step_lengths(after[m]);
        const Vector elapsed = group.warps[m](linspace(0, 1, T));
        for (Index i = 0; i + 1 < T; ++i) {
          if (steps[i] >= 1e-3 * steps.mean()) continue;
          const Vector inside = linspace(elapsed[i] / demos[m].duration(), elapsed[i + 1] / demos[m].duration(), 5);
          REQUIRE(step_lengths(CubicSpline(s, demos[m].positions)(inside)).sum() < 0.1 * steps.mean());
        }
      }
      const double ratio = spread(after) / spread(before);
      std::printf(
          "%s target %s: %.1f mm linear, %.1f mm aligned, ratio %.3f; jerk ratio %.2f; more stairs in %d of %d\n",
          name.c_str(), target.c_str(), 1e3 * spread(before), 1e3 * spread(after), ratio, jerk_after / jerk_before,
          static_cast<int>(more_stairs), static_cast<int>(demos.size()));
      CHECK(ratio < 0.9);
      CHECK(jerk_after < 1.6 * jerk_before);
      // Untrimmed, panda_peg stands still for up to a third of its time: who waits less than the group waits longer on
      // its clock.
      if (name != "panda_peg") CHECK(more_stairs == 0);
    }
  }
}
