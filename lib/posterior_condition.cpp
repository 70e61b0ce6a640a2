// Prediction of a motion, and conditioning it on demands (posterior.hpp).
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lfdtools/error.hpp"
#include "lfdtools/posterior.hpp"

namespace lfd {
namespace {

/// One number that a motion shall have: a position, or a velocity times tau, so that all are metres.
struct Demand {
  int signal;
  double time;  // [s]
  bool velocity;
  double value;  // [m] or [m/s]
  double sd;     // [m]; 0: exact
};

/// L with L L^T = Omega, also where Omega is singular.
Matrix omega_factor(const Matrix& omega) {
  Matrix L;
  if (try_cholesky(omega, L)) return L;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(omega);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The weights' covariance of one process as factors: W = Y A^-1, so F = k^(1/2) A^-T L.
PosteriorBlock block_of(const SkillModel& model, const MvgpPrediction& prediction) {
  PosteriorBlock block;
  block.outputs = model.outputs;
  block.degrees_of_freedom = prediction.degrees_of_freedom;
  if (!(block.degrees_of_freedom > 2)) {
    throw DataError("posterior.no_variance",
                    fmt::format("the skill's weights have a Student-t with {} degrees of freedom, so no variance",
                                block.degrees_of_freedom));
  }
  Matrix unit = omega_factor(model.process.omega);
  const Matrix& A = model.process.output_transform;
  if (A.size() > 0) unit = Eigen::PartialPivLU<Matrix>(A.transpose()).solve(unit);
  block.latent = std::sqrt(prediction.variance) * unit;
  block.noise = std::sqrt(model.process.noise_variance) * unit;
  return block;
}

std::vector<Demand> demands_of(const Dmp& dmp, const MotionConstraints& constraints) {
  const auto D = static_cast<int>(dmp.dimensions());
  std::vector<Demand> demands;
  for (const Waypoint& via : constraints.via) {
    if (!(via.time > 0 && via.time < dmp.tau)) {
      throw DataError("posterior.via_time",
                      fmt::format("a point to pass at {} s: the motion to the goal lasts {:.6g} s", via.time, dmp.tau));
    }
    for (int j = 0; j < D; ++j) demands.push_back({j, via.time, false, via.position[j], via.sd});
  }
  for (int j = 0; j < D; ++j) {
    demands.push_back({j, dmp.tau, false, dmp.goal[j], 0});
    if (constraints.end_velocity) demands.push_back({j, dmp.tau, true, (*constraints.end_velocity)[j], 0});
  }
  std::stable_sort(demands.begin(), demands.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return demands;
}

Vector times_of(const std::vector<Demand>& demands) {
  Vector times(static_cast<Eigen::Index>(demands.size()));
  for (std::size_t i = 0; i < demands.size(); ++i) times[static_cast<Eigen::Index>(i)] = demands[i].time;
  return times;
}

/// What the demands ask beyond the mean motion [m].
Vector residual(const Course& course, const std::vector<Demand>& demands) {
  const Motion motion = rollout(course, times_of(demands));
  Vector e(motion.times.size());
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    const Demand& demand = demands[static_cast<std::size_t>(i)];
    e[i] = demand.velocity ? course.primitive.tau * (demand.value - motion.velocities(i, demand.signal))
                           : demand.value - motion.positions(i, demand.signal);
  }
  return e;
}

/// Rows of the demands in the weights of a block, k x d [m]; rows of other signals are left out of `demands` before.
Matrix demand_rows(const Dmp& dmp, const PosteriorBlock& block, const std::vector<Demand>& demands) {
  const Eigen::Index N = dmp.settings.bases();
  const DmpResponse R = response(dmp.settings, dmp.tau, times_of(demands));
  Matrix H = Matrix::Zero(static_cast<Eigen::Index>(demands.size()), block.latent.rows());
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    const Demand& demand = demands[static_cast<std::size_t>(i)];
    const auto p = std::find(block.outputs.begin(), block.outputs.end(), demand.signal) - block.outputs.begin();
    const double s = dmp.scale()[demand.signal];
    H.row(i).segment(p * N, N) = demand.velocity ? (s * dmp.tau) * R.velocity.row(i) : s * R.position.row(i);
  }
  return H;
}

/// Orthonormal directions, in the standard normal space of a factor, that rows G of exact demands fix: directions whose
/// standard deviation, given the demands before, is over `floor` [m].
class FixedDirections {
 public:
  FixedDirections(const Matrix& G, double floor) : qr_(G.transpose()) {
    const auto diagonal = qr_.matrixQR().diagonal().cwiseAbs();
    while (rank_ < diagonal.size() && diagonal[rank_] > floor) ++rank_;
    Q_ = qr_.householderQ() * Matrix::Identity(G.cols(), rank_);
  }
  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  /// The shortest u with G u = e, as far as these directions reach.
  [[nodiscard]] Vector solve(const Vector& e) const {
    if (rank_ == 0) return Vector::Zero(Q_.rows());
    const Vector permuted = qr_.colsPermutation().transpose() * e;
    return Q_ * qr_.matrixQR()
                    .topLeftCorner(rank_, rank_)
                    .triangularView<Eigen::Upper>()
                    .transpose()
                    .solve(permuted.head(rank_));
  }
  /// The factor without these directions.
  [[nodiscard]] Matrix remove(const Matrix& F) const { return F - (F * Q_) * Q_.transpose(); }

 private:
  Eigen::ColPivHouseholderQR<Matrix> qr_;
  Eigen::Index rank_ = 0;
  Matrix Q_;
};

void add(Dmp& dmp, const PosteriorBlock& block, const Vector& w) {
  const Eigen::Index N = dmp.settings.bases();
  for (std::size_t p = 0; p < block.outputs.size(); ++p) {
    dmp.weights.row(block.outputs[p]) += w.segment(static_cast<Eigen::Index>(p) * N, N).transpose();
  }
}

[[noreturn]] void refuse(const std::vector<Demand>& demands, const Vector& e, const Dmp& dmp,
                         const std::vector<std::string>& columns) {
  Eigen::Index worst = 0;
  const double left = e.cwiseAbs().maxCoeff(&worst);
  const Demand& demand = demands[static_cast<std::size_t>(worst)];
  const auto& name = columns[static_cast<std::size_t>(demand.signal)];
  throw DataError(
      "posterior.unreachable",
      fmt::format("the demands cannot all be met: {} of {} at {:.6g} s is left {:.3g} {} away (they contradict each "
                  "other, or the skill knows no variation in that direction)",
                  demand.velocity ? "the velocity" : "the position", name, demand.time,
                  demand.velocity ? left / dmp.tau : 1e3 * left, demand.velocity ? "m/s" : "mm"));
}

/// Largest standard deviation of a block along the motion [m].
double largest_sd(const Dmp& dmp, const PosteriorBlock& block, const Matrix& F) {
  const Eigen::Index N = dmp.settings.bases();
  const Matrix R = response_matrix(dmp.settings, dmp.tau, linspace(0, dmp.tau, 101));
  double largest = 0;
  for (std::size_t p = 0; p < block.outputs.size(); ++p) {
    const double s = std::abs(dmp.scale()[block.outputs[p]]);
    const Matrix rows = R * F.middleRows(static_cast<Eigen::Index>(p) * N, N);
    largest = std::max(largest, s * rows.rowwise().norm().maxCoeff());
  }
  return largest;
}

/// Conditions one block on demands on its own signals, exact ones first.
/// @return squared Mahalanobis distance of the demands
double condition(MotionPosterior& posterior, PosteriorBlock& block, const std::vector<Demand>& demands,
                 const std::vector<std::string>& columns) {
  constexpr double met = 1e-9;          // [m]
  constexpr double least_share = 1e-8;  // of the largest sd: below, a direction has no variance but rounding
  Dmp& dmp = posterior.course.primitive;
  std::vector<Demand> exact;
  std::vector<Demand> soft;
  for (const Demand& demand : demands) (demand.sd > 0 ? soft : exact).push_back(demand);

  const Matrix H = demand_rows(dmp, block, exact);
  const FixedDirections fixed(H * block.latent, least_share * largest_sd(dmp, block, block.latent));
  const Vector u = fixed.solve(residual(posterior.course, exact));
  double delta = u.squaredNorm();
  add(dmp, block, block.latent * u);
  // The sums above round: once more with what they left.
  add(dmp, block, block.latent * fixed.solve(residual(posterior.course, exact)));
  const Vector left = residual(posterior.course, exact);
  if (!(left.cwiseAbs().maxCoeff() <= met)) refuse(exact, left, dmp, columns);
  const FixedDirections fixed_noise(H * block.noise, least_share * largest_sd(dmp, block, block.noise));
  block.latent = fixed.remove(block.latent);
  block.noise = fixed_noise.remove(block.noise);

  if (!soft.empty()) {
    Vector e = residual(posterior.course, soft);
    Matrix G = demand_rows(dmp, block, soft) * block.latent;
    for (Eigen::Index i = 0; i < e.size(); ++i) {
      const double sd = soft[static_cast<std::size_t>(i)].sd;
      e[i] /= sd;
      G.row(i) /= sd;
    }
    const Eigen::JacobiSVD<Matrix> svd(G, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Vector g = svd.singularValues();
    const Vector c = svd.matrixU().transpose() * e;
    const Vector shrink = (1 + g.array().square()).sqrt().inverse();  // of the sd along each direction
    add(dmp, block, block.latent * (svd.matrixV() * (g.array() * c.array() * shrink.array().square()).matrix()));
    delta += e.squaredNorm() - (g.array() * shrink.array() * c.array()).square().sum();
    const Vector removed = 1 - shrink.array();
    block.latent -= (block.latent * svd.matrixV()) * removed.asDiagonal() * svd.matrixV().transpose();
  }

  const double k = static_cast<double>(fixed.rank()) + static_cast<double>(soft.size());
  double& nu = block.degrees_of_freedom;
  if (std::isfinite(nu)) {
    const double c = std::sqrt((nu - 2 + delta) / (nu + k - 2));
    block.latent *= c;
    block.noise *= c;
    nu += k;
  }
  return delta;
}

}  // namespace

MotionPosterior predict_motion(const SkillPredictor& predictor, const Goal& goal,
                               const MotionConstraints& constraints) {
  const Skill& skill = predictor.skill();
  MotionPosterior posterior;
  Dmp& dmp = posterior.course.primitive;
  dmp = predictor.primitive(goal);
  posterior.teacher = predictor.reach(goal).teacher;
  if (constraints.start_velocity) posterior.course.start_velocity = *constraints.start_velocity;
  for (std::size_t m = 0; m < skill.models.size(); ++m) {
    posterior.blocks.push_back(
        block_of(skill.models[m], predictor.processes()[m].predict(inputs_of(skill.models[m], predictor.reach(goal)))));
  }
  constexpr double rounding = 1e-6;  // [m]
  Vector end(1);
  end << dmp.tau;
  const double miss = (rollout(posterior.course, end).positions.row(0).transpose() - dmp.goal).cwiseAbs().maxCoeff();
  posterior.constrained = !constraints.empty();
  posterior.ends_on_goal = !constraints.empty() || miss < rounding;
  if (!posterior.ends_on_goal) return posterior;
  const auto demands = demands_of(dmp, constraints);
  double delta = 0;
  for (auto& block : posterior.blocks) {
    std::vector<Demand> own;
    for (const Demand& demand : demands) {
      if (std::find(block.outputs.begin(), block.outputs.end(), demand.signal) != block.outputs.end()) {
        own.push_back(demand);
      }
    }
    delta += condition(posterior, block, own, skill.columns);
  }
  posterior.distance = std::sqrt(delta);
  return posterior;
}

}  // namespace lfd
