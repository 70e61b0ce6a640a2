#include "lfdtools/synthesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

namespace lfd {
namespace {

using Eigen::Index;

constexpr double pi = std::numbers::pi;
constexpr double latest_tempo = 0.3;  // under 1 / pi, so that s + c sin(pi s) rises
constexpr Index berth_phases = 65;
constexpr double berth_norm = 32;
constexpr double least_bump = 0.2;

enum Stream : std::uint64_t { way_stream, duration_stream, tempo_stream, wander_stream, tremor_stream };

double minimum_jerk(double s) {
  return s * s * s * (10 + s * (6 * s - 15));
}

double bump(double s, double a) {
  const double sine = std::sin(pi * std::pow(s, a));
  return sine * sine;
}

double softplus(double z, double h) {
  return 0.5 * (z + std::sqrt(z * z + h * h));
}

Random stream_of(const Experiment& experiment, const std::string& target, Index repetition) {
  std::uint64_t key = 0xCBF29CE484222325ULL;  // FNV-1a of the name
  for (const char c : target) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return Random(experiment.seed).split(key).split(static_cast<std::uint64_t>(repetition));
}

void require(bool right, const char* id, const std::string& text) {
  if (!right) throw DataError(id, text);
}

void require_vector(const Vector& v, Index D, bool may_be_empty, const std::string& name) {
  require(v.size() == D || (may_be_empty && v.size() == 0), "synthesis.shape",
          fmt::format("{} has {} values, not {}", name, v.size(), D));
  require(v.allFinite(), "synthesis.not_finite", fmt::format("{} has a value that is not a finite number", name));
}

void require_positive(double value, const std::string& name) {
  require(std::isfinite(value) && value > 0, "synthesis.value", fmt::format("{} is {}, not positive", name, value));
}

void require_size(double value, const std::string& name) {
  require(std::isfinite(value) && value >= 0, "synthesis.value",
          fmt::format("{} is {}, not zero or more", name, value));
}

void check_bump(const Bump& b, Index D, const std::string& column) {
  const std::string name = "the bump of " + column;
  require(std::isfinite(b.exponent) && b.exponent > 0.5, "synthesis.value", name + ": the exponent is not over 0.5");
  require(std::isfinite(b.constant), "synthesis.not_finite", name + ": the constant is not a finite number");
  require_vector(b.linear, D, true, name + ": linear");
  require((b.quadratic.rows() == D && b.quadratic.cols() == D) || b.quadratic.size() == 0, "synthesis.shape",
          name + ": quadratic is not a square matrix over the signals");
  require(b.quadratic.allFinite(), "synthesis.not_finite", name + ": quadratic is not finite");
  for (const SineTerm& term : b.sines) {
    require_vector(term.rates, D, false, name + ": rates");
    require(std::isfinite(term.amplitude) && std::isfinite(term.phase), "synthesis.not_finite",
            name + ": a sine term is not finite");
  }
  for (const GaussianTerm& term : b.gaussians) {
    require_vector(term.center, D, false, name + ": center");
    require(std::isfinite(term.amplitude), "synthesis.not_finite", name + ": a Gaussian term is not finite");
    require_positive(term.width, name + ": width");
  }
}

/// The part of v across the obstacle's axis; all of it for a sphere.
Vector across(const Obstacle& obstacle, const Vector& v) {
  if (obstacle.axis.size() == 0) return v;
  const Vector axis = obstacle.axis.normalized();
  return v - axis.dot(v) * axis;
}

void check_obstacle(const Experiment& e) {
  const Obstacle& o = *e.obstacle;
  const Index D = e.start.size();
  require_vector(o.center, D, false, "the obstacle's center");
  require_vector(o.axis, D, true, "the obstacle's axis");
  require(o.axis.size() == 0 || o.axis.norm() > 0, "synthesis.value", "the obstacle's axis has no direction");
  require_positive(o.radius, "the obstacle's radius");
  require_size(o.clearance, "the obstacle's clearance");
  require_positive(o.softness, "the obstacle's softness");
  require(std::isfinite(o.exponent) && o.exponent > 0.5, "synthesis.value", "the berth's exponent is not over 0.5");
  require(!o.ways.empty(), "synthesis.way", "the obstacle has no way round");
  for (const Vector& way : o.ways) {
    require_vector(way, D, false, "a way round the obstacle");
    require(across(o, way).norm() > 1e-6 * way.norm(), "synthesis.way", "a way leads along the obstacle's axis");
  }
  const auto outside = [&](const Vector& p) { return across(o, p - o.center).norm() > o.radius; };
  bool clear = outside(e.start);
  for (const auto* holes : {&e.holes, &e.new_holes}) {
    for (const Hole& hole : *holes) clear = clear && outside(hole.position);
  }
  require(clear, "synthesis.end_in_obstacle", "the start or a hole lies inside the obstacle");
}

Vector bump_sizes_unchecked(const Experiment& e, const Vector& g) {
  const auto D = e.start.size();
  Vector A = Vector::Zero(D);
  const Vector u = e.origin.size() > 0 ? Vector(g - e.origin) : g;
  for (std::size_t d = 0; d < e.bumps.size(); ++d) {
    const Bump& b = e.bumps[d];
    double size = b.constant;
    if (b.linear.size() > 0) size += b.linear.dot(u);
    if (b.quadratic.size() > 0) size += u.dot(b.quadratic * u);
    for (const SineTerm& term : b.sines) size += term.amplitude * std::sin(term.rates.dot(u) + term.phase);
    for (const GaussianTerm& term : b.gaussians) {
      size += term.amplitude * std::exp(-0.5 * (g - term.center).squaredNorm() / (term.width * term.width));
    }
    A[static_cast<Index>(d)] = size;
  }
  return A;
}

/// The intention at one phase without the berth.
Vector without_berth(const Experiment& e, const Vector& g, const Vector& A, double s) {
  Vector y = e.start + minimum_jerk(s) * (g - e.start);
  for (std::size_t d = 0; d < e.bumps.size(); ++d) {
    y[static_cast<Index>(d)] += A[static_cast<Index>(d)] * bump(s, e.bumps[d].exponent);
  }
  if (e.approach.offset.size() > 0) y += bump(s, e.approach.exponent) * e.approach.offset;
  return y;
}

double berth_unchecked(const Experiment& e, const Vector& g, const Vector& A, const Vector& w) {
  const Obstacle& o = *e.obstacle;
  const double R = o.radius + o.clearance;
  Vector x = Vector::Zero(berth_phases);
  for (Index k = 0; k < berth_phases; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(berth_phases - 1);
    const double b = bump(s, o.exponent);
    if (b < least_bump) continue;
    const Vector r = across(o, without_berth(e, g, A, s) - o.center);
    const double along = r.dot(w);
    const double rho = (r - along * w).norm();
    // sqrt(R^2 - rho^2) <= R exp(-rho^2 / 2 R^2): smooth, and no less than the half chord that has to be passed.
    const double half_chord = R * std::exp(-0.5 * rho * rho / (R * R));
    const double beside = std::max(rho - R, 0.0) / (0.5 * R);
    x[k] = std::exp(-0.5 * beside * beside) * softplus(half_chord - along, o.softness) / b;
  }
  const double largest = x.maxCoeff();
  if (!(largest > 0)) return 0;
  return largest * std::pow((x / largest).array().pow(berth_norm).sum(), 1 / berth_norm);
}

Vector way_across(const Experiment& e, std::size_t way) {
  require(way < e.obstacle->ways.size(), "synthesis.value", fmt::format("the obstacle has no way {}", way));
  return across(*e.obstacle, e.obstacle->ways[way]).normalized();
}

Samples intention_unchecked(const Experiment& e, const Vector& g, const Vector& phases, std::size_t way) {
  const Vector A = bump_sizes_unchecked(e, g);
  const Vector w = e.obstacle ? way_across(e, way) : Vector::Zero(e.start.size());
  const double B = e.obstacle ? berth_unchecked(e, g, A, w) : 0;
  Samples y(phases.size(), e.start.size());
  for (Index k = 0; k < phases.size(); ++k) {
    const double s = phases[k];
    if (s == 0) {
      y.row(k) = e.start.transpose();
    } else if (s == 1) {
      y.row(k) = g.transpose();
    } else {
      y.row(k) = (without_berth(e, g, A, s) + B * (e.obstacle ? bump(s, e.obstacle->exponent) : 0.0) * w).transpose();
    }
  }
  return y;
}

std::size_t way_of(const Experiment& e, const Random& stream) {
  return e.obstacle ? static_cast<std::size_t>(stream.split(way_stream).below(e.obstacle->ways.size())) : 0;
}

Trajectory demonstrate(const Experiment& e, const Hole& hole, const Random& stream) {
  const std::size_t way = way_of(e, stream);
  const auto meant = [&](const Vector& phases) { return intention_unchecked(e, hole.position, phases, way); };
  return perform(meant, e.duration_mean, e.rate, e.noise, stream);
}

}  // namespace

Trajectory perform(const std::function<Samples(const Vector&)>& meant, double mean, double rate,
                   const TeacherNoise& noise, const Random& stream) {
  const double duration =
      std::clamp(mean + noise.duration_sd * stream.split(duration_stream).normal(), mean / 3, 3 * mean);
  const Index T = std::max<Index>(std::lround(duration * rate), 2) + 1;
  const Vector s = linspace(0, 1, T);
  const double c = std::clamp(noise.tempo_sd * stream.split(tempo_stream).normal(), -latest_tempo, latest_tempo);
  Vector phase = (s.array() + c * (pi * s.array()).sin()).min(1.0).max(0.0);
  phase[T - 1] = 1;  // sin(pi) rounds to a little more than zero
  Trajectory out{s * (static_cast<double>(T - 1) / rate), meant(phase)};
  Random wander = stream.split(wander_stream);
  Random tremor = stream.split(tremor_stream);
  const Index D = out.positions.cols();
  for (Index d = 0; d < D; ++d) {
    for (Index k = 0; k < noise.wander_sd.size(); ++k) {
      const double amplitude = noise.wander_sd[k] * wander.normal();
      const auto half_waves = static_cast<double>(k + 1);
      for (Index i = 1; i + 1 < T; ++i) out.positions(i, d) += amplitude * std::sin(half_waves * pi * s[i]);
    }
  }
  for (Index i = 1; i + 1 < T; ++i) {
    for (Index d = 0; d < D; ++d) out.positions(i, d) += noise.tremor_sd * tremor.normal();
  }
  return out;
}

Vector TeacherNoise::default_wander() {
  return (Vector(2) << 0.006, 0.004).finished();
}

void check(const Experiment& experiment) {
  const auto D = static_cast<Index>(experiment.columns.size());
  require(D > 0, "synthesis.shape", "an experiment needs at least one signal");
  require_vector(experiment.start, D, false, "start");
  require_vector(experiment.origin, D, true, "origin");
  require(!experiment.holes.empty(), "synthesis.no_holes", "an experiment needs at least one hole");
  std::vector<std::string> names;
  for (const auto* holes : {&experiment.holes, &experiment.new_holes}) {
    for (const Hole& hole : *holes) {
      require_vector(hole.position, D, false, "hole " + hole.target);
      names.push_back(hole.target);
    }
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  require(twice == names.end(), "synthesis.repeated_target", "two holes have one name");
  require(experiment.repetitions >= 1, "synthesis.value", "repetitions is not at least 1");
  require_positive(experiment.duration_mean, "duration_mean");
  require_positive(experiment.rate, "rate");
  require(experiment.duration_mean * experiment.rate < 1e7, "synthesis.value", "a demonstration has too many samples");
  require_size(experiment.noise.duration_sd, "duration_sd");
  require_size(experiment.noise.tempo_sd, "tempo_sd");
  require_size(experiment.noise.tremor_sd, "tremor_sd");
  require_vector(experiment.noise.wander_sd, experiment.noise.wander_sd.size(), true, "wander_sd");
  require((experiment.noise.wander_sd.array() >= 0).all(), "synthesis.value", "wander_sd has a negative value");
  require(experiment.bumps.empty() || static_cast<Index>(experiment.bumps.size()) == D, "synthesis.shape",
          fmt::format("there are {} bumps for {} signals", experiment.bumps.size(), D));
  for (std::size_t d = 0; d < experiment.bumps.size(); ++d) check_bump(experiment.bumps[d], D, experiment.columns[d]);
  require_vector(experiment.approach.offset, D, true, "the approach's offset");
  require(std::isfinite(experiment.approach.exponent) && experiment.approach.exponent > 0.5, "synthesis.value",
          "the approach's exponent is not over 0.5");
  if (experiment.obstacle) check_obstacle(experiment);
}

Vector bump_sizes(const Experiment& experiment, const Vector& goal) {
  check(experiment);
  require_vector(goal, experiment.start.size(), false, "the goal");
  return bump_sizes_unchecked(experiment, goal);
}

double berth(const Experiment& experiment, const Vector& goal, std::size_t way) {
  const Vector A = bump_sizes(experiment, goal);
  return experiment.obstacle ? berth_unchecked(experiment, goal, A, way_across(experiment, way)) : 0.0;
}

Samples intention(const Experiment& experiment, const Vector& goal, const Vector& phases, std::size_t way) {
  check(experiment);
  require_vector(goal, experiment.start.size(), false, "the goal");
  require((phases.array() >= 0).all() && (phases.array() <= 1).all(), "synthesis.value", "a phase is not in [0, 1]");
  return intention_unchecked(experiment, goal, phases, way);
}

std::size_t way_taken(const Experiment& experiment, const std::string& target, Eigen::Index repetition) {
  check(experiment);
  return way_of(experiment, stream_of(experiment, target, repetition));
}

DemonstrationSet synthesize(const Experiment& experiment) {
  check(experiment);
  DemonstrationSet out{experiment.columns, {}};
  for (const Hole& hole : experiment.holes) {
    for (Index repetition = 1; repetition <= experiment.repetitions; ++repetition) {
      Demonstration demonstration;
      demonstration.labels.target = hole.target;
      demonstration.labels.demo = std::to_string(repetition);
      demonstration.trajectory = demonstrate(experiment, hole, stream_of(experiment, hole.target, repetition));
      out.demonstrations.push_back(std::move(demonstration));
    }
  }
  return out;
}

}  // namespace lfd
