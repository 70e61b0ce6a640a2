#include "lfdtools/kmeans.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "lfdtools/error.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

Matrix random_samples(Index N, Index D, Random& random) {
  Matrix x(N, D);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = random.normal();
  return x;
}

double squared_distance(const Matrix& x, Index i, const Samples& centers, Index c) {
  return (x.row(i) - centers.row(c)).squaredNorm();
}

}  // namespace

TEST_CASE("at the end every sample is with its nearest center and every center is the mean of its samples") {
  Random random(1);
  const Matrix x = random_samples(1100, 3, random);
  const KMeans result = kmeans(x, 7, random, 1000);
  REQUIRE(result.iterations < 1000);
  double inertia = 0.0;
  Samples sums = Samples::Zero(7, 3);
  Vector counts = Vector::Zero(7);
  for (Index i = 0; i < x.rows(); ++i) {
    const int own = result.labels[static_cast<std::size_t>(i)];
    for (Index c = 0; c < 7; ++c) {
      CHECK(squared_distance(x, i, result.centers, own) <= squared_distance(x, i, result.centers, c) + 1e-12);
    }
    inertia += squared_distance(x, i, result.centers, own);
    sums.row(own) += x.row(i);
    counts[own] += 1.0;
  }
  CHECK(result.inertia == Approx(inertia).epsilon(1e-12));
  for (Index c = 0; c < 7; ++c) CHECK((sums.row(c) / counts[c] - result.centers.row(c)).norm() < 1e-12);
}

TEST_CASE("some of a few starts finds the best of all partitions") {
  Random random(2);
  const Matrix x = random_samples(10, 2, random);
  double best = std::numeric_limits<double>::infinity();
  for (unsigned partition = 1; partition < 512; ++partition) {  // bit i: sample i is in the second cluster
    Samples centers = Samples::Zero(2, 2);
    Vector counts = Vector::Zero(2);
    for (Index i = 0; i < 10; ++i) {
      const Index c = (partition >> i) & 1U;
      centers.row(c) += x.row(i);
      counts[c] += 1.0;
    }
    if (counts.minCoeff() < 1.0) continue;
    double inertia = 0.0;
    for (Index c = 0; c < 2; ++c) centers.row(c) /= counts[c];
    for (Index i = 0; i < 10; ++i) inertia += squared_distance(x, i, centers, (partition >> i) & 1U);
    best = std::min(best, inertia);
  }
  double found = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 20; ++start) {
    const double inertia = kmeans(x, 2, random, 100).inertia;
    CHECK(inertia >= best - 1e-12);
    found = std::min(found, inertia);
  }
  CHECK(found == Approx(best).epsilon(1e-12));
}

TEST_CASE("seeding spreads: clusters far apart are found from any seed") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Matrix x = random_samples(60, 2, random);
    for (Index i = 0; i < 60; ++i) x(i, 0) += 1e4 * static_cast<double>(i % 6);
    const KMeans result = kmeans(x, 6, random, 100);
    CHECK(result.inertia < 1000.0);
  }
}

TEST_CASE("as many clusters as samples, or as there are different samples, leaves nothing over") {
  Random random(3);
  const Matrix x = random_samples(8, 2, random);
  CHECK(kmeans(x, 8, random, 10).inertia == 0.0);
  Matrix twice(6, 1);
  twice << 1, 1, 1, 5, 5, 5;
  const KMeans result = kmeans(twice, 4, random, 10);
  CHECK(result.inertia == 0.0);
  CHECK(result.centers.allFinite());
  CHECK(std::set<int>(result.labels.begin(), result.labels.end()).size() == 2);
}

TEST_CASE("more clusters than samples and numbers that are none are refused") {
  Random random(4);
  CHECK_THROWS_AS(kmeans(Matrix::Ones(3, 1), 4, random, 10), DataError);
  CHECK_THROWS_AS(kmeans(Matrix::Ones(3, 1), 0, random, 10), DataError);
  Matrix x = Matrix::Ones(3, 1);
  x(1, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(kmeans(x, 2, random, 10), DataError);
}
