#include "lfdtools/basis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/trajectory.hpp"
#include "refusal.hpp"

using namespace lfd;

TEST_CASE("centres are equally spaced in time, widths are 0.8 of the distance to the next centre") {
  const CanonicalSystem canonical;
  const Basis basis = make_basis(15, canonical);
  REQUIRE(basis.size() == 15);
  CHECK(basis.centers[0] == 1);
  CHECK(basis.centers[14] == Approx(0.01).epsilon(1e-14));
  for (int i = 0; i < 15; ++i) CHECK(canonical.relative_time(basis.centers[i]) == Approx(i / 14.0).margin(1e-14));
  for (int i = 0; i < 14; ++i) CHECK(basis.widths[i] == Approx(0.8 * (basis.centers[i] - basis.centers[i + 1])));
  CHECK(basis.widths[14] == basis.widths[13]);
}

TEST_CASE("activations are the Gaussians of equation 13, in long double") {
  const Basis basis = make_basis(7);
  for (const double x : linspace(0, 1.2, 50)) {
    const Vector psi = activations(basis, x);
    for (int i = 0; i < 7; ++i) {
      const long double d = static_cast<long double>(x) - basis.centers[i];
      const long double sigma = basis.widths[i];
      CHECK(psi[i] ==
            Approx(static_cast<double>(std::exp(-d * d / (2 * sigma * sigma)))).epsilon(1e-12).margin(1e-300));
    }
  }
}

TEST_CASE("normalised activations are the quotient where it exists, and sum to one where everything underflows") {
  const Basis basis = make_basis(10);
  for (const double x : linspace(0, 1, 101)) {
    const Vector psi = activations(basis, x);
    const Vector share = normalized_activations(basis, x);
    CHECK((share - psi / psi.sum()).cwiseAbs().maxCoeff() < 1e-15);
  }
  const double far = 1e6;
  CHECK(activations(basis, far).sum() == 0);
  const Vector share = normalized_activations(basis, far);
  CHECK(share.allFinite());
  CHECK(share.sum() == Approx(1));
}

TEST_CASE("forcing features are x times the normalised activations, a row a phase") {
  const Basis basis = make_basis(6);
  const Vector x = linspace(0.01, 1, 13);
  const Matrix Phi = forcing_features(basis, x);
  REQUIRE(Phi.rows() == 13);
  REQUIRE(Phi.cols() == 6);
  for (int k = 0; k < 13; ++k) {
    double sum = 0;
    for (int j = 0; j < 6; ++j) sum += std::exp(-0.5 * std::pow((x[k] - basis.centers[j]) / basis.widths[j], 2));
    for (int i = 0; i < 6; ++i) {
      const double psi = std::exp(-0.5 * std::pow((x[k] - basis.centers[i]) / basis.widths[i], 2));
      CHECK(Phi(k, i) == Approx(psi / sum * x[k]).margin(1e-15));
    }
  }
}

TEST_CASE("the time resolution shrinks with the number of functions and bounds the slope of every activation") {
  const CanonicalSystem canonical;
  for (const int N : {3, 5, 15, 60}) {
    const Basis basis = make_basis(N, canonical);
    const double resolution = time_resolution(basis, canonical);
    CHECK(resolution < 1.0 / (N - 1));
    // Over a step of a tenth of the resolution no share changes by more than about a tenth.
    const double h = resolution / 10;
    for (double s = 0; s < 1; s += h) {
      const Vector change =
          normalized_activations(basis, canonical.phase(s + h)) - normalized_activations(basis, canonical.phase(s));
      REQUIRE(change.cwiseAbs().maxCoeff() < 0.12);
    }
  }
}

TEST_CASE("a basis that cannot be used is refused") {
  CHECK(refused_as(Fault::data, [] { (void)make_basis(1); }) == "dmp.basis");
  CHECK(refused_as(Fault::data, [] { (void)make_basis(15, CanonicalSystem{0.0}); }) == "dmp.alpha_x");
  CHECK(refused_as(Fault::data, [] { check(Basis{Vector::Ones(2), Vector::Ones(3)}); }) == "dmp.basis");
  CHECK(refused_as(Fault::data, [] { check(Basis{}); }) == "dmp.basis");
  CHECK(refused_as(Fault::data, [] { check(Basis{Vector::Ones(2), Vector::Zero(2)}); }) == "dmp.basis");
  CHECK(refused_as(Fault::data, [] {
          check(Basis{Vector::Ones(2), Vector::Constant(2, std::nan(""))});
        }) == "dmp.basis");
  CHECK(refused_as(Fault::data, [] { check(make_basis(15)); }) == "");
  // Centres that fall on one another: a phase that is zero long before tau.
  CHECK(refused_as(Fault::data, [] { (void)make_basis(15, CanonicalSystem{1e5}); }) == "dmp.basis");
}
