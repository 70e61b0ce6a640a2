#include "lfdtools/criteria.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <tuple>

#include "lfdtools/gmm.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;
using Eigen::Index;

namespace {

/// Which entry of which matrix stands for entry (a, b) of covariance k, as the type ties them; -1: always 0.
std::tuple<Index, Index, Index> free_entry(CovarianceType type, Index k, Index a, Index b) {
  switch (type) {
    case CovarianceType::full:
      return {k, std::min(a, b), std::max(a, b)};
    case CovarianceType::tied:
      return {0, std::min(a, b), std::max(a, b)};
    case CovarianceType::diagonal:
      return a == b ? std::tuple(k, a, a) : std::tuple(Index{-1}, Index{0}, Index{0});
    case CovarianceType::spherical:
      return a == b ? std::tuple(k, Index{0}, Index{0}) : std::tuple(Index{-1}, Index{0}, Index{0});
  }
  return {};
}

/// Three clouds, the first two overlapping.
Samples clouds() {
  Random random(31);
  Samples x(300, 2);
  for (Index i = 0; i < 300; ++i) {
    const double centre = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1.5 : 8.0;
    x.row(i) << centre + random.normal(), random.normal();
  }
  return x;
}

}  // namespace

TEST_CASE("q is the number of entries that can be chosen") {
  const auto type =
      GENERATE(CovarianceType::full, CovarianceType::tied, CovarianceType::diagonal, CovarianceType::spherical);
  for (Index K = 1; K <= 5; ++K) {
    for (Index D = 1; D <= 7; ++D) {
      std::set<std::tuple<Index, Index, Index>> entries;
      for (Index k = 0; k < K; ++k) {
        for (Index a = 0; a < D; ++a) {
          for (Index b = 0; b < D; ++b) entries.insert(free_entry(type, k, a, b));
        }
      }
      entries.erase({-1, 0, 0});
      const Index location = (K - 1) + K * D;  // the last prior follows from the others
      CHECK(free_parameters(K, D, type) == location + static_cast<Index>(entries.size()));
    }
  }
}

TEST_CASE("the criteria are their definitions") {
  const double L = -123.4;
  const double E = 5.6;
  CHECK(bic(L, 17, 50.0) == Approx(2 * 123.4 + 17 * std::log(50.0)).epsilon(1e-15));
  CHECK(aic(L, 17) == Approx(2 * 123.4 + 34).epsilon(1e-15));
  CHECK(icl(L, 17, 50.0, E) == Approx(2 * 123.4 + 17 * std::log(50.0) + 11.2).epsilon(1e-15));

  const Criteria plain = criteria(L, E, 17, 400);
  CHECK(plain.bic == bic(L, 17, 400.0));
  CHECK(plain.aic == aic(L, 17));
  CHECK(plain.icl == icl(L, 17, 400.0, E));
  CHECK(plain.of(Criterion::bic) == plain.bic);
  CHECK(plain.of(Criterion::aic) == plain.aic);
  CHECK(plain.of(Criterion::icl) == plain.icl);

  CriterionOptions options{.bic_n = 50};
  const Criteria penalty = criteria(L, E, 17, 400, options);
  CHECK(penalty.bic == bic(L, 17, 50.0));
  CHECK(penalty.aic == plain.aic);
  CHECK(penalty.icl == icl(L, 17, 50.0, E));

  options.likelihood = Likelihood::effective;  // an eighth of an observation each
  const Criteria effective = criteria(L, E, 17, 400, options);
  CHECK(effective.bic == Approx(bic(L / 8, 17, 50.0)).epsilon(1e-15));
  CHECK(effective.aic == Approx(aic(L / 8, 17)).epsilon(1e-15));
  CHECK(effective.icl == Approx(icl(L / 8, 17, 50.0, E / 8)).epsilon(1e-15));
  options.bic_n = 400;  // of all samples: the plain ones
  CHECK(criteria(L, E, 17, 400, options).icl == plain.icl);
}

TEST_CASE("samples that are all there m times do not change the effective criteria") {
  const Samples once = clouds();
  const Samples often = once.replicate(4, 1);
  const CriterionOptions effective{.bic_n = 200, .likelihood = Likelihood::effective};
  EmOptions options;
  options.components = 3;
  const Gmm gmm = fit_gmm(once, options).gmm;
  const Index q = free_parameters(3, 2);
  const auto of = [&](const Samples& x, const CriterionOptions& how) {
    return criteria(log_likelihood(gmm, x), responsibility_entropy(gmm, x), q, x.rows(), how);
  };
  CHECK(of(often, effective).bic == Approx(of(once, effective).bic).epsilon(1e-12));
  CHECK(of(often, effective).aic == Approx(of(once, effective).aic).epsilon(1e-12));
  CHECK(of(often, effective).icl == Approx(of(once, effective).icl).epsilon(1e-12));
  CHECK(of(often, {}).bic > 3 * of(once, {}).bic);
}

TEST_CASE("each criterion chooses its own least, and overlap costs in the ICL alone") {
  EmOptions options;
  const Samples x = clouds();
  for (const Criterion criterion : {Criterion::bic, Criterion::aic, Criterion::icl}) {
    const ComponentSelection chosen = select_components(x, 1, 6, {.criterion = criterion}, options);
    const auto of = [&](const Selection& row) { return Criteria{row.bic, row.aic, row.icl}.of(criterion); };
    for (const Selection& row : chosen.table) {
      CHECK(row.parameters == free_parameters(row.k, 2));
      CHECK(row.bic == Approx(bic(row.log_likelihood, row.parameters, 300.0)).epsilon(1e-14));
      CHECK(row.icl == Approx(row.bic + 2 * row.entropy).epsilon(1e-14));
      CHECK(of(row) >= of(chosen.table[static_cast<std::size_t>(chosen.fit.gmm.components() - 1)]));
      CHECK(row.entropy >= 0.0);
      CHECK(row.entropy <= 300.0 * std::log(static_cast<double>(row.k)) + 1e-9);
    }
    CHECK(chosen.fit.entropy == Approx(responsibility_entropy(chosen.fit.gmm, x)).epsilon(1e-12));
    if (criterion == Criterion::icl) CHECK(chosen.fit.gmm.components() == 2);
  }
}
