#include "path_proposal.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lfd {
namespace {

constexpr double plain = 0.1;  // share of the draws from the spread itself
constexpr double half = 0.7;   // of those from half spaces
constexpr double even = 0.3;   // of these, alike at all places
constexpr double width = 3.0;  // of the others
// An axis along which the hand is off by this much less than along another, or by less than 1e-12 m, is none.
constexpr double flat = 1e-6;

double normal_tail(double c) {
  return 0.5 * std::erfc(c / std::numbers::sqrt2);
}

/// Standard normal given that it is over c (Robert 1995).
double normal_over(double c, Random& random) {
  if (c < 0.5) {
    for (;;) {
      const double x = random.normal();
      if (x > c) return x;
    }
  }
  const double rate = 0.5 * (c + std::sqrt(c * c + 4));
  for (;;) {
    const double x = c - std::log(1 - random.uniform()) / rate;
    if (random.uniform() <= std::exp(-0.5 * (x - rate) * (x - rate))) return x;
  }
}

}  // namespace

PathProposal::PathProposal(Matrix factor, const std::vector<HalfSpace>& half_spaces) : factor_(std::move(factor)) {
  for (Eigen::Index p = 0; p < places(); ++p) whitening_.push_back(whitening(factor_.middleRows<3>(3 * p)));
  wide_ = half_spaces.empty() ? 1.0 : 1.0 - half;
  double sum = 0.0;
  std::vector<double> of_place(whitening_.size(), 0.0);
  for (const HalfSpace& space : half_spaces) {
    sum += normal_tail(space.threshold);
    of_place[space.place] += normal_tail(space.threshold);
  }
  const auto somewhere = std::count_if(of_place.begin(), of_place.end(), [](double p) { return p > 0; });
  double shares = wide_;
  for (const HalfSpace& space : half_spaces) {
    const auto F = factor_.middleRows<3>(3 * static_cast<Eigen::Index>(space.place));
    const double sd = (F.transpose() * space.slope).norm();
    const double here = of_place[space.place] * static_cast<double>(somewhere);
    const double density = half * ((1 - even) / sum + even / here);
    parts_.push_back({space.place, space.slope / sd, space.threshold, density});
    shares += density * normal_tail(space.threshold);
    up_to_.push_back(shares);
  }
}

PathProposal::Whitening PathProposal::whitening(const Eigen::Ref<const Matrix>& F) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(Matrix3(F * F.transpose()));
  const Vector3 sd = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const double least = std::max(1e-12, flat * sd[2]);
  Eigen::Index first = 0;
  while (first < 3 && sd[first] <= least) ++first;
  Whitening W(3 - first, 3);
  for (Eigen::Index i = first; i < 3; ++i) W.row(i - first) = axes.eigenvectors().col(i).transpose() / sd[i];
  return W;
}

Vector PathProposal::draw(double at, Random random) const {
  Vector z(factor_.cols());
  for (double& value : z) value = random.normal();
  if (at < plain) return z;
  const auto F = [&](std::size_t place) { return factor_.middleRows<3>(3 * static_cast<Eigen::Index>(place)); };
  if (at < wide_) {
    const double share = (at - plain) / (wide_ - plain) * static_cast<double>(places());
    const std::size_t place = std::min(static_cast<std::size_t>(share), whitening_.size() - 1);
    const auto& W = whitening_[place];
    z += (width - 1) * (F(place).transpose() * (W.transpose() * (W * (F(place) * z))));
    return z;
  }
  const auto found = std::lower_bound(up_to_.begin(), up_to_.end(), at) - up_to_.begin();
  const Part& part = parts_[std::min(static_cast<std::size_t>(found), parts_.size() - 1)];
  const Vector along = F(part.place).transpose() * part.slope;
  z -= (along.dot(z) + normal_over(part.threshold, random)) * along;
  return z;
}

double PathProposal::weight(const Eigen::Ref<const Vector>& dx) const {
  double density = plain;  // over that of the spread
  const double each = (wide_ - plain) / static_cast<double>(places());
  for (Eigen::Index p = 0; p < places(); ++p) {
    const auto& W = whitening_[static_cast<std::size_t>(p)];
    const double square = (W * at_place(dx, p)).squaredNorm();
    density +=
        each * std::pow(width, -static_cast<double>(W.rows())) * std::exp(0.5 * (1 - 1 / (width * width)) * square);
  }
  for (const Part& part : parts_) {
    const bool inside = part.slope.dot(at_place(dx, static_cast<Eigen::Index>(part.place))) <= -part.threshold;
    if (inside) density += part.density;
  }
  return 1 / density;
}

}  // namespace lfd
