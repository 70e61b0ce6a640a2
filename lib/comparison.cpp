#include "lfdtools/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "lfdtools/methods.hpp"
#include "lfdtools/random.hpp"

namespace lfd {
namespace {

constexpr int resamples = 2000;

/// Quantile of sorted values, linear between them.
double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

ErrorRatio ratio_of(const MethodErrors& method, const MethodErrors& opponent) {
  std::vector<double> ratios;
  Random random(1);
  const std::size_t n = method.rmse.size();
  for (int r = 0; r < resamples; ++r) {
    double a = 0;
    double b = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t drawn = random.below(n);
      a += method.rmse[drawn];
      b += opponent.rmse[drawn];
    }
    if (b > 0) ratios.push_back(a / b);
  }
  std::sort(ratios.begin(), ratios.end());
  return {method.method, opponent.method, method.mean / opponent.mean, quantile(ratios, 0.025),
          quantile(ratios, 0.975)};
}

}  // namespace

std::vector<MethodErrors> errors_by_method(const Validation& validation) {
  std::vector<MethodErrors> errors;
  for (const auto& score : validation.scores) {
    auto found = std::find_if(errors.begin(), errors.end(), [&](const auto& e) { return e.method == score.method; });
    if (found == errors.end()) found = errors.insert(errors.end(), MethodErrors{score.method, {}, 0});
    found->rmse.push_back(score.rmse);
  }
  for (auto& method : errors) {
    for (const double rmse : method.rmse) method.mean += rmse / static_cast<double>(method.rmse.size());
  }
  return errors;
}

std::optional<double> mean_noise_floor(const Validation& validation) {
  double sum = 0;
  int count = 0;
  for (const auto& floor : validation.noise_floor) {
    sum += floor.value_or(0);
    count += floor ? 1 : 0;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::optional<ErrorRatio> against_best_simple(const Validation& validation) {
  const auto errors = errors_by_method(validation);
  const MethodErrors* skill = nullptr;
  const MethodErrors* best = nullptr;
  for (const auto& method : errors) {
    if (method.method == "skill") skill = &method;
    const bool simple = std::any_of(methods().begin(), methods().end(),
                                    [&](const Method& known) { return known.simple && known.name == method.method; });
    if (simple && (best == nullptr || method.mean < best->mean)) best = &method;
  }
  if (skill == nullptr || best == nullptr || !(best->mean > 0)) return {};
  return ratio_of(*skill, *best);
}

std::vector<Reliability> reliability(const Validation& validation) {
  std::vector<Reliability> rows;
  const auto& levels = nominal_levels();
  for (const auto& time : validation.times) {
    std::vector<const ValidationScore*> scores;
    for (const auto& score : validation.scores) {
      if (score.method == time.method && !score.bands.empty()) scores.push_back(&score);
    }
    if (scores.empty()) continue;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      Reliability row{time.method, levels[k], 0, 0, 0};
      for (const auto* score : scores) {
        row.pointwise += score->bands[k].pointwise;
        row.path += score->bands[k].path;
        row.width += score->bands[k].width;
      }
      for (double* sum : {&row.pointwise, &row.path, &row.width}) *sum /= static_cast<double>(scores.size());
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace lfd
