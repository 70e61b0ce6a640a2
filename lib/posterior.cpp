#include "lfdtools/posterior.hpp"

#include <algorithm>
#include <cmath>

#include "lfdtools/gaussian.hpp"

namespace lfd {
namespace {

Eigen::Index bases(const MotionPosterior& posterior) {
  return posterior.course.primitive.settings.bases();
}

Matrix factor(const PosteriorBlock& block, Spread spread) {
  if (spread == Spread::latent) return block.latent;
  Matrix both(block.latent.rows(), block.latent.cols() + block.noise.cols());
  both << block.latent, block.noise;
  return both;
}

/// s R F of one output of a block: T x r, so that the covariance of its motion is the product with its transpose.
Matrix motion_factor(const MotionPosterior& posterior, const PosteriorBlock& block, std::size_t output, const Matrix& R,
                     const Matrix& F) {
  const Eigen::Index N = bases(posterior);
  const double s = posterior.course.primitive.scale()[block.outputs[output]];
  return s * (R * F.middleRows(static_cast<Eigen::Index>(output) * N, N));
}

Matrix response_at(const MotionPosterior& posterior, const Vector& times) {
  const Dmp& dmp = posterior.course.primitive;
  return response_matrix(dmp.settings, dmp.tau, times);
}

/// Scale of a Student-t over its standard deviation.
double scale_ratio(double nu) {
  return std::isfinite(nu) ? std::sqrt((nu - 2) / nu) : 1.0;
}

/// Gamma(shape, 1) for shape >= 1 (Marsaglia and Tsang 2000).
double gamma_variate(double shape, Random& random) {
  const double d = shape - 1.0 / 3.0;
  const double c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = random.normal();
    const double v = std::pow(1 + c * x, 3);
    if (v > 0 && std::log(1 - random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

/// What a normal deviation with the block's covariance is to be multiplied by: sqrt((nu - 2) / chi^2).
double mixing_factor(double nu, Random& random) {
  return std::isfinite(nu) ? std::sqrt((nu - 2) / (2 * gamma_variate(nu / 2, random))) : 1.0;
}

Vector normal_vector(Eigen::Index size, Random& random) {
  Vector z(size);
  for (double& value : z) value = random.normal();
  return z;
}

/// The quantile of the largest |deviation| / scale over times and axes.
double path_factor(const MotionPosterior& posterior, const Vector& times, double level) {
  constexpr int draws = 4000;
  struct Axis {
    std::size_t block;
    Matrix unit;  // rows of the motion factor over their scale
  };
  std::vector<Axis> axes;
  const double tau = posterior.course.primitive.tau;
  const Eigen::Index inside = (times.array() <= tau * (1 + 1e-12)).count();
  const Matrix R = response_at(posterior, times.head(inside));
  for (std::size_t b = 0; b < posterior.blocks.size(); ++b) {
    const PosteriorBlock& block = posterior.blocks[b];
    for (std::size_t p = 0; p < block.outputs.size(); ++p) {
      Matrix unit = motion_factor(posterior, block, p, R, block.latent);
      const Vector sd = unit.rowwise().norm();
      const double still = 1e-6 * (sd.size() > 0 ? sd.maxCoeff() : 0.0);  // the ends, where nothing spreads
      for (Eigen::Index i = 0; i < unit.rows(); ++i) {
        unit.row(i) *= sd[i] > still ? 1 / (sd[i] * scale_ratio(block.degrees_of_freedom)) : 0.0;
      }
      axes.push_back({b, std::move(unit)});
    }
  }
  std::vector<double> largest(draws);
  Random random(1);
  for (double& most : largest) {
    std::vector<Vector> z;
    for (const auto& block : posterior.blocks) {
      const double mixing = mixing_factor(block.degrees_of_freedom, random);
      z.push_back(mixing * normal_vector(block.latent.cols(), random));
    }
    most = 0;
    for (const Axis& axis : axes) {
      if (axis.unit.rows() > 0) most = std::max(most, (axis.unit * z[axis.block]).cwiseAbs().maxCoeff());
    }
  }
  std::sort(largest.begin(), largest.end());
  return largest[static_cast<std::size_t>(std::min<double>(draws - 1, std::ceil(level * draws)))];
}

}  // namespace

Samples standard_deviation(const MotionPosterior& posterior, const Vector& times, Spread spread) {
  const Matrix R = response_at(posterior, times);
  Samples sd = Samples::Zero(times.size(), posterior.course.primitive.dimensions());
  for (const auto& block : posterior.blocks) {
    const Matrix F = factor(block, spread);
    for (std::size_t p = 0; p < block.outputs.size(); ++p) {
      sd.col(block.outputs[p]) = motion_factor(posterior, block, p, R, F).rowwise().norm();
    }
  }
  return sd;
}

std::vector<Matrix> motion_covariance(const MotionPosterior& posterior, const Vector& times, Spread spread) {
  const Matrix R = response_at(posterior, times);
  const Eigen::Index T = times.size();
  const Eigen::Index D = posterior.course.primitive.dimensions();
  const bool joint = std::any_of(posterior.blocks.begin(), posterior.blocks.end(),
                                 [](const auto& block) { return block.outputs.size() > 1; });
  std::vector<Matrix> result(joint ? 1 : static_cast<std::size_t>(D),
                             joint ? Matrix::Zero(D * T, D * T) : Matrix::Zero(T, T));
  for (const auto& block : posterior.blocks) {
    const Matrix F = factor(block, spread);
    std::vector<Matrix> factors;
    for (std::size_t p = 0; p < block.outputs.size(); ++p) {
      factors.push_back(motion_factor(posterior, block, p, R, F));
      for (std::size_t q = 0; q <= p; ++q) {
        const Matrix part = factors[p] * factors[q].transpose();
        if (!joint) {
          result[static_cast<std::size_t>(block.outputs[p])] = part;
          continue;
        }
        result[0].block(block.outputs[p] * T, block.outputs[q] * T, T, T) = part;
        result[0].block(block.outputs[q] * T, block.outputs[p] * T, T, T) = part.transpose();
      }
    }
  }
  return result;
}

Course draw(const MotionPosterior& posterior, Spread spread, Random& random) {
  Course course = posterior.course;
  const Eigen::Index N = bases(posterior);
  for (const auto& block : posterior.blocks) {
    const double mixing = mixing_factor(block.degrees_of_freedom, random);
    Vector w = block.latent * normal_vector(block.latent.cols(), random);
    if (spread == Spread::predictive) w += block.noise * normal_vector(block.noise.cols(), random);
    for (std::size_t p = 0; p < block.outputs.size(); ++p) {
      course.primitive.weights.row(block.outputs[p]) +=
          mixing * w.segment(static_cast<Eigen::Index>(p) * N, N).transpose();
    }
  }
  return course;
}

Samples band(const MotionPosterior& posterior, const Vector& times, BandKind kind, double level) {
  Samples half = standard_deviation(posterior, times, Spread::latent);
  const double whole = kind == BandKind::path ? path_factor(posterior, times, level) : 0.0;
  for (const auto& block : posterior.blocks) {
    const double nu = block.degrees_of_freedom;
    const double quantile = kind == BandKind::path ? whole : student_t_quantile(0.5 * (1 + level), nu);
    for (const int j : block.outputs) half.col(j) *= quantile * scale_ratio(nu);
  }
  return half;
}

Samples motion_band(const SkillPredictor& predictor, const MotionPosterior& posterior, const Vector& times,
                    BandKind kind, double level) {
  if (!predictor.skill().calibration) return band(posterior, times, kind, level);
  const Dmp& dmp = posterior.course.primitive;
  Reach reach(dmp.goal - dmp.start, dmp.start - predictor.skill().start);
  reach.teacher = posterior.teacher;
  const Vector phases = times / dmp.tau;
  const Samples half = band(predictor, reach, phases, kind, level);
  if (!posterior.constrained) return half;
  const PositionVariance without = position_variance(predictor, reach, phases);
  const Samples before = (without.unit * without.latent.asDiagonal()).array().sqrt();
  const Samples sd = standard_deviation(posterior, times, Spread::latent);
  return (before.array() > 0).select(half.array() * sd.array() / before.array().max(1e-300), 0.0);
}

}  // namespace lfd
