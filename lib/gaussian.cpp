#include "lfdtools/gaussian.hpp"

#include <cmath>
#include <limits>

namespace lfd {
namespace {

/// Continued fraction of the incomplete beta function (modified Lentz), Numerical methods: DLMF 8.17.22.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  double c = 1;
  double d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < tiny ? tiny : d);
  double fraction = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      c = 1 + term / c;
      d = 1 / (std::abs(d) < tiny ? tiny : d);
      if (std::abs(c) < tiny) c = tiny;
      step = d * c;
      fraction *= step;
    }
    if (std::abs(step - 1) < 1e-16) break;
  }
  return fraction;
}

/// P(T > t) for t >= 0.
double student_t_tail(double t, double nu) {
  if (!std::isfinite(nu)) return 0.5 * std::erfc(t / std::sqrt(2.0));
  const double a = nu / 2;
  const double b = 0.5;
  const double x = nu / (nu + t * t);
  const double log_front = a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b);
  if (x >= 1) return 0.5;
  if (x < (a + 1) / (a + b + 2)) return 0.5 * std::exp(log_front) * beta_fraction(a, b, x) / a;
  return 0.5 * (1 - std::exp(log_front) * beta_fraction(b, a, 1 - x) / b);
}

}  // namespace

double log_sum_exp(const Eigen::Ref<const Vector>& v) {
  if (v.size() == 0) return -std::numeric_limits<double>::infinity();
  const double largest = v.maxCoeff();
  if (!std::isfinite(largest)) return largest;
  return largest + std::log((v.array() - largest).exp().sum());
}

double log_normal_density(const Eigen::Ref<const Vector>& x, const Eigen::Ref<const Vector>& mu, const Matrix& L) {
  const Vector e = L.triangularView<Eigen::Lower>().solve(x - mu);
  return -0.5 * (static_cast<double>(x.size()) * log_2pi + log_determinant_from_cholesky(L) + e.squaredNorm());
}

double digamma(double x) {
  double value = 0;
  for (; x < 10; ++x) value -= 1 / x;  // digamma(x) = digamma(x + 1) - 1 / x
  const double z = 1 / (x * x);        // then the asymptotic series, DLMF 5.11.2
  return value + std::log(x) - 0.5 / x -
         z * (1.0 / 12 - z * (1.0 / 120 - z * (1.0 / 252 - z * (1.0 / 240 - z * (1.0 / 132 - z * 691.0 / 32760)))));
}

double student_t_quantile(double p, double nu) {
  if (p < 0.5) return -student_t_quantile(1 - p, nu);
  const double tail = 1 - p;
  double low = 0;
  double high = 1;
  while (student_t_tail(high, nu) > tail && high < 1e300) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (student_t_tail(middle, nu) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace lfd
