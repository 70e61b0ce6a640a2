#include "lfdtools/trajectory.hpp"

#include <fmt/format.h>

#include "lfdtools/error.hpp"

namespace lfd {

std::string describe(const Labels& labels) {
  std::string words;
  const auto add = [&](const char* name, const std::optional<std::string>& value) {
    if (value) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name, *value);
  };
  add("target", labels.target);
  add("teacher", labels.teacher);
  add("demo", labels.demo);
  add("sample", labels.sample);
  return words;
}

std::string prefix_of(const Labels& labels) {
  const std::string words = describe(labels);
  return words.empty() ? words : words + ": ";
}

void check(const Trajectory& trajectory) {
  const auto& t = trajectory.times;
  if (trajectory.positions.rows() != t.size()) {
    throw DataError("trajectory.shape",
                    fmt::format("{} times but {} positions", t.size(), trajectory.positions.rows()));
  }
  if (t.size() < 2) throw DataError("trajectory.too_short", "a trajectory needs at least two samples");
  if (!t.allFinite() || !trajectory.positions.allFinite()) {
    throw DataError("trajectory.not_finite", "a trajectory has a value that is not a finite number");
  }
  for (Eigen::Index i = 1; i < t.size(); ++i) {
    if (!(t[i] > t[i - 1])) {
      throw DataError("trajectory.time_not_rising", fmt::format("time {} s is not after {} s", t[i], t[i - 1]));
    }
  }
}

Vector linspace(double first, double last, Eigen::Index n) {
  Vector v(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    v[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(n - 1);
  }
  v[0] = first;
  v[n - 1] = last;
  return v;
}

}  // namespace lfd
