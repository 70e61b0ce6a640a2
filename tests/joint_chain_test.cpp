#include "lfdtools/joint_chain.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur10.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

/// The transforms of a nominal arm, as ur_calibration writes them, its angles with so many digits.
JointChain nominal_chain(double quarter) {
  const Robot robot = nominal_ur10e();
  JointChain chain;
  chain.origins[0].position.z() = robot.dh[0].d;
  chain.origins[1].rotation = rotation_from_rpy(Vector3(quarter, 0.0, 0.0));
  chain.origins[2].position.x() = robot.dh[1].a;
  chain.origins[3].position << robot.dh[2].a, 0.0, robot.dh[3].d;
  chain.origins[4].position << 0.0, -robot.dh[4].d, -2.458e-11;
  chain.origins[4].rotation = rotation_from_rpy(Vector3(quarter, 0.0, 0.0));
  chain.origins[5].position << 0.0, robot.dh[5].d, -2.39e-11;
  chain.origins[5].rotation = rotation_from_rpy(Vector3(quarter, pi, pi));
  return chain;
}

double largest_difference(const JointChain& chain, const DhForm& form, Random& random) {
  Robot robot;
  robot.dh = form.rows;
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    Joints q;
    for (double& angle : q) angle = random.uniform(-2 * pi, 2 * pi);
    const Pose pose = form.base * forward_kinematics(robot, q);
    largest = std::max(largest, distance(pose, forward_kinematics(chain, q)).largest());
  }
  return largest;
}

}  // namespace

TEST_CASE("a nominal arm written with ten digits has the exact rows") {
  const Robot robot = nominal_ur10e();
  const JointChain chain = nominal_chain(1.570796327);
  const DhForm form = dh_form(chain);
  for (std::size_t i = 0; i < 6; ++i) {
    INFO("row " << i + 1);
    CHECK(form.rows[i].a == Approx(robot.dh[i].a).margin(1e-10));
    CHECK(form.rows[i].alpha == robot.dh[i].alpha);
    CHECK(form.rows[i].d == Approx(robot.dh[i].d).margin(1e-10));
    CHECK(form.rows[i].theta == 0.0);
  }
  Robot read = robot;
  read.dh = form.rows;
  CHECK(ur_geometry(read).exact);
  CHECK(form.base.position.norm() == 0.0);
  Random random(1);
  CHECK(largest_difference(chain, form, random) < 1e-9);
}

TEST_CASE("calibrated transforms agree with their rows to 1e-9, and the arm is solved") {
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double size = std::pow(10.0, random.uniform(-5.0, -2.0));
    const auto noise = [&] {
      return Vector3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    };
    JointChain chain = nominal_chain(pi / 2.0);
    for (std::size_t j = 1; j < 6; ++j) {
      chain.origins[j].position += noise();
      chain.origins[j].rotation = chain.origins[j].rotation * rotation_from_vector(noise());
    }
    if (i % 3 == 0) {  // the base stands elsewhere, and aslant
      chain.origins[0] = Pose{rotation_from_rpy(Vector3(0.3, -0.4, 1.0)), Vector3(0.5, 0.2, 0.8)} * chain.origins[0];
    }
    const DhForm form = dh_form(chain);
    worst = std::max(worst, largest_difference(chain, form, random));
    if (i % 10 != 0) continue;
    Robot robot = nominal_ur10e();
    robot.dh = form.rows;
    const InverseKinematics arm(robot);
    Joints q;
    q << 0.4, -1.1, 1.3, -0.5, 1.2, 0.7;
    const Pose pose = forward_kinematics(robot, q);
    double nearest = 10.0;
    for (const IkSolution& solution : arm(pose)) {
      CHECK(distance(forward_kinematics(chain, solution.joints), form.base * pose).largest() < 2e-9);
      nearest = std::min(nearest, (solution.joints - q).unaryExpr(&wrap_angle).cwiseAbs().maxCoeff());
    }
    CHECK(nearest < 1e-6);
  }
  INFO("worst " << worst);
  CHECK(worst < 1e-9);
}

TEST_CASE("a flange that no row reaches is refused, one turned about the last axis is not") {
  JointChain chain = nominal_chain(pi / 2.0);
  chain.flange = {rotation_about_z(0.4), Vector3(0.0, 0.0, 0.05)};
  Random random(3);
  CHECK(largest_difference(chain, dh_form(chain), random) < 1e-12);
  chain.flange.rotation = rotation_from_rpy(Vector3(0.0, 0.3, 0.0));
  CHECK_THROWS_AS(dh_form(chain), ConfigError);
}
