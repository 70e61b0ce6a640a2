#include "lfdtools/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lfdtools/trajectory.hpp"

namespace lfd {
namespace {

/// Index i of the interval [x_i, x_i+1] that holds q; the search starts at `hint`, so that rising queries cost O(1).
Eigen::Index interval(const Vector& x, double q, Eigen::Index hint) {
  const Eigen::Index last = x.size() - 2;
  if (q >= x[hint] && q <= x[hint + 1]) return hint;
  if (hint < last && q > x[hint + 1] && q <= x[hint + 2]) return hint + 1;
  const auto* end = x.data() + x.size();
  const auto* above = std::upper_bound(x.data(), end, q);
  return std::clamp<Eigen::Index>(above - x.data() - 1, 0, last);
}

/// Second derivatives of the not-a-knot cubic spline: the tridiagonal system of the continuity conditions, its first
/// and last unknown eliminated by equal third derivatives on both sides of the second and of the last but one sample.
Samples spline_second_derivatives(const Vector& t, const Samples& y) {
  const Eigen::Index n = t.size();
  Samples m = Samples::Zero(n, y.cols());
  if (n == 2) return m;
  const auto h = [&](Eigen::Index i) { return t[i + 1] - t[i]; };
  const auto divided = [&](Eigen::Index i) {
    return (6.0 * ((y.row(i + 1) - y.row(i)) / h(i) - (y.row(i) - y.row(i - 1)) / h(i - 1))).eval();
  };
  if (n == 3) {
    for (Eigen::Index i = 0; i < 3; ++i) m.row(i) = divided(1) / (3.0 * (h(0) + h(1)));
    return m;
  }
  const Eigen::Index inner = n - 2;
  Vector lower = Vector::Zero(inner);
  Vector diagonal(inner);
  Vector upper = Vector::Zero(inner);
  Samples right(inner, y.cols());
  for (Eigen::Index k = 0; k < inner; ++k) {
    const Eigen::Index i = k + 1;
    lower[k] = h(i - 1);
    diagonal[k] = 2.0 * (h(i - 1) + h(i));
    upper[k] = h(i);
    right.row(k) = divided(i);
  }
  const double h0 = h(0);
  const double h1 = h(1);
  diagonal[0] += h0 * (h0 + h1) / h1;
  upper[0] -= h0 * h0 / h1;
  const double g0 = h(n - 2);
  const double g1 = h(n - 3);
  diagonal[inner - 1] += g0 * (g0 + g1) / g1;
  lower[inner - 1] -= g0 * g0 / g1;
  for (Eigen::Index k = 1; k < inner; ++k) {  // Thomas algorithm
    const double factor = lower[k] / diagonal[k - 1];
    diagonal[k] -= factor * upper[k - 1];
    right.row(k) -= factor * right.row(k - 1);
  }
  m.row(inner) = right.row(inner - 1) / diagonal[inner - 1];
  for (Eigen::Index k = inner - 2; k >= 0; --k) m.row(k + 1) = (right.row(k) - upper[k] * m.row(k + 2)) / diagonal[k];
  m.row(0) = ((h0 + h1) * m.row(1) - h0 * m.row(2)) / h1;
  m.row(n - 1) = ((g0 + g1) * m.row(n - 2) - g0 * m.row(n - 3)) / g1;
  return m;
}

}  // namespace

CubicSpline::CubicSpline(Vector times, Samples values) : times_(std::move(times)), values_(std::move(values)) {
  check(Trajectory{times_, values_});
  second_ = spline_second_derivatives(times_, values_);
}

Samples CubicSpline::operator()(const Vector& t) const {
  Samples out(t.size(), values_.cols());
  const Eigen::Index n = times_.size();
  Eigen::Index i = 0;
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    if (t[k] <= times_[0]) {
      out.row(k) = values_.row(0);
    } else if (t[k] >= times_[n - 1]) {
      out.row(k) = values_.row(n - 1);
    } else {
      i = interval(times_, t[k], i);
      const double h = times_[i + 1] - times_[i];
      const double b = (t[k] - times_[i]) / h;
      const double a = 1.0 - b;
      out.row(k) = a * values_.row(i) + b * values_.row(i + 1) +
                   ((a * a * a - a) * second_.row(i) + (b * b * b - b) * second_.row(i + 1)) * (h * h / 6.0);
    }
  }
  return out;
}

Samples CubicSpline::derivative(const Vector& t) const {
  Samples out = Samples::Zero(t.size(), values_.cols());
  Eigen::Index i = 0;
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    if (t[k] < times_[0] || t[k] > times_[times_.size() - 1]) continue;
    i = interval(times_, t[k], i);
    const double h = times_[i + 1] - times_[i];
    const double b = (t[k] - times_[i]) / h;
    const double a = 1.0 - b;
    out.row(k) = (values_.row(i + 1) - values_.row(i)) / h +
                 ((1.0 - 3.0 * a * a) * second_.row(i) + (3.0 * b * b - 1.0) * second_.row(i + 1)) * (h / 6.0);
  }
  return out;
}

Pchip::Pchip(Vector x, Vector y) : x_(std::move(x)), y_(std::move(y)) {
  check(Trajectory{x_, y_});
  const Eigen::Index n = x_.size();
  slopes_ = Vector::Zero(n);
  Vector h(n - 1);
  Vector secant(n - 1);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    h[i] = x_[i + 1] - x_[i];
    secant[i] = (y_[i + 1] - y_[i]) / h[i];
  }
  for (Eigen::Index i = 1; i + 1 < n; ++i) {  // weighted harmonic mean of the neighbours' secants
    if (secant[i - 1] * secant[i] <= 0) continue;
    const double w1 = 2 * h[i] + h[i - 1];
    const double w2 = h[i] + 2 * h[i - 1];
    slopes_[i] = (w1 + w2) / (w1 / secant[i - 1] + w2 / secant[i]);
  }
  if (n == 2) {
    slopes_.setConstant(secant[0]);
    return;
  }
  const auto end_slope = [](double h0, double h1, double s0, double s1) {  // one-sided, kept monotone
    double slope = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (slope * s0 <= 0) return 0.0;
    if (s0 * s1 <= 0 && std::abs(slope) > 3 * std::abs(s0)) slope = 3 * s0;
    return slope;
  };
  slopes_[0] = end_slope(h[0], h[1], secant[0], secant[1]);
  slopes_[n - 1] = end_slope(h[n - 2], h[n - 3], secant[n - 2], secant[n - 3]);
}

Vector Pchip::operator()(const Vector& x) const {
  Vector out(x.size());
  const Eigen::Index n = x_.size();
  Eigen::Index i = 0;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] <= x_[0]) {
      out[k] = y_[0];
    } else if (x[k] >= x_[n - 1]) {
      out[k] = y_[n - 1];
    } else {
      i = interval(x_, x[k], i);
      const double h = x_[i + 1] - x_[i];
      const double b = (x[k] - x_[i]) / h;
      const double a = 1 - b;
      out[k] = (1 + 2 * b) * a * a * y_[i] + b * b * (3 - 2 * b) * y_[i + 1] +
               h * (b * a * a * slopes_[i] - b * b * a * slopes_[i + 1]);
    }
  }
  return out;
}

}  // namespace lfd
