// Loops of the self-motion of calibrated arms with a nearly singular wrist.
#include "../lib/wrist_loop.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "arm_fixture.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur_geometry.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

Robot tilted(double size, Random& random) {
  Robot robot = nominal_ur10();
  for (DhRow& row : robot.dh) {
    row.alpha += random.uniform(-size, size);
    row.a += random.uniform(-size, size);
  }
  return robot;
}

double apart(const Joints& a, const Joints& b) {
  return (a - b).unaryExpr([](double angle) { return wrap_angle(angle); }).norm();
}

}  // namespace

TEST_CASE("loops close after few points, keep all of the pose but a tilt, and find the joints that made it") {
  Random random(8);
  std::size_t longest = 0;
  int open = 0, own = 0;
  for (int i = 0; i < 600; ++i) {
    const Robot robot = tilted(1e-3, random);
    Joints q = random_joints(random);
    // Beside the wrist's singularity alone, or the stretched or folded elbow's too, where loops begin in a bend.
    if (i % 3 > 0) q[2] = i % 3 == 1 ? random.uniform(-0.1, 0.1) : pi + random.uniform(-0.1, 0.1);
    q[4] = (i % 2 == 0 ? 0.0 : pi) + random.uniform(-0.02, 0.02);
    const Pose pose = forward_kinematics(robot, q);
    WristLoops loops(robot, pose);
    loops.trace(q);
    if (loops.loops().empty()) continue;  // the shoulder is singular as well: there is no one direction to go
    REQUIRE(loops.loops().size() == 1);
    const auto& loop = loops.loops().front();
    longest = std::max(longest, loop.size());
    double back = 10.0;
    for (std::size_t k = 0; k + 3 < loop.size(); ++k) back = std::min(back, apart(loop[k], loop.back()));
    open += back < 1e-9 ? 0 : 1;
    for (std::size_t k = 0; k < loop.size(); k += 7) {
      const auto frames = joint_frames(robot, loop[k]);
      CHECK((frames[6].position - pose.position).norm() < 2e-9);
      const Vector3 turn = vector_from_rotation(pose.rotation * frames[6].rotation.transpose());
      CHECK(std::abs(turn.dot(frames[4].rotation.col(2))) < 2e-9);
      CHECK(std::abs(turn.dot(frames[5].rotation.col(2))) < 2e-9);
    }
    // The joints that made the pose are one of the zeros.
    double nearest = 10.0;
    for (const Joints& zero : loops.zeros()) nearest = std::min(nearest, apart(zero, q));
    own += nearest < 1e-3 ? 1 : 0;
    // From another point of the loop it is known.
    loops.trace(loop[loop.size() / 2]);
    CHECK(loops.loops().size() == 1);
  }
  INFO("longest " << longest << ", open " << open << ", own found " << own);
  CHECK(longest < 240);
  CHECK(open <= 8);  // two loops that nearly cross turn too sharply to follow
  CHECK(own >= 599);
}
