// Closed-form inverse kinematics of the exact UR arrangement.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "lfdtools/ur_geometry.hpp"

namespace lfd {

/// An angle by its sine and cosine.
struct Turn {
  double s = 0.0;
  double c = 1.0;
};

inline Turn operator+(const Turn& a, const Turn& b) {
  return {a.s * b.c + a.c * b.s, a.c * b.c - a.s * b.s};
}
inline Turn operator-(const Turn& a, const Turn& b) {
  return {a.s * b.c - a.c * b.s, a.c * b.c + a.s * b.s};
}
inline Turn turn_of(double angle) {
  return {std::sin(angle), std::cos(angle)};
}
inline double angle_of(const Turn& t) {
  return std::atan2(t.s, t.c);
}

/// The angle of the point (c, s); 0 for the origin, where any angle would do.
inline Turn direction(double s, double c) {
  const double length = std::sqrt(s * s + c * c);
  return length > 0.0 ? Turn{s / length, c / length} : Turn{};
}

/// wrap_angle for |angle| < 3 pi, without the cost of a remainder.
inline double wrap_once(double angle) {
  constexpr double pi = std::numbers::pi;
  return angle > pi ? angle - 2.0 * pi : angle <= -pi ? angle + 2.0 * pi : angle;
}

struct Candidate {
  std::array<Turn, 6> q;
  int branch = 0;
  bool wrist_free = false;
};

/// Two roots that differ less than this from a double one count as one: rounding moves them that far apart when a
/// second singularity is near. In units of the arm's reach; in the angles it is 3e-7 rad for q1 and the stretched
/// elbow, less for the folded one.
inline constexpr double double_root = 5e-14;

/// What the closed form may do at its edges.
struct Edges {
  double q6_wanted = 0.0;   ///< [rad], angle of the exact arm
  double wrist_free = 0.0;  ///< sin q5 up to which q6 is free
  double reach = 0.0;       ///< how far out of reach is still clamped [m]; the caller verifies
  double apart = 0.0;       ///< least sine between two roots: 0, or for a calibrated arm some distance from the double
                            ///< root, whose Jacobian is singular and where its own roots may be two
};

/// Closed form for the exact arm. In frame 1 (x level, y up, z along joint 2) the arm of joints 2, 3, 4 is planar, and
/// M = R01^T R = Rz(q2 + q3 + q4) Ry(-q5) Rz(q6).
class ClosedForm {
 public:
  ClosedForm(const UrGeometry& geometry, const Pose& pose, const Edges& edges)
      : g(geometry), R(pose.rotation), p(pose.position), p5(p - g.d6 * R.col(2)), limits(edges) {
    solve();
  }

  std::array<Candidate, 8> candidates;
  std::size_t count = 0;

 private:
  void solve() {
    // The wrist centre p5 keeps the distance d4 from the vertical plane of the arm: r sin(q1 - azimuth) = d4.
    const double r = std::sqrt(p5.x() * p5.x() + p5.y() * p5.y());
    const double d = std::abs(g.d4);
    if (d - r > limits.reach) return;
    const Turn azimuth = direction(p5.y(), p5.x());
    const double sine = r > d ? g.d4 / r : std::copysign(1.0, g.d4);
    double cosine_squared = r > d ? (r - d) * (r + d) / (r * r) : 0.0;
    cosine_squared = std::max(cosine_squared, limits.apart * limits.apart);
    if (cosine_squared < double_root) {
      solve_wrist(azimuth + Turn{std::copysign(1.0, sine), 0.0}, 0);
      return;
    }
    const double cosine = std::sqrt(cosine_squared);
    solve_wrist(azimuth + direction(sine, cosine), 0);
    solve_wrist(azimuth + direction(sine, -cosine), 4);
  }

  void solve_wrist(const Turn& q1, int branch) {
    // Rows of M without its second, which is the third of R.
    const auto m0 = [&](int i) { return q1.c * R(0, i) + q1.s * R(1, i); };
    const auto m2 = [&](int i) { return q1.s * R(0, i) - q1.c * R(1, i); };
    const Vector3 M0(m0(0), m0(1), m0(2)), M1(R(2, 0), R(2, 1), R(2, 2)), M2(m2(0), m2(1), m2(2));
    const double X = q1.c * p5.x() + q1.s * p5.y(), Y = p5.z() - g.d1;

    const double s5 = std::sqrt(M2[0] * M2[0] + M2[1] * M2[1]);  // M2 = (s5 c6, -s5 s6, c5)
    const auto sum_of_234 =
        [&](const Turn& q6) {  // second column of M Rz(-q6) is (-s234, c234, 0): always well conditioned
          return direction(-(M0[0] * q6.s + M0[1] * q6.c), M1[0] * q6.s + M1[1] * q6.c);
        };
    if (s5 > limits.wrist_free) {
      const Turn q6{-M2[1] / s5, M2[0] / s5};
      const Turn q234 = sum_of_234(q6);
      solve_elbow(X, Y, {q1, {}, {}, q234, direction(s5, M2[2]), q6}, branch, false);
      solve_elbow(X, Y, {q1, {}, {}, {-q234.s, -q234.c}, direction(-s5, M2[2]), {-q6.s, -q6.c}}, branch + 2, false);
      return;
    }
    // Axes 4 and 6 are parallel: only q234 + q6 (q5 = 0) or q234 - q6 (q5 = pi) is determined.
    const double sense = M2[2] > 0.0 ? -1.0 : 1.0;
    const double q234_at_zero = angle_of(sum_of_234({}));
    const double q234_wanted = q234_at_zero + sense * limits.q6_wanted;
    const Turn q6 = turn_of(sense * (nearest_feasible(X, Y, q234_wanted) - q234_at_zero));
    const double signed_s5 = M2[0] * q6.c - M2[1] * q6.s;  // the part of the small tilt that q5 can take
    const Turn q5 = direction(signed_s5, M2[2]);
    solve_elbow(X, Y, {q1, {}, {}, sum_of_234(q6), q5, q6}, branch + (q5.s < 0.0 ? 2 : 0), true);
  }

  /// The value of q2 + q3 + q4 nearest to the wanted one for which the elbow triangle closes. With (X, Y) at distance
  /// rho and angle theta, the squared distance to joint 4 is rho^2 + d5^2 - 2 d5 rho sin(q234 - theta).
  [[nodiscard]] double nearest_feasible(double X, double Y, double wanted) const {
    const double rho = std::sqrt(X * X + Y * Y), theta = std::atan2(Y, X);
    const double scale = 2.0 * g.d5 * rho;
    if (scale == 0.0) return wanted;
    const double inner = std::abs(std::abs(g.a2) - std::abs(g.a3)), outer = std::abs(g.a2) + std::abs(g.a3);
    const double squares = rho * rho + g.d5 * g.d5;
    const std::array<double, 2> bounds = {(squares - outer * outer) / scale, (squares - inner * inner) / scale};
    const double low = std::min(bounds[0], bounds[1]), high = std::max(bounds[0], bounds[1]);
    const double sine = std::sin(wanted - theta);
    if (sine >= low && sine <= high) return wanted;
    const double edge = std::asin(std::clamp(sine < low ? low : high, -1.0, 1.0));
    const double a = theta + edge, b = theta + std::numbers::pi - edge;
    return std::abs(wrap_angle(a - wanted)) <= std::abs(wrap_angle(b - wanted)) ? a : b;
  }

  /// q[3] holds q2 + q3 + q4 on entry.
  void solve_elbow(double X, double Y, std::array<Turn, 6> q, int branch, bool free) {
    const Turn q234 = q[3];
    const double x = X - g.d5 * q234.s, y = Y + g.d5 * q234.c;  // joint 4, seen from joint 2
    const double rho = std::sqrt(x * x + y * y);
    const double straight = g.a2 + g.a3, folded = g.a2 - g.a3;
    const double outer = std::max(std::abs(straight), std::abs(folded)),
                 inner = std::min(std::abs(straight), std::abs(folded));
    if (rho - outer > limits.reach || inner - rho > limits.reach) return;
    // Factored, so that 1 -+ cos q3 keep their digits near the stretched and the folded arm.
    const double twice = 2.0 * g.a2 * g.a3;
    const double below_one = (std::abs(straight) - rho) * (std::abs(straight) + rho) / twice;  // 1 - cos q3
    const double above_minus = (rho - std::abs(folded)) * (rho + std::abs(folded)) / twice;    // 1 + cos q3
    double sine = std::sqrt(std::max(0.0, below_one) * std::max(0.0, above_minus));
    double cosine = below_one < above_minus ? 1.0 - below_one : above_minus - 1.0;
    sine = std::max(sine, limits.apart);
    // The folded arm turns the shoulder outer / inner times as far as the elbow, hence rho.
    const bool is_double = limits.apart == 0.0 && std::min(below_one, above_minus) <= double_root * rho / outer;
    if (is_double) {
      sine = 0.0;
      cosine = below_one < above_minus ? 1.0 : -1.0;
    }
    for (const int elbow : {0, 1}) {
      if (elbow == 1 && is_double) break;
      q[2] = direction(elbow == 0 ? sine : -sine, cosine);
      const double along = g.a2 + g.a3 * q[2].c, across = g.a3 * q[2].s;
      q[1] = direction(y * along - x * across, x * along + y * across);
      q[3] = q234 - (q[1] + q[2]);
      candidates[count++] = {q, branch + elbow, free};
    }
  }

  const UrGeometry& g;
  const Matrix3& R;
  const Vector3& p;
  const Vector3 p5;
  const Edges& limits;
};

}  // namespace lfd
