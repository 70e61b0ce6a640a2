#include "wrist_loop.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace lfd {
namespace {

constexpr double least_step = 1e-4;  // along a loop [rad]
constexpr double most_step = 0.25;
constexpr int most_points = 2000;   // of a loop
constexpr double on_loop = 1e-9;    // what is kept of the pose is kept to this, larger of metres and radians
constexpr double least_turn = 0.9;  // cosine between the tangents of neighbours
constexpr double touching = 5e-3;   // a tilt from which Newton steps may come to a zero [rad]

Joints wrapped(const Joints& q) {
  return q.unaryExpr([](double angle) { return wrap_angle(angle); });
}

/// How far a point is from a piece of a loop, all of them modulo 2 pi; from beyond its ends to them.
double distance_from(const Joints& joints, const Joints& begin, const Joints& end) {
  const Joints along = end - begin, off = wrapped(joints - begin);
  const double share = std::clamp(off.dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
  return (off - share * along).norm();
}

}  // namespace

/// Newton steps of least norm onto the loop; the tangent is what they leave out.
bool WristLoops::corrected(const Joints& start, Point& point) const {
  point.joints = start;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const auto frames = joint_frames(robot_, point.joints);
    const Vector3 axis5 = frames[4].rotation.col(2), axis6 = frames[5].rotation.col(2);
    const Vector3 across = axis5.cross(axis6).normalized();
    const Vector3 turn = vector_from_rotation(flange_.rotation * frames[6].rotation.transpose());
    Eigen::Matrix<double, 6, 5> transposed;  // of the Jacobian of what is kept
    for (std::size_t j = 0; j < 6; ++j) {
      const Vector3 axis = frames[j].rotation.col(2);
      const auto row = static_cast<Eigen::Index>(j);
      transposed.row(row) << axis.cross(frames[6].position - frames[j].position).transpose(), axis.dot(axis5),
          axis.dot(axis6);
    }
    Eigen::Matrix<double, 5, 1> off;
    off << flange_.position - frames[6].position, turn.dot(axis5), turn.dot(axis6);
    const Eigen::HouseholderQR<Eigen::Matrix<double, 6, 5>> qr(transposed);
    const auto R = qr.matrixQR().topRows<5>();
    if (R.diagonal().cwiseAbs().minCoeff() < 1e-9) return false;
    const Eigen::Matrix<double, 6, 6> Q = qr.householderQ();
    if (off.cwiseAbs().maxCoeff() <= on_loop) {
      point.tangent = Q.col(5);
      point.tilt = turn.dot(across);
      return true;
    }
    const Eigen::Matrix<double, 5, 1> y = R.triangularView<Eigen::Upper>().transpose().solve(off);
    Joints move = Q.leftCols<5>() * y;
    const double length = move.norm();
    if (!(length < 1e6)) return false;
    if (length > 0.3) move *= 0.3 / length;
    point.joints += move;
  }
  return false;
}

/// The next point, about `length` further, which becomes what the step after it may try.
bool WristLoops::step(const Point& from, double& length, Point& next) const {
  for (; length >= least_step; length *= 0.5) {
    if (!corrected(from.joints + length * from.tangent, next)) continue;
    if (next.tangent.dot(from.tangent) < 0.0) next.tangent *= -1.0;
    const double gone = (next.joints - from.joints).dot(from.tangent);
    if (gone < 0.5 * length || gone > 1.5 * length || next.tangent.dot(from.tangent) < least_turn) continue;
    length = std::min(1.5 * length, most_step);
    return true;
  }
  return false;
}

bool WristLoops::is_known(const Joints& joints) const {
  for (std::size_t k = 0; k < loop_begin_.size(); ++k) {
    const std::size_t end = k + 1 < loop_begin_.size() ? loop_begin_[k + 1] : traced_.size();
    for (std::size_t i = loop_begin_[k]; i + 1 < end; ++i) {
      const Joints along = traced_[i + 1] - traced_[i];
      // A chord leaves its arc by an eighth of its length times the angle between their tangents.
      if (distance_from(joints, traced_[i], traced_[i + 1]) < 0.06 * along.norm()) return true;
    }
  }
  return false;
}

void WristLoops::trace(const Joints& joints) {
  Point first;
  if (!corrected(joints, first) || is_known(first.joints)) return;
  std::vector<Point> points{first};
  bool closed = false;
  for (const double sense : {1.0, -1.0}) {
    double length = 0.1;
    Point here = first;
    here.tangent *= sense;
    for (int i = 0; i < most_points && !closed; ++i) {
      Point next;
      if (!step(here, length, next)) break;
      closed = i > 2 &&
               distance_from(first.joints, here.joints, next.joints) < 0.06 * (next.joints - here.joints).norm() &&
               next.tangent.dot(first.tangent) * sense > 0.0;
      if (closed) {  // the last piece ends where the loop began
        const Point last = points.back();
        next = first;
        next.joints = last.joints + wrapped(first.joints - last.joints);
      }
      points.push_back(next);
      here = next;
    }
    if (closed) break;
    std::reverse(points.begin(), points.end());  // a way that stopped: its other half goes before it
  }
  loop_begin_.push_back(traced_.size());
  for (const Point& point : points) traced_.push_back(point.joints);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if ((points[i].tilt < 0.0) != (points[i + 1].tilt < 0.0)) find_zero(points[i], points[i + 1]);
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool last = i + 1 == points.size();
    if (last && !closed) break;
    find_dip(points[i - 1], points[i], last ? points[1] : points[i + 1]);
  }
}

/// The point over a share of the chord between two.
bool WristLoops::between(const Point& a, const Point& b, double share, Point& point) const {
  return corrected(a.joints + share * wrapped(b.joints - a.joints), point);
}

/// False position between two tilts of different sign, as near as Newton steps need it.
void WristLoops::find_zero(Point low, Point high) {
  for (int i = 0; i < 6; ++i) {
    Point middle;
    if (!between(low, high, std::clamp(low.tilt / (low.tilt - high.tilt), 0.1, 0.9), middle)) break;
    ((middle.tilt < 0.0) != (low.tilt < 0.0) ? high : low) = middle;
  }
  zeros_.push_back(std::abs(low.tilt) < std::abs(high.tilt) ? low.joints : high.joints);
}

/// Two zeros may hide where the tilt comes near zero and goes back; one, where it only touches it.
void WristLoops::find_dip(Point low, Point middle, Point high) {
  const double sign = middle.tilt < 0.0 ? -1.0 : 1.0;
  const auto above = [&](const Point& point) { return sign * point.tilt; };
  if (above(low) < above(middle) || above(high) < above(middle)) return;
  for (int i = 0; i < 10; ++i) {
    const bool first = (middle.joints - low.joints).norm() > wrapped(high.joints - middle.joints).norm();
    Point other;
    if (!between(first ? low : middle, first ? middle : high, 0.5, other)) break;
    if (above(other) < 0.0) {
      find_zero(first ? low : middle, other);
      find_zero(other, first ? middle : high);
      return;
    }
    if (above(other) < above(middle)) {
      (first ? high : low) = middle;
      middle = other;
    } else {
      (first ? low : high) = other;
    }
  }
  if (above(middle) < touching) zeros_.push_back(middle.joints);
}

}  // namespace lfd
