#include "lfdtools/dtw.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "lfdtools/random.hpp"
#include "refusal.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

Samples random_walk(Random& random, Index rows, Index cols) {
  Samples y(rows, cols);
  for (Index i = 0; i < rows; ++i) {
    for (Index d = 0; d < cols; ++d) y(i, d) = (i > 0 ? y(i - 1, d) : 0.0) + random.normal();
  }
  return y;
}

/// The textbook recursion on the whole matrix, cells with |i - j| > radius closed.
double textbook_cost(const Samples& a, const Samples& b, Index radius) {
  Matrix total = Matrix::Constant(a.rows() + 1, b.rows() + 1, std::numeric_limits<double>::infinity());
  total(0, 0) = 0;
  for (Index i = 1; i <= a.rows(); ++i) {
    for (Index j = 1; j <= b.rows(); ++j) {
      if (std::abs(i - j) > radius) continue;
      total(i, j) =
          (a.row(i - 1) - b.row(j - 1)).norm() + std::min({total(i - 1, j - 1), total(i - 1, j), total(i, j - 1)});
    }
  }
  return total(a.rows(), b.rows());
}

/// The least cost over every path there is, listed one by one.
double cheapest_of_all_paths(const Samples& a, const Samples& b) {
  double least = std::numeric_limits<double>::infinity();
  const std::function<void(Index, Index, double)> walk = [&](Index i, Index j, double before) {
    if (i >= a.rows() || j >= b.rows()) return;
    const double cost = before + (a.row(i) - b.row(j)).norm();
    if (i + 1 == a.rows() && j + 1 == b.rows()) least = std::min(least, cost);
    walk(i + 1, j, cost);
    walk(i, j + 1, cost);
    walk(i + 1, j + 1, cost);
  };
  walk(0, 0, 0.0);
  return least;
}

void check_path(const DtwPath& path, const Samples& a, const Samples& b) {
  REQUIRE(path.steps.front() == std::pair<Index, Index>(0, 0));
  REQUIRE(path.steps.back() == std::pair<Index, Index>(a.rows() - 1, b.rows() - 1));
  double cost = 0;
  for (std::size_t k = 0; k < path.steps.size(); ++k) {
    const auto [i, j] = path.steps[k];
    cost += (a.row(i) - b.row(j)).norm();
    if (k == 0) continue;
    const Index di = i - path.steps[k - 1].first;
    const Index dj = j - path.steps[k - 1].second;
    REQUIRE((di == 0 || di == 1));
    REQUIRE((dj == 0 || dj == 1));
    REQUIRE(di + dj > 0);
  }
  REQUIRE(cost == Approx(path.cost).epsilon(1e-12).margin(1e-12));
}

Samples column(std::initializer_list<double> values) {
  Samples y(static_cast<Index>(values.size()), 1);
  std::copy(values.begin(), values.end(), y.data());
  return y;
}

}  // namespace

TEST_CASE("the cost is the least over all paths, listed one by one") {
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const Samples a = random_walk(random, 1 + trial % 6, 2);
    const Samples b = random_walk(random, 1 + (trial / 6) % 6, 2);
    const double least = cheapest_of_all_paths(a, b);
    REQUIRE(dtw_cost(a, b) == Approx(least).epsilon(1e-12));
    const DtwPath path = dtw(a, b);
    REQUIRE(path.cost == dtw_cost(a, b));
    check_path(path, a, b);
  }
}

TEST_CASE("cost and path agree with the full matrix, with and without a band, in any dimension") {
  Random random(2);
  for (int trial = 0; trial < 40; ++trial) {
    const Index n = 1 + static_cast<Index>(random.below(90));
    const Index m = 1 + static_cast<Index>(random.below(90));
    const Index dimensions = 1 + static_cast<Index>(random.below(7));
    const Samples a = random_walk(random, n, dimensions);
    const Samples b = random_walk(random, m, dimensions);
    const Index longer = std::max(n, m);
    CHECK(dtw_cost(a, b) == Approx(textbook_cost(a, b, longer)).epsilon(1e-12));
    check_path(dtw(a, b), a, b);
    for (const double window : {0.01, 0.1, 0.35, 0.99}) {
      const auto wanted = static_cast<Index>(std::ceil(window * static_cast<double>(longer)));
      const Index radius = std::max(wanted, std::abs(n - m));
      const DtwPath path = dtw(a, b, {window});
      CHECK(path.cost == Approx(textbook_cost(a, b, radius)).epsilon(1e-12));
      CHECK(dtw_cost(a, b, {window}) == path.cost);
      check_path(path, a, b);
      for (const auto& [i, j] : path.steps) REQUIRE(std::abs(i - j) <= radius);
    }
    CHECK(dtw(a, b, {1.0}).steps == dtw(a, b).steps);
    CHECK(dtw_cost(a, b, {1.0}) == dtw_cost(a, b));
  }
}

TEST_CASE("the cost is symmetric to the bit, zero on itself, and falls as the band opens") {
  Random random(3);
  const Samples a = random_walk(random, 120, 3);
  const Samples b = random_walk(random, 77, 3);
  CHECK(dtw_cost(a, b) == dtw_cost(b, a));
  CHECK(dtw_cost(a, b, {0.2}) == dtw_cost(b, a, {0.2}));
  CHECK(dtw_cost(a, a) == 0);
  double before = std::numeric_limits<double>::infinity();
  for (const double window : {0.01, 0.4, 0.5, 0.6, 0.8, 1.0}) {
    const double cost = dtw_cost(a, b, {window});
    CHECK(cost <= before);
    before = cost;
  }
}

TEST_CASE("of equally cheap steps the diagonal is taken") {
  const Samples still = column({2, 2, 2, 2});
  const DtwPath path = dtw(still, still);
  REQUIRE(path.steps.size() == 4);
  for (Index k = 0; k < 4; ++k) CHECK(path.steps[static_cast<std::size_t>(k)] == std::pair<Index, Index>(k, k));
}

TEST_CASE("a pause costs nothing and its samples are matched with one") {
  const DtwPath path = dtw(column({0, 1, 2, 3}), column({0, 1, 1, 1, 2, 3}));
  CHECK(path.cost == 0);
  const std::vector<std::pair<Index, Index>> expected = {{0, 0}, {1, 1}, {1, 2}, {1, 3}, {2, 4}, {3, 5}};
  CHECK(path.steps == expected);
}

TEST_CASE("what cannot be compared is refused by name") {
  const Samples good = column({0, 1});
  const Samples nan = column({0, std::numeric_limits<double>::quiet_NaN()});
  CHECK(refusal_of([&] { (void)dtw_cost(Samples(0, 1), good); }).id == "dtw.empty");
  CHECK(refusal_of([&] { (void)dtw(good, Samples::Zero(3, 2)); }).id == "dtw.dimensions");
  CHECK(refusal_of([&] { (void)dtw_cost(good, nan); }).id == "dtw.not_finite");
  CHECK(refusal_of([&] { (void)dtw(good, column({0, 1e200})); }).id == "dtw.overflow");
  CHECK(refusal_of([&] { (void)dtw_cost(good, good, {0.0}); }).id == "dtw.window");
  CHECK(refusal_of([&] { (void)dtw_cost(good, good, {1.01}); }).id == "dtw.window");
  CHECK(refusal_of([&] { (void)dtw_cost(good, good, {std::nan("")}); }).id == "dtw.window");
}
