#include "lfdtools/retime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/interpolation.hpp"

namespace lfd {
namespace {

constexpr double least_knot_distance = 1e-4;  // [rad]
constexpr double least_period = 1e-6;         // between rows that the path does not tell apart [s]
constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const Samples& joints, const RetimeOptions& options) {
  const bool positive = options.velocity.minCoeff() > 0.0 && options.acceleration.minCoeff() > 0.0 &&
                        (!options.tip_speed || *options.tip_speed > 0.0) && options.velocity.allFinite() &&
                        options.acceleration.allFinite();
  if (!positive || options.grid < 1) {
    throw UsageError("retime.options", "limits of speed and acceleration, and the grid, must be positive");
  }
  if (joints.rows() < 2 || joints.cols() != 6) {
    throw DataError("retime.shape", fmt::format("joints of {} x {}: two rows are needed at least, and six columns",
                                                joints.rows(), joints.cols()));
  }
  if (!joints.allFinite()) throw DataError("retime.not_finite", "a joint path has a value that is not a finite number");
}

/// First and second derivative of the path at a grid point, and the largest (ds/dt)^2 that the speed limits allow.
struct Slope {
  Joints first, second;
  double most = infinity;
};

/// a x + b y <= c
struct HalfPlane {
  double a, b, c;
};

/// One grid interval of length `step`: x = (ds/dt)^2 where it begins, y where it ends, (y - x) / (2 step) the
/// acceleration of s along it.
class Interval {
 public:
  Interval(const Slope& begin, const Slope& end, const Joints& acceleration, double step) {
    for (int j = 0; j < 6; ++j) {
      const double limit = acceleration[j];
      const double p = begin.first[j] / (2.0 * step), r = end.first[j] / (2.0 * step);
      add(begin.second[j] - p, p, limit);
      add(-r, r + end.second[j], limit);
    }
  }

  /// The largest x <= most_x from which some y in [0, most_y] can be reached. The feasible y are those from the highest
  /// of some lines up to the lowest of others, a gap concave in x and not negative at 0: Newton steps from above end at
  /// the edge after a few lines.
  [[nodiscard]] double largest_begin(double most_x, double most_y) const {
    double x = most_x;
    for (const HalfPlane& h : planes_) {
      if (h.b == 0.0 && h.a > 0.0) x = std::min(x, h.c / h.a);
    }
    for (int iteration = 0; iteration < 100; ++iteration) {
      const auto [low, high] = ends(x, most_y);
      if (low.value <= high.value) return x;
      const double next = x - (low.value - high.value) / (low.slope - high.slope);
      if (!(next < x)) break;
      x = std::max(0.0, next);
    }
    return x;
  }

  /// The largest y <= most_y that can be reached from x.
  [[nodiscard]] double largest_end(double x, double most_y) const {
    return std::max(0.0, ends(x, most_y).second.value);
  }

 private:
  struct Edge {
    double value, slope;
  };

  void add(double a, double b, double limit) {
    // What is too small to matter on the scale of the other would only give steep lines.
    if (std::abs(b) < 1e-13 * std::abs(a)) b = 0.0;
    planes_[count_++] = {a, b, limit};
    planes_[count_++] = {-a, -b, limit};
  }

  [[nodiscard]] std::pair<Edge, Edge> ends(double x, double most_y) const {
    Edge low{0.0, 0.0}, high{most_y, 0.0};
    for (const HalfPlane& h : planes_) {
      if (h.b == 0.0) continue;
      const Edge edge{(h.c - h.a * x) / h.b, -h.a / h.b};
      if (h.b > 0.0 && edge.value < high.value) high = edge;
      if (h.b < 0.0 && edge.value > low.value) low = edge;
    }
    return {low, high};
  }

  std::array<HalfPlane, 24> planes_{};
  std::size_t count_ = 0;
};

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

Retiming retime(const Robot& robot, const Samples& joints, const RetimeOptions& options) {
  check(joints, options);
  const Eigen::Index T = joints.rows();
  Vector along = Vector::Zero(T);
  for (Eigen::Index t = 1; t < T; ++t) along[t] = along[t - 1] + (joints.row(t) - joints.row(t - 1)).norm();
  const double length = along[T - 1];

  Retiming result;
  result.times_ = Vector::LinSpaced(T, 0.0, least_period * static_cast<double>(T - 1));
  std::vector<Eigen::Index> rows = {0};
  for (Eigen::Index t = 1; t < T; ++t) {
    if (along[t] - along[rows.back()] > least_knot_distance) rows.push_back(t);
  }
  if (rows.back() != T - 1) {
    if (rows.size() > 1) rows.pop_back();
    rows.push_back(T - 1);
  }
  Vector knots(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) knots[static_cast<Eigen::Index>(k)] = along[rows[k]];
  if (!(length > 1e-9)) {  // a rest
    for (const Eigen::Index row : {Eigen::Index{0}, T - 1}) {
      result.knots_.push_back({static_cast<double>(row), joints.row(row).transpose(), Joints::Zero()});
    }
    result.points_ = {{0.0, 0.0, 0.0, 0}, {static_cast<double>(T - 1), 0.0, result.times_[T - 1], 0}};
    return result;
  }
  const CubicSpline spline(knots, joints(rows, Eigen::all));
  const Samples& second = spline.second_derivatives();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    result.knots_.push_back({knots[row], joints.row(rows[k]).transpose(), second.row(row).transpose()});
  }

  // The grid: every knot, and between two of them equal intervals.
  auto& points = result.points_;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double begin = result.knots_[k].s, h = result.knots_[k + 1].s - begin;
    const int parts = std::max(4, static_cast<int>(std::ceil(h / length * options.grid)));
    for (int i = 0; i < parts; ++i) points.push_back({begin + h * i / parts, 0.0, 0.0, k});
  }
  points.push_back({length, 0.0, 0.0, rows.size() - 2});

  // With ds/dt = 1 at every point the state's velocity and acceleration are the path's derivatives.
  const std::size_t N = points.size() - 1;
  std::vector<Slope> slopes(N + 1);
  for (std::size_t i = 0; i <= N; ++i) {
    Retiming::Point here = points[std::min(i, N - 1)], next = points[std::min(i, N - 1) + 1];
    here.x = next.x = 1.0;
    const Retiming::State state = result.at(here, next, i < N ? 0.0 : 1.0);
    Slope& slope = slopes[i];
    slope.first = state.velocity;
    slope.second = state.acceleration;
    double rate = slope.first.cwiseAbs().cwiseQuotient(options.velocity).maxCoeff();
    if (options.tip_speed) {
      const Jacobian J = jacobian(robot, state.position, options.tool.position);
      rate = std::max(rate, (J.topRows<3>() * slope.first).norm() / *options.tip_speed);
    }
    const double bend = slope.second.cwiseAbs().cwiseQuotient(options.acceleration).maxCoeff();
    // A path that stands still at a point (a cusp of the spline) is left by its second derivative alone.
    slope.most = std::min(1.0 / std::max(rate * rate, 1e-12), rate < 1e-9 && bend > 0.0 ? 1.0 / bend : infinity);
  }

  const auto interval = [&](std::size_t i) {
    return Interval(slopes[i], slopes[i + 1], options.acceleration, points[i + 1].s - points[i].s);
  };
  std::vector<double> controllable(N + 1, 0.0);
  for (std::size_t i = N; i-- > 0;) controllable[i] = interval(i).largest_begin(slopes[i].most, controllable[i + 1]);
  for (std::size_t i = 0; i < N; ++i) {
    points[i + 1].x = interval(i).largest_end(points[i].x, controllable[i + 1]);
    const double rate = std::sqrt(points[i].x) + std::sqrt(points[i + 1].x);
    points[i + 1].t = points[i].t + 2.0 * (points[i + 1].s - points[i].s) / std::max(rate, 1e-9);
  }

  double excess = 1.0;
  for (std::size_t i = 0; i < N; ++i) {
    for (int tenth = 0; tenth <= 10; ++tenth) {
      const Retiming::State state = result.at(points[i], points[i + 1], tenth / 10.0);
      const double speed = state.velocity.cwiseAbs().cwiseQuotient(options.velocity).maxCoeff();
      const double bend = state.acceleration.cwiseAbs().cwiseQuotient(options.acceleration).maxCoeff();
      excess = std::max({excess, speed, std::sqrt(bend)});
      if (options.tip_speed) {
        const Jacobian J = jacobian(robot, state.position, options.tool.position);
        excess = std::max(excess, (J.topRows<3>() * state.velocity).norm() / *options.tip_speed);
      }
    }
  }
  // Between two points of the finer grid a limit is passed by less than the millionth.
  result.stretch_ = excess > 1.0 ? excess * (1.0 + 1e-6) : 1.0;

  std::size_t i = 0;
  for (Eigen::Index t = 1; t < T; ++t) {
    while (i + 1 < N && points[i + 1].s <= along[t]) ++i;
    const double step = points[i + 1].s - points[i].s, gone = std::min(along[t] - points[i].s, step);
    const double x = points[i].x + (points[i + 1].x - points[i].x) * gone / step;
    const double rate = std::sqrt(points[i].x) + std::sqrt(std::max(0.0, x));
    const double time = points[i].t + (gone > 0.0 ? 2.0 * gone / std::max(rate, 1e-9) : 0.0);
    result.times_[t] = std::max(time * result.stretch_, result.times_[t - 1] + least_period);
  }
  return result;
}

}  // namespace lfd
