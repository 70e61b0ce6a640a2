#include "lfdtools/posture.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

/// A demonstration that stays about some joints.
Samples around(const Joints& q, Random& random) {
  Samples joints(20, 6);
  for (double& value : joints.reshaped()) value = random.uniform(-0.05, 0.05);
  return joints.rowwise() + q.transpose();
}

}  // namespace

TEST_CASE("the posture of demonstrations is that of most of them") {
  const InverseKinematics arm(nominal_ur10());
  Random random(1);
  Joints one, other;
  one << 0.3, -1.2, 1.5, -0.4, -1.5, 0.1;
  other << 0.3, -1.2, 1.5, -0.4, 1.5, 0.1;
  REQUIRE(arm.branch(one) != arm.branch(other));
  const DemonstratedPosture posture =
      demonstrated_posture(arm, {around(other, random), around(one, random), around(one, random)});
  CHECK(posture.branch == arm.branch(one));
  CHECK(posture.elsewhere == 1);
  CHECK(posture.branches == std::vector<int>{arm.branch(other), arm.branch(one), arm.branch(one)});
  CHECK(posture.samples_elsewhere == std::vector<Eigen::Index>{0, 0, 0});
  CHECK(posture.samples_singular == std::vector<Eigen::Index>{0, 0, 0});
}

TEST_CASE("samples near a singularity have no vote beside others") {
  const InverseKinematics arm(nominal_ur10());
  Random random(2);
  Joints q;
  q << 0.3, -1.2, 1.5, -0.4, -1.5, 0.1;
  Samples joints = around(q, random);
  joints.col(4).head(14).setConstant(0.01);  // most samples, of the other sign
  const DemonstratedPosture posture = demonstrated_posture(arm, {joints});
  CHECK(posture.branch == arm.branch(q));
  CHECK(posture.samples_singular[0] == 14);
  CHECK(posture.samples_elsewhere[0] == 0);
  joints.col(4).head(14).setConstant(1.2);
  const DemonstratedPosture changing = demonstrated_posture(arm, {joints});
  CHECK(changing.samples_elsewhere[0] == 6);
  joints.col(4).setConstant(0.01);  // nothing but these: they are counted
  CHECK(demonstrated_posture(arm, {joints}).branch == (arm.branch(q) & ~2));
}

TEST_CASE("a border between branches belongs to both") {
  const InverseKinematics arm(nominal_ur10());
  Joints q;
  q << 0.3, -1.2, 1.5, -0.4, -1.5, 0.1;
  const int own = arm.branch(q);
  CHECK(keeps_branch(arm, q, own));
  for (const int bit : {1, 2, 4}) CHECK(!keeps_branch(arm, q, own ^ bit));
  q[4] = 0.0;
  CHECK(keeps_branch(arm, q, own));
  CHECK(keeps_branch(arm, q, own ^ 2));
  CHECK(!keeps_branch(arm, q, own ^ 3));
  q[2] = 0.0;
  CHECK(keeps_branch(arm, q, own ^ 3));
}

TEST_CASE("demonstrations without samples or joints are refused") {
  const InverseKinematics arm(nominal_ur10());
  CHECK_THROWS_AS(demonstrated_posture(arm, {}), DataError);
  CHECK_THROWS_AS(demonstrated_posture(arm, {Samples::Zero(0, 6)}), DataError);
  CHECK_THROWS_AS(demonstrated_posture(arm, {Samples::Zero(4, 3)}), DataError);
}
