#include "lfdtools/touching.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/semidefinite.hpp"

namespace lfd {
namespace {

// A pair this many standard deviations away counts as never touching: 6e-16.
constexpr double never = 8.0;
// An error of the hand that moves a distance by less is none [m].
constexpr double no_spread = 1e-12;
// Joints move by at most 1 / this for a hand's metre: nearer to a singularity the least-squares motion is taken [m].
constexpr double singular = 1e-6;

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

Matrix thin_factor(const Matrix& A) {
  if (A.rows() != A.cols() || !A.allFinite()) {
    throw DataError("touching.shape", "a covariance is not square or not finite");
  }
  Matrix L;
  if (!try_thin_cholesky(A, L)) {
    throw DataError("touching.not_positive", "a covariance is not positive semidefinite");
  }
  return L;
}

/// Events row.z <= -threshold of a standard normal z, rows of unit length.
struct Events {
  Matrix rows;        ///< M x K
  Vector thresholds;  ///< M
};

/// Probability of any of the events.
Chance any_of(const Events& events, Eigen::Index draws, Random random) {
  const Eigen::Index M = events.thresholds.size(), K = events.rows.cols();
  if (M == 0) return {};
  const Vector P = events.thresholds.unaryExpr(&normal_tail);
  const double sum = P.sum();
  if (M == 1 || sum == 0) return {sum, 0.0};
  std::vector<double> up_to(static_cast<std::size_t>(M));
  std::partial_sum(P.begin(), P.end(), up_to.begin());
  double mean = 0.0, square = 0.0;
  constexpr Eigen::Index block = 128;
  Matrix Z(K, block), Y(M, block);
  for (Eigen::Index first = 0; first < draws; first += block) {
    const Eigen::Index n = std::min(block, draws - first);
    for (Eigen::Index i = 0; i < n; ++i) {
      // Which event: stratified, so that each gets its share of the draws.
      const double at = (static_cast<double>(first + i) + random.uniform()) / static_cast<double>(draws) * sum;
      const auto m = std::min<Eigen::Index>(std::lower_bound(up_to.begin(), up_to.end(), at) - up_to.begin(), M - 1);
      for (Eigen::Index k = 0; k < K; ++k) Z(k, i) = random.normal();
      const double along = -normal_over(events.thresholds[m], random);
      Z.col(i) += (along - events.rows.row(m).dot(Z.col(i))) * events.rows.row(m).transpose();
    }
    Y.leftCols(n).noalias() = events.rows * Z.leftCols(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto touched = ((Y.col(i) + events.thresholds).array() <= 1e-9).count();
      const double weight = 1.0 / static_cast<double>(std::max<Eigen::Index>(touched, 1));
      mean += weight;
      square += weight * weight;
    }
  }
  const auto n = static_cast<double>(draws);
  mean /= n;
  const double spread = std::sqrt(std::max(0.0, square / n - mean * mean) / n);
  return {std::clamp(sum * mean, P.maxCoeff(), std::min(1.0, sum)), sum * spread};
}

}  // namespace

HandSpread hand_spread(const std::vector<Matrix>& covariance, const Matrix3& rotation) {
  if (covariance.size() != 1 && covariance.size() != 3) {
    throw DataError("touching.shape", "there must be three covariances of T x T, or one of 3 T x 3 T");
  }
  const bool joint = covariance.size() == 1;
  const Eigen::Index T = joint ? covariance[0].rows() / 3 : covariance[0].rows();
  if (T < 1 || (joint && covariance[0].rows() != 3 * T))
    throw DataError("touching.shape", "the covariance is not 3 T x 3 T");
  std::vector<Matrix> factors;
  Eigen::Index K = 0;
  for (const Matrix& part : covariance) {
    factors.push_back(thin_factor(part));
    if (factors.back().rows() != (joint ? 3 * T : T)) throw DataError("touching.shape", "covariances differ in size");
    K += factors.back().cols();
  }
  HandSpread spread{Matrix::Zero(3 * T, K)};
  for (Eigen::Index t = 0; t < T; ++t) {
    Eigen::Index column = 0;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const Matrix& L = factors[joint ? 0 : static_cast<std::size_t>(a)];
      spread.factor.row(3 * t + a).segment(column, L.cols()) = L.row(joint ? a * T + t : t);
      if (!joint) column += L.cols();
    }
    spread.factor.middleRows(3 * t, 3) = (rotation * spread.factor.middleRows(3 * t, 3)).eval();
  }
  return spread;
}

HandSpread with_shift(const HandSpread& spread, const Vector3& sd, const Vector& share) {
  const Eigen::Index T = share.size(), K = spread.factor.cols();
  if (K > 0 && spread.samples() != T) throw DataError("touching.shape", "spread and shift differ in samples");
  HandSpread both{Matrix::Zero(3 * T, K + 3)};
  if (K > 0) both.factor.leftCols(K) = spread.factor;
  for (Eigen::Index t = 0; t < T; ++t) {
    both.factor.block(3 * t, K, 3, 3) = (share[t] * sd).asDiagonal();
  }
  return both;
}

Touching touching(const ArmClearance& arm, const Samples& joints, const HandSpread& spread, const Pose& tool,
                  const TouchingOptions& options) {
  const Eigen::Index T = joints.rows();
  if (joints.cols() != 6 || spread.samples() != T) {
    throw DataError("touching.shape", "joints and covariance differ in samples");
  }
  const Random random(options.seed);
  Touching result;
  std::vector<Vector> rows;
  std::vector<double> thresholds;
  const auto events_from = [&](std::size_t first) {
    const auto M = static_cast<Eigen::Index>(rows.size() - first);
    Events events{Matrix(M, spread.factor.cols()), Vector(M)};
    for (Eigen::Index m = 0; m < M; ++m) {
      events.rows.row(m) = rows[first + static_cast<std::size_t>(m)].transpose();
      events.thresholds[m] = thresholds[first + static_cast<std::size_t>(m)];
    }
    return events;
  };
  bool certain = false;
  for (Eigen::Index t = 0; t < T; ++t) {
    const Joints q = joints.row(t).transpose();
    auto pairs = arm.pairs(q);
    if (options.self) {
      const auto own = arm.pairs_of_arm_itself(q);
      pairs.insert(pairs.end(), own.begin(), own.end());
    }
    Eigen::CompleteOrthogonalDecomposition<Jacobian> inverse;
    inverse.setThreshold(singular);
    inverse.compute(jacobian(arm.robot(), q, tool.position));
    const Eigen::Matrix<double, 6, 3> joints_per_hand = inverse.pseudoInverse().leftCols<3>();
    const std::size_t first = rows.size();
    bool touches = false;
    for (const LinkClearance& pair : pairs) {
      const double room = pair.distance - options.margin;
      const Vector3 slope = joints_per_hand.transpose() * arm.slope(pair, q);
      const Vector row = spread.factor.middleRows(3 * t, 3).transpose() * slope;
      const double sd = row.norm();
      if (sd < no_spread) {
        touches = touches || room <= 0;
      } else if (room < never * sd) {
        rows.push_back(row / sd);
        thresholds.push_back(room / sd);
      }
    }
    certain = certain || touches;
    const auto key = static_cast<std::uint64_t>(t) + 1;
    result.samples.push_back(touches ? Chance{1.0, 0.0}
                                     : any_of(events_from(first), options.draws / 4, random.split(key)));
  }
  result.path = certain ? Chance{1.0, 0.0} : any_of(events_from(0), options.draws, random.split(0));
  for (const Chance& sample : result.samples) {
    result.path.probability = std::max(result.path.probability, sample.probability);
  }
  return result;
}

}  // namespace lfd
