#include "lfdtools/hand_spread.hpp"

#include <catch2/catch.hpp>

#include "arm_fixture.hpp"
#include "refusal.hpp"

using namespace lfd;

TEST_CASE("a spread is the covariance of the file, by sample and turned into the base") {
  const Eigen::Index T = 5;
  const std::vector<Matrix> parts = {smooth(T, 0.01, 2), smooth(T, 0.02, 3), smooth(T, 0.005, 1)};
  Matrix joint = Matrix::Zero(3 * T, 3 * T);
  for (Eigen::Index a = 0; a < 3; ++a) joint.block(a * T, a * T, T, T) = parts[static_cast<std::size_t>(a)];
  joint.block(0, T, T, T) = joint.block(T, 0, T, T) = 0.3 * smooth(T, 0.01, 2);
  const Matrix3 R = rotation_from_rpy({0.3, -0.5, 1.0});
  for (const auto& covariance : {parts, std::vector<Matrix>{joint}}) {
    const HandSpread spread = hand_spread(covariance, R);
    REQUIRE(spread.samples() == T);
    const Matrix product = spread.factor * spread.factor.transpose();
    for (Eigen::Index t = 0; t < T; ++t) {
      for (Eigen::Index u = 0; u < T; ++u) {
        Matrix3 block = Matrix3::Zero();
        for (Eigen::Index a = 0; a < 3; ++a) {
          for (Eigen::Index b = 0; b < 3; ++b) {
            if (covariance.size() == 1) block(a, b) = joint(a * T + t, b * T + u);
            if (covariance.size() == 3 && a == b) block(a, a) = parts[static_cast<std::size_t>(a)](t, u);
          }
        }
        CHECK((product.block(3 * t, 3 * u, 3, 3) - R * block * R.transpose()).cwiseAbs().maxCoeff() < 1e-12);
      }
    }
  }
}

TEST_CASE("a shift grows along the way, two errors that are independent add their covariances") {
  const Eigen::Index T = 5;
  const Matrix3 R = rotation_from_rpy({0.3, -0.5, 1.0});
  const Vector share = Vector::LinSpaced(T, 0, 1);
  const HandSpread shifted = hand_shift({0.01, 0.02, 0.03}, share);
  const Matrix product = shifted.factor * shifted.factor.transpose();
  CHECK(product(3 * 4 + 1, 3 * 2 + 1) == Approx(0.02 * 0.02 * 0.5));
  CHECK(product(3 * 4 + 1, 3 * 2 + 2) == 0);
  const HandSpread spread = hand_spread(std::vector<Matrix>(3, smooth(T, 0.01, 2)), R),
                   turned = hand_shift({0.01, 0.02, 0.03}, share, R);
  const Matrix sum = together(spread, turned).factor * together(spread, turned).factor.transpose();
  CHECK((sum - spread.factor * spread.factor.transpose() - turned.factor * turned.factor.transpose()).norm() < 1e-15);
  const Matrix3 D = Vector3(0.01, 0.02, 0.03).asDiagonal();
  CHECK((turned.factor.bottomRows(3) * turned.factor.bottomRows(3).transpose() - R * D * D * R.transpose()).norm() <
        1e-15);
  CHECK(refusal_of([&] { (void)together(spread, hand_shift({1, 1, 1}, share.head(2))); }).id == "hand_spread.shape");
}

TEST_CASE("covariances that are none are refused") {
  Matrix bad = Matrix::Identity(6, 6);
  bad(0, 1) = bad(1, 0) = 2;
  const Matrix3 I = Matrix3::Identity();
  CHECK(refusal_of([&] { (void)hand_spread({bad}, I); }).id == "hand_spread.not_positive");
  CHECK(refusal_of([&] { (void)hand_spread({Matrix::Identity(4, 4)}, I); }).id == "hand_spread.shape");
  CHECK(refusal_of([&] { (void)hand_spread({bad, bad}, I); }).id == "hand_spread.shape");
  CHECK(refusal_of([&] { (void)hand_spread({Matrix::Constant(3, 3, NAN)}, I); }).id == "hand_spread.shape");
}

TEST_CASE("the share of the way counts length, not samples") {
  Samples path(4, 3);
  path << 0, 0, 0, 0, 0, 3, 0, 4, 3, 0, 4, 4;
  CHECK(share_of_way(path).isApprox((Vector(4) << 0, 3.0 / 8, 7.0 / 8, 1).finished()));
  CHECK(share_of_way(Samples::Zero(3, 3)) == Vector::Ones(3));
}
