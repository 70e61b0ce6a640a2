#include "lfdtools/retime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lfdtools/error.hpp"
#include "lfdtools/joint_curve.hpp"
#include "retime_excess.hpp"
#include "retime_interval.hpp"

namespace lfd {
namespace {

using retiming::Interval;
using retiming::largest_between;
using retiming::Slope;

constexpr std::size_t least_rows = 50;  // whose spline is the motion
constexpr double least_period = 1e-6;   // between rows that the path does not tell apart [s]
constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const Samples& joints, const RetimeOptions& options) {
  const auto usable = [](double limit) { return limit >= JointLimits::least_rate && limit <= JointLimits::most_rate; };
  if (!std::all_of(options.velocity.begin(), options.velocity.end(), usable) ||
      !std::all_of(options.acceleration.begin(), options.acceleration.end(), usable) ||
      (options.tip_speed && !usable(*options.tip_speed)) || options.grid < 1) {
    throw UsageError("retime.options", fmt::format("limits of speed and acceleration are from {:g} to {:g}, the grid "
                                                   "is positive",
                                                   JointLimits::least_rate, JointLimits::most_rate));
  }
  if (joints.rows() < 2 || joints.cols() != 6) {
    throw DataError("retime.shape", fmt::format("joints of {} x {}: two rows are needed at least, and six columns",
                                                joints.rows(), joints.cols()));
  }
  if (!joints.allFinite()) throw DataError("retime.not_finite", "a joint path has a value that is not a finite number");
}

}  // namespace

Retiming::State Retiming::at(const Point& begin, const Point& end, double along) const {
  const Knot& from = knots_[begin.knot];
  const Knot& to = knots_[begin.knot + 1];
  const double step = end.s - begin.s, u = (end.x - begin.x) / (2.0 * step);
  const double s = begin.s + along * step, x = std::max(0.0, begin.x + 2.0 * u * along * step);
  const double h = to.s - from.s, b = (s - from.s) / h, a = 1.0 - b;
  const Joints first =
      (to.value - from.value) / h + (h / 6.0) * ((1.0 - 3.0 * a * a) * from.second + (3.0 * b * b - 1.0) * to.second);
  const Joints second = a * from.second + b * to.second;
  State state;
  state.position =
      a * from.value + b * to.value + (h * h / 6.0) * ((a * a * a - a) * from.second + (b * b * b - b) * to.second);
  state.velocity = first * (std::sqrt(x) / stretch_);
  state.acceleration = (first * u + second * x) / (stretch_ * stretch_);
  return state;
}

Retiming::State Retiming::operator()(double t) const {
  const double own = std::clamp(t / stretch_, 0.0, points_.back().t);
  const auto later = [](double value, const Point& point) { return value < point.t; };
  auto end = std::upper_bound(points_.begin() + 1, points_.end() - 1, own, later);
  const Point& begin = *(end - 1);
  const double dt = own - begin.t, step = end->s - begin.s, u = (end->x - begin.x) / (2.0 * step);
  return at(begin, *end, std::clamp((std::sqrt(begin.x) * dt + 0.5 * u * dt * dt) / step, 0.0, 1.0));
}

/// Grid, passes over it, and what is left to stretch.
class Retiming::Solver {
 public:
  Solver(const Robot& robot, const Samples& joints, const RetimeOptions& options)
      : joints_(joints),
        options_(options),
        limits_(robot, options),
        curve_(joints),
        along_(curve_.along()),
        rows_(curve_.knots()) {}

  [[nodiscard]] Retiming solve() {
    if (curve_.at_rest()) return rest();
    set_knots();
    lay_grid();
    measure_slopes();
    const bool of_rows = options_.of_rows && rows_.size() >= least_rows;
    Retiming best;
    share_.assign(law_.points_.size() - 1, 1.0);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      pass();
      law_.stretch_ = 1.0;
      const Vector between = excess_between();
      const Vector rows = of_rows ? excess_of_rows() : Vector();
      double excess = between.maxCoeff();
      if (of_rows) excess = std::max(excess, rows.maxCoeff());
      // Between two points of the finer grid a speed passes its limit by less than the millionth.
      law_.stretch_ = excess > 1.0 ? excess * (1.0 + 1e-6) : 1.0;
      const auto stretched = [](const Retiming& law) { return law.points_.back().t * law.stretch_; };
      if (iteration == 0 || stretched(law_) < stretched(best)) best = law_;
      if (excess < 1.002) break;
      spread(between, rows);
    }
    set_times(best);
    return best;
  }

 private:
  static constexpr int most_iterations = 12;

  [[nodiscard]] Retiming rest() const {
    const Eigen::Index T = joints_.rows();
    Retiming law;
    law.times_ = Vector::LinSpaced(T, 0.0, least_period * static_cast<double>(T - 1));
    for (const Eigen::Index row : {Eigen::Index{0}, T - 1}) {
      law.knots_.push_back({static_cast<double>(row), joints_.row(row).transpose(), Joints::Zero()});
    }
    law.points_ = {{0.0, 0.0, 0.0, 0}, {static_cast<double>(T - 1), 0.0, law.times_[T - 1], 0}};
    return law;
  }

  void set_knots() {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Eigen::Index row = rows_[k];
      law_.knots_.push_back({along_[row], joints_.row(row).transpose(),
                             curve_.second_derivatives().row(static_cast<Eigen::Index>(k)).transpose()});
    }
  }

  /// Every knot, and between two of them equal intervals.
  void lay_grid() {
    const double length = curve_.length();
    for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
      const double begin = law_.knots_[k].s, h = law_.knots_[k + 1].s - begin;
      const int parts = std::max(4, static_cast<int>(std::ceil(h / length * options_.grid)));
      at_knot_.push_back(law_.points_.size());
      for (int i = 0; i < parts; ++i) law_.points_.push_back({begin + h * i / parts, 0.0, 0.0, k});
    }
    at_knot_.push_back(law_.points_.size());
    law_.points_.push_back({length, 0.0, 0.0, rows_.size() - 2});
  }

  void measure_slopes() {
    const auto& points = law_.points_;
    const std::size_t N = points.size() - 1;
    slopes_.resize(N + 1);
    for (std::size_t i = 0; i <= N; ++i) {
      // With ds/dt = 1 all along, the state's velocity and acceleration are the path's derivatives.
      Point here = points[std::min(i, N - 1)], next = points[std::min(i, N - 1) + 1];
      here.x = next.x = 1.0;
      const State state = law_.at(here, next, i < N ? 0.0 : 1.0);
      Slope& slope = slopes_[i];
      slope.first = state.velocity;
      slope.second = state.acceleration;
      const double rate = limits_.speed_share(state.position, state.velocity);
      const double bend = limits_.acceleration_share(slope.second);
      // A path that stands still at a point (a cusp of the spline) is left by its second derivative alone.
      slope.most = std::min(1.0 / std::max(rate * rate, 1e-12), rate < 1e-9 && bend > 0.0 ? 1.0 / bend : infinity);
    }
  }

  /// Backwards the largest x from which the rest can still be gone, forwards as fast as they allow.
  void pass() {
    auto& points = law_.points_;
    const std::size_t N = points.size() - 1;
    const auto interval = [&](std::size_t i) {
      return Interval(slopes_[i], slopes_[i + 1], options_.acceleration * share_[i], points[i + 1].s - points[i].s);
    };
    std::vector<double> controllable(N + 1, 0.0);
    for (std::size_t i = N; i-- > 0;) controllable[i] = interval(i).largest_begin(slopes_[i].most, controllable[i + 1]);
    for (std::size_t i = 0; i < N; ++i) {
      points[i + 1].x = interval(i).largest_end(points[i].x, controllable[i + 1]);
      const double rate = std::sqrt(points[i].x) + std::sqrt(points[i + 1].x);
      points[i + 1].t = points[i].t + 2.0 * (points[i + 1].s - points[i].s) / std::max(rate, 1e-9);
    }
  }

  /// The stretch that the limits ask for on a grid ten times as fine, for each interval of the coarser.
  [[nodiscard]] Vector excess_between() const {
    Vector excess = Vector::Ones(static_cast<Eigen::Index>(share_.size()));
    for (std::size_t i = 0; i < share_.size(); ++i) {
      double& most = excess[static_cast<Eigen::Index>(i)];
      std::array<State, 11> states;
      for (int tenth = 0; tenth <= 10; ++tenth) {
        State& state = states[static_cast<std::size_t>(tenth)];
        state = law_.at(law_.points_[i], law_.points_[i + 1], tenth / 10.0);
        most = std::max(most, limits_.speed_share(state.position, state.velocity));
      }
      // A parabola: the path's first derivative, quadratic, times a constant, and its second times (ds/dt)^2, both
      // linear.
      const Joints bend = largest_between(states[0].acceleration, states[5].acceleration, states[10].acceleration);
      most = std::max(most, std::sqrt(limits_.acceleration_share(bend)));
    }
    return excess;
  }

  /// The same of the splines through the knots over their times, for each of them: of the one that rests at both ends,
  /// and of the one of a reader who does not know that it does.
  [[nodiscard]] Vector excess_of_rows() const {
    const auto K = static_cast<Eigen::Index>(rows_.size());
    Vector times(K);
    for (Eigen::Index k = 0; k < K; ++k) times[k] = law_.points_[at_knot_[static_cast<std::size_t>(k)]].t;
    const Samples values = joints_(rows_, Eigen::all);
    const Vector at_rest = limits_.excess_of(CubicSpline(times, values, SplineEnds::at_rest), times);
    return at_rest.cwiseMax(limits_.excess_of(CubicSpline(times, values, SplineEnds::not_a_knot), times));
  }

  /// Less acceleration in the intervals between whose ends it comes to too much, as where a joint turns round, and
  /// about the knots, if any, where the spline through the rows asks for too much.
  void spread(const Vector& between, const Vector& rows) {
    std::vector<double> less(share_.size(), 1.0);
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const double excess = between[static_cast<Eigen::Index>(i)];
      less[i] = 1.0 / (excess * excess);
    }
    const Eigen::Index K = rows.size();
    for (Eigen::Index k = 0; k < K; ++k) {
      const double over = rows[k] * rows[k];
      if (!(over > 1.0)) continue;
      const auto begin = at_knot_[static_cast<std::size_t>(std::max<Eigen::Index>(0, k - 2))];
      const auto end = at_knot_[static_cast<std::size_t>(std::min(K - 1, k + 2))];
      for (std::size_t i = begin; i < end; ++i) less[i] = std::min(less[i], 1.0 / over);
    }
    for (std::size_t i = 0; i < share_.size(); ++i) share_[i] *= less[i];
  }

  void set_times(Retiming& law) const {
    const auto& points = law.points_;
    const std::size_t N = points.size() - 1;
    law.times_ = Vector::Zero(along_.size());
    std::size_t i = 0;
    for (Eigen::Index t = 1; t < along_.size(); ++t) {
      while (i + 1 < N && points[i + 1].s <= along_[t]) ++i;
      const double step = points[i + 1].s - points[i].s, gone = std::min(along_[t] - points[i].s, step);
      const double x = points[i].x + (points[i + 1].x - points[i].x) * gone / step;
      const double rate = std::sqrt(points[i].x) + std::sqrt(std::max(0.0, x));
      const double time = points[i].t + (gone > 0.0 ? 2.0 * gone / std::max(rate, 1e-9) : 0.0);
      law.times_[t] = std::max(time * law.stretch_, law.times_[t - 1] + least_period);
    }
  }

  const Samples& joints_;
  const RetimeOptions& options_;
  retiming::Limits limits_;
  JointCurve curve_;
  const Vector& along_;                    // summed distances of the rows
  const std::vector<Eigen::Index>& rows_;  // that are knots
  std::vector<std::size_t> at_knot_;       // grid point of each knot
  std::vector<Slope> slopes_;              // of the grid points
  std::vector<double> share_;              // of the acceleration limits, in the grid's intervals
  Retiming law_;
};

Retiming retime(const Robot& robot, const Samples& joints, const RetimeOptions& options) {
  check(joints, options);
  return Retiming::Solver(robot, joints, options).solve();
}

}  // namespace lfd
