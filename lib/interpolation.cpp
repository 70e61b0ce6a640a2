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

/// Second derivatives m of a cubic spline, from the tridiagonal system that the continuity of its first derivative
/// sets: h(i-1) m(i-1) + 2 (h(i-1) + h(i)) m(i) + h(i) m(i+1) = 6 (slope(i) - slope(i-1)) at every inner sample.
class SecondDerivatives {
 public:
  SecondDerivatives(const Vector& t, const Samples& y) : n_(t.size()), h_(t.tail(n_ - 1) - t.head(n_ - 1)) {
    lower_ = diagonal_ = upper_ = Vector::Zero(n_);
    right_ = Samples::Zero(n_, y.cols());
    slopes_ = (y.bottomRows(n_ - 1) - y.topRows(n_ - 1)).array().colwise() / h_.array();
    for (Eigen::Index i = 1; i + 1 < n_; ++i) {
      lower_[i] = h_[i - 1];
      diagonal_[i] = 2.0 * (h_[i - 1] + h_[i]);
      upper_[i] = h_[i];
      right_.row(i) = 6.0 * (slopes_.row(i) - slopes_.row(i - 1));
    }
  }

  /// The first and the last unknown are eliminated by the equal third derivatives.
  [[nodiscard]] Samples not_a_knot() {
    Samples m = Samples::Zero(n_, right_.cols());
    if (n_ == 2) return m;
    if (n_ == 3) {
      for (Eigen::Index i = 0; i < 3; ++i) m.row(i) = right_.row(1) / (3.0 * (h_[0] + h_[1]));
      return m;
    }
    const double h0 = h_[0], h1 = h_[1], g0 = h_[n_ - 2], g1 = h_[n_ - 3];
    diagonal_[1] += h0 * (h0 + h1) / h1;
    upper_[1] -= h0 * h0 / h1;
    diagonal_[n_ - 2] += g0 * (g0 + g1) / g1;
    lower_[n_ - 2] -= g0 * g0 / g1;
    solve(1, n_ - 2, m);
    m.row(0) = ((h0 + h1) * m.row(1) - h0 * m.row(2)) / h1;
    m.row(n_ - 1) = ((g0 + g1) * m.row(n_ - 2) - g0 * m.row(n_ - 3)) / g1;
    return m;
  }

  [[nodiscard]] Samples at_rest() {
    diagonal_[0] = 2.0 * h_[0];
    upper_[0] = h_[0];
    right_.row(0) = 6.0 * slopes_.row(0);
    lower_[n_ - 1] = h_[n_ - 2];
    diagonal_[n_ - 1] = 2.0 * h_[n_ - 2];
    right_.row(n_ - 1) = -6.0 * slopes_.row(n_ - 2);
    Samples m(n_, right_.cols());
    solve(0, n_ - 1, m);
    return m;
  }

 private:
  /// Rows first..last of the system, by the Thomas algorithm.
  void solve(Eigen::Index first, Eigen::Index last, Samples& m) {
    for (Eigen::Index i = first + 1; i <= last; ++i) {
      const double factor = lower_[i] / diagonal_[i - 1];
      diagonal_[i] -= factor * upper_[i - 1];
      right_.row(i) -= factor * right_.row(i - 1);
    }
    m.row(last) = right_.row(last) / diagonal_[last];
    for (Eigen::Index i = last - 1; i >= first; --i) {
      m.row(i) = (right_.row(i) - upper_[i] * m.row(i + 1)) / diagonal_[i];
    }
  }

  Eigen::Index n_;
  Vector h_, lower_, diagonal_, upper_;
  Samples right_, slopes_;
};

}  // namespace

CubicSpline::CubicSpline(Vector times, Samples values, SplineEnds ends)
    : times_(std::move(times)), values_(std::move(values)) {
  check(Trajectory{times_, values_});
  SecondDerivatives of(times_, values_);
  second_ = ends == SplineEnds::at_rest ? of.at_rest() : of.not_a_knot();
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
