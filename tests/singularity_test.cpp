#include "lfdtools/singularity.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "arm_fixture.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur10.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("manipulability is the product of the singular values, and of the three singular factors") {
  const Robot robot = GENERATE(nominal_ur10(), nominal_ur10e());
  const UrGeometry g = ur_geometry(robot);
  Random random(1);
  double by_values = 0.0, by_factors = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const Joints q = random_joints(random);
    const Jacobian J = jacobian(robot, q);
    const double w = manipulability(J);
    by_values = std::max(by_values, std::abs(w - Eigen::JacobiSVD<Jacobian>(J).singularValues().prod()));
    const double X = g.a2 * std::cos(q[1]) + g.a3 * std::cos(q[1] + q[2]) + g.d5 * std::sin(q[1] + q[2] + q[3]);
    by_factors = std::max(by_factors, std::abs(w - std::abs(g.a2 * g.a3 * std::sin(q[2]) * std::sin(q[4]) * X)));
    // The point at which the hand's speed is looked at does not matter.
    const double elsewhere = manipulability(jacobian(robot, q, Vector3(0.3, -0.2, 0.5)));
    CHECK(elsewhere == Approx(w).margin(1e-13));
  }
  CHECK(by_values < 1e-13);
  CHECK(by_factors < 1e-13);
}

TEST_CASE("distances to the singularities are lengths between frames, and keep their digits") {
  const Robot robot = nominal_ur10();
  const UrGeometry g = ur_geometry(robot);
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Joints q = random_joints(random);
    const auto frames = joint_frames(robot, q);
    const Vector3 centre = frames[6].position - g.d6 * frames[6].rotation.col(2);
    const double rho = (frames[3].position - frames[1].position).norm();
    const SingularityDistances d = singularity_distances(g, q);
    CHECK(d.shoulder == Approx(std::hypot(centre.x(), centre.y()) - std::abs(g.d4)).margin(1e-12));
    const double outer = std::abs(g.a2 + g.a3), inner = std::abs(g.a2 - g.a3);
    CHECK(d.elbow == Approx(std::min(outer - rho, rho - inner)).margin(1e-12));
    // Axes 4 and 6: parallel where the wrist is singular.
    CHECK(d.wrist == Approx(frames[3].rotation.col(2).cross(frames[5].rotation.col(2)).norm()).margin(1e-12));
  }
  // Near the stretched arm: rho = outer - a2 a3 q3^2 / (2 outer).
  Joints q = Joints::Constant(0.7);
  q[2] = 1e-7;
  const double outer = std::abs(g.a2 + g.a3);
  CHECK(singularity_distances(g, q).elbow == Approx(g.a2 * g.a3 * 1e-14 / (2.0 * outer)).epsilon(1e-9));
  q[2] = 0.0;
  CHECK(singularity_distances(g, q).elbow == 0.0);
  q[2] = pi;
  CHECK(singularity_distances(g, q).elbow < 1e-30);
}

TEST_CASE("a robot whose zeros lie elsewhere is as far from its singularities") {
  const Robot nominal = nominal_ur10();
  Robot turned = nominal;
  Joints offset;
  offset << 0.1, -0.2, 0.3, 0.4, -0.5, 0.6;
  for (std::size_t j = 0; j < 6; ++j) turned.dh[j].theta = offset[static_cast<Eigen::Index>(j)];
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Joints q = random_joints(random);
    const SingularityDistances a = singularity_distances(ur_geometry(nominal), q);
    const SingularityDistances b = singularity_distances(ur_geometry(turned), q - offset);
    CHECK(a.shoulder == Approx(b.shoulder).margin(1e-13));
    CHECK(a.elbow == Approx(b.elbow).margin(1e-13));
    CHECK(a.wrist == Approx(b.wrist).margin(1e-13));
  }
}

TEST_CASE("the nearest singularity has a name where it is near") {
  CHECK(nearest_singularity({0.5, 0.4, 0.9}).empty());
  CHECK(nearest_singularity({0.0012, 0.4, 0.9}) == "the shoulder singularity (1.2 mm)");
  CHECK(nearest_singularity({0.05, 0.01, 0.9}) == "the elbow singularity (10 mm)");
  CHECK(nearest_singularity({0.05, 0.01, 0.002}) == "the wrist singularity (|sin q5| = 0.002)");
}
