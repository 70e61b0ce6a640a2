// Second opinion on the arm: Orocos KDL.
#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>

#include "lfdtools/random.hpp"
#include "lfdtools/singularity.hpp"
#include "lfdtools/ur10.hpp"

using namespace lfd;

TEST_CASE("forward kinematics and Jacobian agree with Orocos KDL to 1e-12, and so do all inverse solutions") {
  const Robot robot = GENERATE(nominal_ur10(), nominal_ur10e());
  KDL::Chain chain;
  for (const DhRow& row : robot.dh) {
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(row.a, row.alpha, row.d, row.theta)));
  }
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::ChainJntToJacSolver jacobian_solver(chain);
  const auto kdl_pose = [&](const Joints& q) {
    KDL::JntArray angles(6);
    angles.data = q;
    KDL::Frame frame;
    REQUIRE(solver.JntToCart(angles, frame) >= 0);
    Pose pose;
    for (int i = 0; i < 3; ++i) {
      pose.position[i] = frame.p(i);
      for (int j = 0; j < 3; ++j) pose.rotation(i, j) = frame.M(i, j);
    }
    return pose;
  };

  const InverseKinematics arm(robot);
  Random random(1);
  double forward = 0.0, inverse_residual = 0.0, derivative = 0.0, volume = 0.0, condition = 0.0;
  for (int i = 0; i < 10000; ++i) {
    Joints q;
    for (double& angle : q) angle = random.uniform(-2 * std::numbers::pi, 2 * std::numbers::pi);
    const Pose pose = kdl_pose(q);
    forward = std::max(forward, distance(pose, forward_kinematics(robot, q)).largest());
    for (const IkSolution& s : arm(pose)) {
      inverse_residual = std::max(inverse_residual, distance(kdl_pose(s.joints), pose).largest());
    }
    KDL::JntArray angles(6);
    angles.data = q;
    KDL::Jacobian kdl_jacobian(6);
    REQUIRE(jacobian_solver.JntToJac(angles, kdl_jacobian) >= 0);
    derivative = std::max(derivative, (kdl_jacobian.data - jacobian(robot, q)).cwiseAbs().maxCoeff());
    // Manipulability and condition number of KDL's Jacobian, by its singular values.
    const Vector sigma = Eigen::JacobiSVD<Matrix>(kdl_jacobian.data).singularValues();
    volume = std::max(volume, std::abs(sigma.prod() - manipulability(jacobian(robot, q))));
    condition =
        std::max(condition, std::abs(condition_number(jacobian(robot, q)) * sigma[5] / sigma[0] - 1.0) * sigma[5]);
  }
  CHECK(volume < 1e-13);
  CHECK(condition < 1e-13);
  CHECK(forward < 1e-12);
  CHECK(inverse_residual < 1e-12);
  CHECK(derivative < 1e-12);
}
