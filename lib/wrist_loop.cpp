#include "wrist_loop.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace lfd {
namespace {

constexpr double least_step = 1e-4;  // along a loop [rad]
constexpr double most_step = 0.25;
constexpr std::size_t most_points = 500;  // of a loop, which has about 50
constexpr double same_point = 1e-6;       // of a loop [rad]
constexpr double on_loop = 1e-9;          // what is kept of the pose is kept to this, larger of metres and radians
constexpr double least_turn = 0.9;        // cosine between the tangents of neighbours
constexpr double touching = 5e-3;         // a tilt from which Newton steps may come to a zero [rad]

Joints wrapped(const Joints& q) {
  return q.unaryExpr([](double angle) { return wrap_angle(angle); });
}

/// Where a point's foot on the chord between two others lies, as a share of it from 0 to 1, and how far away, all of
/// them modulo 2 pi.
struct Foot {
  double share, distance;
};

Foot foot_on(const Joints& joints, const Joints& begin, const Joints& end) {
  const Joints along = end - begin, off = wrapped(joints - begin);
  const double share = std::clamp(off.dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
  return {share, (off - share * along).norm()};
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
    Joints of_tilt;                          // row of the Jacobian of the tilt
    for (std::size_t j = 0; j < 6; ++j) {
      const Vector3 axis = frames[j].rotation.col(2);
      const auto row = static_cast<Eigen::Index>(j);
      transposed.row(row) << axis.cross(frames[6].position - frames[j].position).transpose(), axis.dot(axis5),
          axis.dot(axis6);
      of_tilt[row] = -axis.dot(across);
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
      point.slope = of_tilt.dot(point.tangent);  // exact: the turn left is along `across`, whose change is across it
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
    if (next.tangent.dot(from.tangent) < 0.0) next.turn_back();
    const double gone = (next.joints - from.joints).dot(from.tangent);
    if (gone < 0.5 * length || gone > 1.5 * length || next.tangent.dot(from.tangent) < least_turn) continue;
    length = std::min(1.5 * length, most_step);
    return true;
  }
  return false;
}

/// Whether the piece of a loop between two points leads through another point of a loop: from the foot on its chord
/// the loop is followed towards that, which another loop that passes near by would not reach.
bool WristLoops::leads_through(const Joints& begin, const Joints& end, const Point& point) const {
  const auto [share, distance] = foot_on(point.joints, begin, end);
  if (distance > 0.5 * (end - begin).norm()) return false;
  Point near;
  Joints start = begin + share * (end - begin);
  double before = 1e300;
  for (int i = 0; i < 8; ++i) {
    if (!corrected(start, near)) return false;
    const Joints left = wrapped(point.joints - near.joints);
    if (left.norm() < same_point) return true;
    if (!(left.norm() < 0.7 * before)) return false;
    before = left.norm();
    start = near.joints + left.dot(near.tangent) * near.tangent;
  }
  return false;
}

bool WristLoops::is_known(const Point& point) const {
  for (const auto& loop : loops_) {
    for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
      if (leads_through(loop[i], loop[i + 1], point)) return true;
    }
  }
  return false;
}

/// Adds points until the loop meets itself, or can be followed no further. It is compared with its first points (where
/// it begins in a bend its next round may pass one too far off to tell) and with that of the last power of two (where
/// two loops nearly cross it may have gone over to the other, and not come back).
/// @return whether it meets itself
bool WristLoops::follow(std::vector<Point>& points) const {
  double length = 0.1;
  std::size_t mark = 8;
  while (points.size() < most_points) {
    Point next;
    if (!step(points.back(), length, next)) return false;
    const Joints here = points.back().joints;
    if (points.size() > 2 * mark) mark *= 2;
    for (const std::size_t known : {std::size_t{0}, std::size_t{3}, mark}) {
      if (points.size() < known + 3) break;
      Point met = points[known];
      if (next.tangent.dot(met.tangent) < 0.0 || !leads_through(here, next.joints, met)) continue;
      met.joints = here + wrapped(met.joints - here);
      points.push_back(met);
      return true;
    }
    points.push_back(next);
  }
  return false;
}

void WristLoops::trace(const Joints& joints) {
  Point first;
  if (!corrected(joints, first) || is_known(first)) return;
  std::vector<Point> points{first};
  if (!follow(points)) {  // its other half goes before it
    first.turn_back();
    std::vector<Point> back{first};
    (void)follow(back);
    for (Point& point : back) point.turn_back();
    points.insert(points.begin(), back.rbegin(), back.rend() - 1);
  }
  std::vector<Joints>& loop = loops_.emplace_back();
  for (const Point& point : points) loop.push_back(point.joints);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point &begin = points[i], &end = points[i + 1];
    if ((begin.tilt < 0.0) != (end.tilt < 0.0)) {
      find_zero(begin, end);
    } else if ((begin.slope < 0.0) != (end.slope < 0.0) && (begin.tilt < 0.0) != (begin.slope < 0.0)) {
      find_dip(begin, end);
    }
  }
}

/// The point over a share of the chord between two.
bool WristLoops::between(const Point& a, const Point& b, double share, Point& point) const {
  return corrected(a.joints + share * (b.joints - a.joints), point);
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
void WristLoops::find_dip(Point begin, Point end) {
  for (int i = 0; i < 10; ++i) {
    Point middle;
    if (!between(begin, end, std::clamp(begin.slope / (begin.slope - end.slope), 0.1, 0.9), middle)) break;
    if (middle.tangent.dot(end.joints - begin.joints) < 0.0) middle.turn_back();
    if ((middle.tilt < 0.0) != (begin.tilt < 0.0)) {
      find_zero(begin, middle);
      find_zero(middle, end);
      return;
    }
    ((middle.slope < 0.0) == (begin.slope < 0.0) ? begin : end) = middle;
  }
  const Point& lowest = std::abs(begin.tilt) < std::abs(end.tilt) ? begin : end;
  if (std::abs(lowest.tilt) < touching) zeros_.push_back(lowest.joints);
}

}  // namespace lfd
