// Where a calibrated arm with a nearly singular wrist has its solutions: the loops of its self-motion, traced.
#pragma once

#include <vector>

#include "lfdtools/dh.hpp"

namespace lfd {

/// With axes 4 and 6 parallel an arm can turn joints 4 and 6 against each other and keep the hand where it is, shoulder
/// and elbow following; where they are nearly so it can keep all of the hand's pose but a tilt about one direction,
/// across axes 5 and 6, which no joint of the wrist turns about. The joints for which all else is kept form smooth
/// closed curves in joint space, through the stretched elbow as well, and the solutions are where the tilt along them
/// is zero. In an exact arm the tilt decides little; in a calibrated one it alone decides on q6.
class WristLoops {
 public:
  /// @param flange  in the base, kept as a reference [m]
  WristLoops(const Robot& robot, const Pose& flange) : robot_(robot), flange_(flange) {}

  /// Traces the loop through the joints nearest to the given ones, unless one traced before goes through them.
  /// @param joints  whose hand is within some centimetres and hundredths of a radian of the pose [rad]
  void trace(const Joints& joints);

  /// Points of the loops traced, each up to where it meets itself [rad].
  [[nodiscard]] const std::vector<std::vector<Joints>>& loops() const { return loops_; }

  /// Joints beside all zeros of the tilt on the loops traced, and beside where it comes near zero and goes back: starts
  /// for Newton steps [rad].
  [[nodiscard]] const std::vector<Joints>& zeros() const { return zeros_; }

 private:
  struct Point {
    Joints joints = Joints::Zero();
    Joints tangent = Joints::Zero();  // unit
    double tilt = 0.0;                // [rad], signed
    double slope = 0.0;               // of the tilt, along the tangent [rad/rad]

    void turn_back() {
      tangent = -tangent;
      slope = -slope;
    }
  };
  [[nodiscard]] bool corrected(const Joints& start, Point& point) const;
  [[nodiscard]] bool step(const Point& from, double& length, Point& next) const;
  [[nodiscard]] bool between(const Point& a, const Point& b, double share, Point& point) const;
  [[nodiscard]] bool follow(std::vector<Point>& points) const;
  [[nodiscard]] bool leads_through(const Joints& begin, const Joints& end, const Point& point) const;
  [[nodiscard]] bool is_known(const Point& point) const;
  void find_zero(Point low, Point high);
  void find_dip(Point begin, Point end);

  const Robot& robot_;
  const Pose& flange_;
  std::vector<std::vector<Joints>> loops_;
  std::vector<Joints> zeros_;
};

}  // namespace lfd
