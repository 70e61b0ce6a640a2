#include "lfdtools/touching.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur10.hpp"
#include "path_proposal.hpp"

namespace lfd {
namespace {

// What is this many standard deviations away counts as never touching: 6e-16.
constexpr double never = 8.0;
// An error of the hand that moves a gap by less is none [m].
constexpr double no_spread = 1e-12;
// Of the pivots of a Jacobian: nearer to a singularity the least-squares motion is taken.
constexpr double singular = 1e-6;
// Joints follow a shift of the hand to this share of it, in at most so many steps,
constexpr double followed = 1e-4;
constexpr int most_steps = 12;
// none of which, and not all of them together, moves a joint further [rad].
constexpr double longest_step = 0.5;
// Half spaces begin this much before the bodies touch [standard deviations], since these are curved.
constexpr double ahead = 0.1;

using Frames = std::array<Pose, 7>;

/// A sample of the path at which something may be touched.
struct Place {
  Eigen::Index sample = 0;
  Joints joints;
  Pose hand;
  Jacobian joints_per_hand;          // pseudoinverse
  std::vector<LinkClearance> pairs;  // that may touch
};

/// The arm, whose joints follow its hand.
class Follower {
 public:
  Follower(const Robot& robot, const Pose& tool) : robot_(robot), tool_(tool), flange_(inverse(tool)) {
    try {
      solver_.emplace(robot);
    } catch (const ConfigError&) {
      // Not a UR: Newton's method has to do.
    }
  }

  [[nodiscard]] Place place(Eigen::Index sample, const Joints& q) const {
    return {sample, q, forward_kinematics(robot_, q) * tool_, inverse_jacobian(q), {}};
  }

  /// The frames of the arm with its hand off by `shift`: by Newton's method from the place's own joints, near
  /// singularities by the inverse kinematics, the solution nearest to them. None if the hand is out of reach.
  [[nodiscard]] std::optional<Frames> operator()(const Place& place, const Vector3& shift) const {
    const Pose goal{place.hand.rotation, place.hand.position + shift};
    if (const auto frames = newton(place, goal)) return frames;
    return solver_ ? nearest(place, goal) : std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<Frames> newton(const Place& place, const Pose& goal) const {
    Joints q = place.joints;
    Jacobian joints_per_hand = place.joints_per_hand;
    Eigen::Matrix<double, 6, 1> left = Eigen::Matrix<double, 6, 1>::Zero();
    left.head<3>() = goal.position - place.hand.position;
    const double enough = followed * left.norm() + no_spread;
    double before = left.norm();
    for (int step = 0; step < most_steps; ++step) {
      const Joints change = joints_per_hand * left;
      q += change * std::min(1.0, longest_step / change.cwiseAbs().maxCoeff());
      const Frames frames = joint_frames(robot_, q);
      const Pose hand = frames[6] * tool_;
      left.head<3>() = goal.position - hand.position;
      // Half the antisymmetric part: the rotation vector, for turns so small.
      const Matrix3 turn = goal.rotation * hand.rotation.transpose();
      left.tail<3>() = 0.5 * Vector3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
      const double now = left.norm();
      if ((q - place.joints).cwiseAbs().maxCoeff() > longest_step) return {};
      if (now <= enough) return frames;
      // The inverse at the start serves all steps, as long as each of them brings much.
      if (now > 0.2 * before) joints_per_hand = inverse_jacobian(q);
      before = now;
    }
    return {};
  }

  [[nodiscard]] std::optional<Frames> nearest(const Place& place, const Pose& goal) const {
    std::optional<Joints> best;
    double least = std::numeric_limits<double>::infinity();
    for (const IkSolution& solution : (*solver_)(goal * flange_)) {
      Joints way = solution.joints - place.joints;
      for (double& angle : way) angle = wrap_angle(angle);
      if (way.norm() >= least) continue;
      least = way.norm();
      best = place.joints + way;
    }
    return best ? std::optional<Frames>(joint_frames(robot_, *best)) : std::nullopt;
  }

  [[nodiscard]] Jacobian inverse_jacobian(const Joints& q) const {
    Eigen::CompleteOrthogonalDecomposition<Jacobian> inverse;
    inverse.setThreshold(singular);
    inverse.compute(jacobian(robot_, q, tool_.position));
    return inverse.pseudoInverse();
  }

  const Robot& robot_;
  const Pose& tool_;
  Pose flange_;
  std::optional<InverseKinematics> solver_;
};

/// What may be touched along a path, and half spaces of the hand's errors where it is, to first order.
class Surroundings {
 public:
  Surroundings(const ArmClearance& arm, const Samples& joints, const HandSpread& spread, const Pose& tool,
               const TouchingOptions& options)
      : arm_(arm), options_(options), follow_(arm.robot(), tool), certain_(static_cast<std::size_t>(joints.rows())) {
    for (Eigen::Index t = 0; t < joints.rows(); ++t) {
      look_at(follow_.place(t, joints.row(t).transpose()), spread.factor.middleRows<3>(3 * t));
    }
  }

  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }
  /// By sample: the hand is where it is, and something is touched.
  [[nodiscard]] const std::vector<bool>& certain() const { return certain_; }
  [[nodiscard]] const Follower& follow() const { return follow_; }

 private:
  void look_at(Place place, const Eigen::Ref<const Matrix>& F) {
    const Joints& q = place.joints;
    auto pairs = arm_.pairs(q);
    if (options_.self) {
      const auto own = arm_.pairs_of_arm_itself(q);
      pairs.insert(pairs.end(), own.begin(), own.end());
    }
    const Joints sd = (place.joints_per_hand.leftCols<3>() * F).rowwise().norm();
    const double furthest = (options_.self ? 2.0 : 1.0) * arm_.furthest_motion(q, never * sd);
    const bool still = F.norm() < no_spread;
    for (const LinkClearance& pair : pairs) {
      const double room = pair.distance - options_.margin;
      if (still && room <= 0) certain_[static_cast<std::size_t>(place.sample)] = true;
      if (!still && room <= furthest) place.pairs.push_back(pair);
    }
    if (place.pairs.empty()) return;
    const Frames frames = joint_frames(arm_.robot(), q);
    for (const LinkClearance& pair : place.pairs) {
      const auto gaps = arm_.gaps(pair, frames);
      for (std::size_t i = 0; i < gaps.size(); ++i) foresee(place, pair, gaps[i], i, F);
    }
    places_.push_back(std::move(place));
  }

  /// The half space where one gap of a pair closes.
  void foresee(const Place& place, const LinkClearance& pair, const Gap& gap, std::size_t number,
               const Eigen::Ref<const Matrix>& F) {
    const Vector3 slope = place.joints_per_hand.leftCols<3>().transpose() * gap.slope;
    const Vector along = F.transpose() * slope;
    const double sd = along.norm();
    const double c = (gap.distance - options_.margin) / sd;
    if (sd < no_spread || !(c < never)) return;
    // Where it should just close it may have closed already, for joints turn.
    const auto frames = follow_(place, -c / sd * (F * along));
    const double there = frames ? arm_.gaps(pair, *frames)[number].distance - options_.margin : 0.0;
    half_spaces_.push_back({places_.size(), slope, c + std::min(0.0, there / sd) - ahead});
  }

  const ArmClearance& arm_;
  const TouchingOptions& options_;
  Follower follow_;
  std::vector<bool> certain_;
  std::vector<Place> places_;
  std::vector<HalfSpace> half_spaces_;
};

/// Weights of the draws of which something is so.
struct Tally {
  double sum = 0.0;
  double squares = 0.0;

  void add(double weight) {
    sum += weight;
    squares += weight * weight;
  }

  [[nodiscard]] Chance chance(Eigen::Index draws) const {
    const auto n = static_cast<double>(draws);
    const double mean = sum / n;
    return {std::min(mean, 1.0), std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
  }
};

/// How often something is touched at each sample, and at any, how often the hand is out of reach at any, and how often
/// either.
struct Tallies {
  std::vector<Tally> samples;
  Tally path, out_of_reach, either;
};

Tallies count(const ArmClearance& arm, const Surroundings& around, const HandSpread& spread,
              const TouchingOptions& options) {
  const auto& places = around.places();
  Tallies tallies{std::vector<Tally>(around.certain().size()), {}, {}, {}};
  if (places.empty()) return tallies;
  Matrix factor(3 * static_cast<Eigen::Index>(places.size()), spread.factor.cols());
  for (std::size_t p = 0; p < places.size(); ++p) {
    factor.middleRows<3>(3 * static_cast<Eigen::Index>(p)) = spread.factor.middleRows<3>(3 * places[p].sample);
  }
  const PathProposal proposal(std::move(factor), around.half_spaces());
  const auto look = [&](const Eigen::Ref<const Vector>& dx) {
    const double weight = proposal.weight(dx);
    bool touches = false, lost = false;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const auto frames = around.follow()(places[p], dx.segment<3>(3 * static_cast<Eigen::Index>(p)));
      lost = lost || !frames;
      if (!frames || !arm.any_closer(places[p].pairs, options.margin, *frames)) continue;
      tallies.samples[static_cast<std::size_t>(places[p].sample)].add(weight);
      touches = true;
    }
    if (touches) tallies.path.add(weight);
    if (lost) tallies.out_of_reach.add(weight);
    if (touches || lost) tallies.either.add(weight);
  };
  const Random random(options.seed);
  constexpr Eigen::Index block = 128;
  Matrix Z(proposal.factor().cols(), block), dx(proposal.factor().rows(), block);
  for (Eigen::Index first = 0; first < options.draws; first += block) {
    const Eigen::Index n = std::min(block, options.draws - first);
    for (Eigen::Index i = 0; i < n; ++i) {
      Random own = random.split(static_cast<std::uint64_t>(first + i));
      // Spread evenly over the parts of the proposal, so that each gets its share.
      const double at = (static_cast<double>(first + i) + own.uniform()) / static_cast<double>(options.draws);
      Z.col(i) = proposal.draw(at, own);
    }
    dx.leftCols(n).noalias() = proposal.factor() * Z.leftCols(n);
    for (Eigen::Index i = 0; i < n; ++i) look(dx.col(i));
  }
  return tallies;
}

}  // namespace

Touching touching(const ArmClearance& arm, const Samples& joints, const HandSpread& spread, const Pose& tool,
                  const TouchingOptions& options) {
  if (joints.cols() != 6 || spread.samples() != joints.rows() || options.draws < 1) {
    throw DataError("touching.shape", "joints and covariance differ in samples, or nothing is drawn");
  }
  if (!joints.allFinite() || !spread.factor.allFinite()) {
    throw DataError("touching.not_finite", "joints or covariance are not finite");
  }
  const Surroundings around(arm, joints, spread, tool, options);
  const Tallies tallies = count(arm, around, spread, options);
  Touching result;
  result.path = tallies.path.chance(options.draws);
  result.out_of_reach = tallies.out_of_reach.chance(options.draws);
  result.path_or_out_of_reach = tallies.either.chance(options.draws);
  for (std::size_t t = 0; t < tallies.samples.size(); ++t) {
    const bool certain = around.certain()[t];
    result.samples.push_back(certain ? Chance{1.0, 0.0} : tallies.samples[t].chance(options.draws));
    if (certain) result.path = result.path_or_out_of_reach = {1.0, 0.0};
  }
  return result;
}

}  // namespace lfd
