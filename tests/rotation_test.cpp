#include "lfdtools/rotation.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

Quaternion random_quaternion(Random& random) {
  Quaternion q;
  for (double& c : q) c = random.normal();
  return q.normalized();
}

double off(const Matrix3& a, const Matrix3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("quaternions agree with Eigen's own conversion and come back with a fixed sign") {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Quaternion q = random_quaternion(random);
    const Matrix3 R = rotation_from_quaternion(q);
    CHECK(off(R, Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix()) < 2e-15);
    const Quaternion back = quaternion_from_rotation(R);
    CHECK(back[0] >= 0.0);
    CHECK((back - same_sign(back, q)).norm() < 1e-14);
  }
  // Half turns: w = 0, the case in which a formula that divides by w fails.
  for (int axis = 0; axis < 3; ++axis) {
    Quaternion q = Quaternion::Zero();
    q[axis + 1] = -1.0;
    CHECK((quaternion_from_rotation(rotation_from_quaternion(q)) + q).norm() < 1e-15);
  }
}

TEST_CASE("fixed-axis angles are turns about x, then y, then z") {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 rpy(random.uniform(-pi, pi), random.uniform(-pi / 2, pi / 2), random.uniform(-pi, pi));
    const Matrix3 expected = (Eigen::AngleAxisd(rpy[2], Vector3::UnitZ()) *
                              Eigen::AngleAxisd(rpy[1], Vector3::UnitY()) * Eigen::AngleAxisd(rpy[0], Vector3::UnitX()))
                                 .toRotationMatrix();
    CHECK(off(rotation_from_rpy(rpy), expected) < 1e-15);
    CHECK((rpy_from_rotation(expected) - rpy).norm() < 1e-12 / std::cos(rpy[1]));
  }
  for (const double pitch : {pi / 2, -pi / 2}) {
    const Matrix3 R = rotation_from_rpy(Vector3(0.4, pitch, -1.1));
    const Vector3 rpy = rpy_from_rotation(R);
    CHECK(rpy[0] == 0.0);
    CHECK(off(rotation_from_rpy(rpy), R) < 1e-15);
  }
}

TEST_CASE("rotation vectors agree with axis and angle, from tiny to half turns") {
  Random random(3);
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-5, 2.1e-4, 0.3, 3.0, pi - 1e-9, pi}) {
    const Vector3 axis = random_quaternion(random).tail<3>().normalized();
    const Matrix3 R = rotation_from_vector(angle * axis);
    CHECK(off(R, Eigen::AngleAxisd(angle, axis).toRotationMatrix()) < 1e-15);
    CHECK(off(rotation_from_vector(vector_from_rotation(R)), R) < 2e-15);
    if (angle < pi - 1e-6) CHECK((vector_from_rotation(R) - angle * axis).norm() <= 1e-15 * (1.0 + angle) + 1e-15);
  }
  CHECK(off(rotation_about_z(0.7), rotation_from_vector(Vector3(0.0, 0.0, 0.7))) < 1e-15);
}

TEST_CASE("poses compose, invert, measure and interpolate") {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const auto random_pose = [&] {
      return Pose{rotation_from_quaternion(random_quaternion(random)),
                  Vector3(random.normal(), random.normal(), random.normal())};
    };
    const Pose a = random_pose(), b = random_pose();
    const Vector3 p(random.normal(), random.normal(), random.normal());
    const Vector3 by_parts = a.rotation * (b.rotation * p + b.position) + a.position;
    CHECK(((a * b).rotation * p + (a * b).position - by_parts).norm() < 1e-14);
    CHECK(distance(inverse(a) * a, Pose{}).largest() < 1e-14);
    CHECK(is_rigid(a));

    const Eigen::AngleAxisd between(Matrix3(a.rotation.transpose() * b.rotation));
    CHECK(distance(a, b).rotation == Approx(between.angle()).epsilon(1e-9));
    CHECK(distance(a, b).position == Approx((a.position - b.position).norm()));
    const Pose third = interpolate(a, b, 1.0 / 3.0);
    CHECK(distance(a, third).rotation == Approx(between.angle() / 3.0).margin(1e-12));
    CHECK(distance(third, b).rotation == Approx(between.angle() * 2.0 / 3.0).margin(1e-12));
    CHECK((3.0 * third.position - 2.0 * a.position - b.position).norm() < 1e-14);
    CHECK(distance(interpolate(a, b, 1.0), b).largest() < 1e-14);
  }
  CHECK(distance(Pose{}, Pose{rotation_about_z(1e-12), Vector3::Zero()}).rotation == Approx(1e-12).epsilon(1e-9));
}

TEST_CASE("what is no rotation is refused") {
  CHECK_THROWS_AS(rotation_from_quaternion(Quaternion(0.9, 0.0, 0.0, 0.0)), DataError);
  CHECK_THROWS_AS(rotation_from_quaternion(Quaternion::Zero()), DataError);
  CHECK_THROWS_AS(normalized(Quaternion(std::nan(""), 0.0, 0.0, 1.0)), DataError);
  CHECK(normalized(Quaternion(1.001, 0.0, 0.0, 0.0))[0] == 1.0);
  CHECK_THROWS_AS(rotation_from_rpy(Vector3(0.0, INFINITY, 0.0)), DataError);
  Pose mirrored;
  mirrored.rotation(2, 2) = -1.0;
  CHECK_FALSE(is_rigid(mirrored));
}
