#include "lfdtools/touching.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

namespace lfd {
namespace {

// A pair this many standard deviations away counts as never touching: 6e-16.
constexpr double never = 8.0;
// An error of the hand that moves a distance by less is none [m].
constexpr double no_spread = 1e-12;
// Joints move by at most 1 / this for a hand's metre: nearer to a singularity the least-squares motion is taken [m].
constexpr double singular = 1e-6;
// Joints follow a shift of the hand to this share of it, in at most so many steps.
constexpr double followed = 0.005;
constexpr int most_steps = 12;
// None of which moves a joint further [rad].
constexpr double longest_step = 0.5;
// Share of the draws that come from the spread itself: what no half space foresees counts at most 1 / this a draw.
constexpr double plain = 0.1;
// Share that every place gets alike, however rare touching is there: the rest goes where touching is likely.
constexpr double even = 0.3;
// Half spaces begin this much before the bodies touch [standard deviations], since these are curved.
constexpr double ahead = 0.1;

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

/// A sample of the path at which something may be touched.
struct Place {
  Eigen::Index sample = 0;
  Joints joints;
  Pose hand;
  Jacobian joints_per_hand;          // pseudoinverse
  std::vector<LinkClearance> pairs;  // that may touch
  double single = 0.0;               // weight of a draw in one half space of it
};

/// A half space of the hand's error dx at a place, where slope . dx <= -threshold sd.
struct HalfSpace {
  std::size_t place = 0;
  Vector3 slope;
  double sd = 0.0;
  double threshold = 0.0;
  double probability = 0.0;
  double draws = 0.0;  // share of all
};

class PathDraws {
 public:
  PathDraws(const ArmClearance& arm, const Samples& joints, const HandSpread& spread, const Pose& tool,
            const TouchingOptions& options)
      : arm_(arm), spread_(spread), tool_(tool), options_(options), certain_(static_cast<std::size_t>(joints.rows())) {
    for (Eigen::Index t = 0; t < joints.rows(); ++t) look_at(t, joints.row(t).transpose());
    share_out_draws();
    rows_.resize(3 * static_cast<Eigen::Index>(places_.size()), spread.factor.cols());
    for (std::size_t p = 0; p < places_.size(); ++p) {
      rows_.middleRows<3>(3 * static_cast<Eigen::Index>(p)) = spread.factor.middleRows<3>(3 * places_[p].sample);
    }
  }

  [[nodiscard]] Touching count() const {
    const auto T = certain_.size();
    std::vector<Tally> samples(T);
    Tally path;
    for (const Place& place : places_) {
      samples[static_cast<std::size_t>(place.sample)].single = place.single;
      path.single = std::max(path.single, place.single);
    }
    if (!places_.empty()) {
      const Random random(options_.seed);
      constexpr Eigen::Index block = 128;
      Matrix Z(rows_.cols(), block), shifts(rows_.rows(), block);
      for (Eigen::Index first = 0; first < options_.draws; first += block) {
        const Eigen::Index n = std::min(block, options_.draws - first);
        for (Eigen::Index i = 0; i < n; ++i)
          draw(first + i, random.split(static_cast<std::uint64_t>(first + i)), Z.col(i));
        shifts.leftCols(n).noalias() = rows_ * Z.leftCols(n);
        for (Eigen::Index i = 0; i < n; ++i) tally(shifts.col(i), samples, path);
      }
    }
    Touching result;
    bool any_certain = false;
    for (std::size_t t = 0; t < T; ++t) {
      result.samples.push_back(certain_[t] ? Chance{1.0, 0.0} : chance(samples[t]));
      any_certain = any_certain || certain_[t];
    }
    result.path = any_certain ? Chance{1.0, 0.0} : chance(path);
    return result;
  }

 private:
  /// Weights of the draws that touch.
  struct Tally {
    double sum = 0.0;
    double squares = 0.0;
    double single = 0.0;  // that of a draw in one half space: what might have been seen where none touches

    void add(double weight) {
      sum += weight;
      squares += weight * weight;
    }
  };

  void look_at(Eigen::Index t, const Joints& q) {
    Place place{t, q, forward_kinematics(arm_.robot(), q) * tool_, inverse_of(q), {}, 0.0};
    auto pairs = arm_.pairs(q);
    if (options_.self) {
      const auto own = arm_.pairs_of_arm_itself(q);
      pairs.insert(pairs.end(), own.begin(), own.end());
    }
    const Matrix3 covariance = spread_.factor.middleRows<3>(3 * t) * spread_.factor.middleRows<3>(3 * t).transpose();
    for (const LinkClearance& pair : pairs) {
      const double room = pair.distance - options_.margin;
      const Vector3 slope = place.joints_per_hand.leftCols<3>().transpose() * arm_.slope(pair, q);
      const double sd = std::sqrt(slope.dot(covariance * slope));
      if (sd < no_spread) {
        if (room <= 0) certain_[static_cast<std::size_t>(t)] = true;
      } else if (room < never * sd) {
        place.pairs.push_back(pair);
        // Where it should just touch it may do so already: bodies turn, and what they turn towards is no plane.
        const double c = room / sd;
        const auto frames = follow(place, -c / sd * (covariance * slope));
        const double there = frames ? arm_.distance(pair, *frames) - options_.margin : 0.0;
        const double threshold = c + std::min(0.0, there / sd) - ahead;
        half_spaces_.push_back({places_.size(), slope, sd, threshold, normal_tail(threshold)});
      }
    }
    if (!place.pairs.empty()) places_.push_back(std::move(place));
  }

  void share_out_draws() {
    double sum = 0.0;
    std::vector<double> of_place(places_.size(), 0.0);
    for (const HalfSpace& half : half_spaces_) {
      sum += half.probability;
      of_place[half.place] += half.probability;
    }
    for (HalfSpace& half : half_spaces_) {
      const double here = of_place[half.place] * static_cast<double>(places_.size());
      const double density = (1 - plain) * ((1 - even) / sum + even / here);
      half.draws = density * half.probability;
      places_[half.place].single = 1 / (plain + density);
      up_to_.push_back((up_to_.empty() ? plain : up_to_.back()) + half.draws);
    }
  }

  /// The frames of the arm with its hand off by `shift`, reached from the place's own joints; none if it is out of
  /// reach.
  [[nodiscard]] std::optional<std::array<Pose, 7>> follow(const Place& place, const Vector3& shift) const {
    Joints q = place.joints;
    Jacobian joints_per_hand = place.joints_per_hand;
    Eigen::Matrix<double, 6, 1> left = Eigen::Matrix<double, 6, 1>::Zero();
    left.head<3>() = shift;
    double before = left.norm();
    for (int step = 0; step < most_steps; ++step) {
      const Joints change = joints_per_hand * left;
      q += change * std::min(1.0, longest_step / change.cwiseAbs().maxCoeff());
      const auto frames = joint_frames(arm_.robot(), q);
      const Pose hand = frames[6] * tool_;
      left.head<3>() = place.hand.position + shift - hand.position;
      // Half the antisymmetric part: the rotation vector, for turns so small.
      const Matrix3 turn = place.hand.rotation * hand.rotation.transpose();
      left.tail<3>() = 0.5 * Vector3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
      const double now = left.norm();
      if (now <= followed * shift.norm() + no_spread) return frames;
      // The inverse at the start serves all steps, as long as each of them brings much.
      if (now > 0.2 * before) joints_per_hand = inverse_of(q);
      before = now;
    }
    return {};
  }

  [[nodiscard]] Jacobian inverse_of(const Joints& q) const {
    Eigen::CompleteOrthogonalDecomposition<Jacobian> inverse;
    inverse.setThreshold(singular);
    inverse.compute(jacobian(arm_.robot(), q, tool_.position));
    return inverse.pseudoInverse();
  }

  /// The i-th draw: stratified over the spread itself and the half spaces, so that each gets its share.
  void draw(Eigen::Index i, Random random, Eigen::Ref<Vector> z) const {
    for (double& value : z) value = random.normal();
    const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(options_.draws);
    if (at < plain) return;
    const auto found = std::lower_bound(up_to_.begin(), up_to_.end(), at) - up_to_.begin();
    const HalfSpace& half = half_spaces_[std::min(static_cast<std::size_t>(found), half_spaces_.size() - 1)];
    const Vector along =
        rows_.middleRows<3>(3 * static_cast<Eigen::Index>(half.place)).transpose() * half.slope / half.sd;
    z -= (along.dot(z) + normal_over(half.threshold, random)) * along;
  }

  void tally(const Eigen::Ref<const Vector>& shifts, std::vector<Tally>& samples, Tally& path) const {
    const auto shift_at = [&](std::size_t p) -> Vector3 { return shifts.segment<3>(3 * static_cast<Eigen::Index>(p)); };
    double density = plain;  // over that of the spread
    for (const HalfSpace& half : half_spaces_) {
      const bool inside = half.slope.dot(shift_at(half.place)) <= -half.threshold * half.sd;
      if (inside) density += half.draws / half.probability;
    }
    const double weight = 1 / density;
    bool any = false;
    for (std::size_t p = 0; p < places_.size(); ++p) {
      const Place& place = places_[p];
      const auto frames = follow(place, shift_at(p));
      if (!frames || !arm_.any_closer(place.pairs, options_.margin, *frames)) continue;
      samples[static_cast<std::size_t>(place.sample)].add(weight);
      any = true;
    }
    if (any) path.add(weight);
  }

  [[nodiscard]] Chance chance(const Tally& tally) const {
    const auto n = static_cast<double>(options_.draws);
    const double mean = tally.sum / n;
    if (tally.sum == 0) return {0.0, tally.single / n};
    return {std::min(mean, 1.0), std::sqrt(std::max(0.0, tally.squares / n - mean * mean) / n)};
  }

  const ArmClearance& arm_;
  const HandSpread& spread_;
  const Pose& tool_;
  const TouchingOptions& options_;
  std::vector<bool> certain_;
  std::vector<Place> places_;
  std::vector<HalfSpace> half_spaces_;
  std::vector<double> up_to_;  // plain, and the sum of their draws
  Matrix rows_;                // of the spread's factor, three a place
};

}  // namespace

Touching touching(const ArmClearance& arm, const Samples& joints, const HandSpread& spread, const Pose& tool,
                  const TouchingOptions& options) {
  if (joints.cols() != 6 || spread.samples() != joints.rows()) {
    throw DataError("touching.shape", "joints and covariance differ in samples");
  }
  return PathDraws(arm, joints, spread, tool, options).count();
}

}  // namespace lfd
