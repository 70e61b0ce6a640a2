#include "lfdtools/posterior.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/dmp_fit.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/gaussian.hpp"

using namespace lfd;

namespace {

const std::vector<std::string> xyz = {"x", "y", "z"};

Vector vec(double x, double y, double z) {
  Vector v(3);
  v << x, y, z;
  return v;
}

/// Two demonstrations of each of nine targets, with a bump that bends with the goal, and a wander of their own.
SkillPredictor some_skill(SkillStructure structure, DmpScaling scaling = DmpScaling::none) {
  Random random(3);
  std::vector<SkillRow> rows;
  const Vector phases = linspace(0, 1, 120);
  for (const double x : {0.2, 0.3, 0.4}) {
    for (const double y : {-0.2, 0.15, 0.3}) {
      for (int demo = 0; demo < 2; ++demo) {
        const Vector goal = vec(x, y, 0.3 - 0.5 * x * y);
        Matrix wander(6, 3);  // of each half-wave and axis [m]
        for (double& value : wander.reshaped()) value = 0.006 * random.normal();
        Samples path(120, 3);
        for (Eigen::Index i = 0; i < 120; ++i) {
          const double s = phases[i];
          const double bump = 64 * std::pow(s * (1 - s), 3);
          path.row(i) = (s * s * s * (10 - 15 * s + 6 * s * s)) * goal.transpose();
          path(i, 2) += bump * (0.05 + x * x);
          path(i, 0) -= bump * 0.1 * y;
          for (Eigen::Index k = 0; k < 6; ++k) {
            path.row(i) += std::sin(3.141592653589793 * static_cast<double>(k + 1) * s) * wander.row(k);
          }
        }
        DmpFitOptions fit;
        fit.bases = 8;
        fit.scaling = scaling;
        rows.push_back(
            {{std::to_string(rows.size() / 2 + 1), {}, std::to_string(demo), {}}, fit_dmp({phases * 2.0, path}, fit)});
      }
    }
  }
  SkillOptions options;
  options.structure = structure;
  options.starts = 2;
  options.kernel = SkillKernel::sum;  // smooth, so that differences mean derivatives
  return SkillPredictor(train_skill(xyz, rows, options));
}

const SkillPredictor& full() {
  static const SkillPredictor predictor = some_skill(SkillStructure::full);
  return predictor;
}
const SkillPredictor& joint() {
  static const SkillPredictor predictor = some_skill(SkillStructure::joint);
  return predictor;
}
const SkillPredictor& scaled() {
  static const SkillPredictor predictor = some_skill(SkillStructure::full, DmpScaling::goal);
  return predictor;
}

Goal some_goal(double tau = 2.0) {
  return {{}, vec(0.33, 0.1, 0.27), {}, tau};
}

Samples positions(const MotionPosterior& posterior, const Vector& times) {
  return rollout(posterior.course, times).positions;
}

/// A via through the mean moved by `offset` at t = 0.9.
Waypoint via_beside(const SkillPredictor& predictor, const Vector& offset, double sd = 0) {
  Vector at(1);
  at << 0.9;
  return {0.9, positions(predict_motion(predictor, some_goal()), at).row(0).transpose() + offset, sd};
}

double distance(const Matrix& a, const Matrix& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("the response matrix is the derivative of the motion with respect to the weights") {
  const Dmp dmp = scaled().primitive(some_goal());
  const Vector times = linspace(0, 2.4, 25);
  const Matrix R = response_matrix(dmp.settings, dmp.tau, times);
  for (const Eigen::Index i : {0, 3, 7}) {
    Dmp above = dmp;
    Dmp below = dmp;
    above.weights(1, i) += 0.5;
    below.weights(1, i) -= 0.5;
    const Vector slope = rollout(above, times).positions.col(1) - rollout(below, times).positions.col(1);
    CHECK((slope - dmp.scale()[1] * R.col(i)).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("the covariance without demands is that of the weights, through R") {
  // Demands none, and rows whose end is not the goal: nothing is conditioned.
  Skill skill = full().skill();
  for (auto& model : skill.models) model.process.Y.array() += 0.01;
  const SkillPredictor predictor(skill);
  const MotionPosterior posterior = predict_motion(predictor, some_goal());
  REQUIRE_FALSE(posterior.ends_on_goal);
  const Vector times = linspace(0, 2, 21);
  const Matrix R = response_matrix(skill.dmp, 2, times);
  const auto latent = motion_covariance(posterior, times, Spread::latent);
  const auto predictive = motion_covariance(posterior, times, Spread::predictive);
  for (std::size_t m = 0; m < 3; ++m) {
    const MvgpModel& process = skill.models[m].process;
    const MvgpPrediction row = predictor.processes()[m].predict(some_goal().position - skill.start);
    const MvgpPredictor own(process);
    const Matrix expected = R * own.weight_covariance(row.variance) * R.transpose();
    CHECK(distance(latent[m], expected) < 1e-9 * expected.cwiseAbs().maxCoeff());
    const Matrix noisy = R * own.weight_covariance(row.variance + process.noise_variance) * R.transpose();
    CHECK(distance(predictive[m], noisy) < 1e-9 * noisy.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("standard deviations are the diagonal of the covariance, latent never over predictive, none at the end") {
  const Vector times = linspace(0, 2, 41);
  for (const auto* predictor : {&full(), &joint(), &scaled()}) {
    MotionConstraints via;
    via.via.push_back(via_beside(*predictor, vec(0.01, -0.02, 0.01), 0.004));
    for (const auto& constraints : {MotionConstraints(), via}) {
      const MotionPosterior posterior = predict_motion(*predictor, some_goal(), constraints);
      for (const auto spread : {Spread::latent, Spread::predictive}) {
        const Samples sd = standard_deviation(posterior, times, spread);
        const auto covariance = motion_covariance(posterior, times, spread);
        for (Eigen::Index j = 0; j < 3; ++j) {
          const Vector variance = covariance.size() == 1 ? Vector(covariance[0].diagonal().segment(41 * j, 41))
                                                         : Vector(covariance[static_cast<std::size_t>(j)].diagonal());
          CHECK(distance(sd.col(j).array().square(), variance) < 1e-15);
        }
        REQUIRE(posterior.ends_on_goal);
        CHECK(sd.row(40).maxCoeff() < 1e-9);
        CHECK(sd.maxCoeff() > 1e-4);
      }
      CHECK((standard_deviation(posterior, times, Spread::predictive) -
             standard_deviation(posterior, times, Spread::latent))
                .minCoeff() >= 0);
      CHECK((positions(posterior, times).row(40).transpose() - some_goal().position).norm() < 1e-9);
    }
  }
}

TEST_CASE("draws have the mean and the covariance, and meet the end") {
  const Vector times = linspace(0, 2, 9);
  for (const auto* predictor : {&full(), &joint()}) {
    const MotionPosterior posterior = predict_motion(*predictor, some_goal());
    const Matrix R = response_matrix(predictor->skill().dmp, 2, times);
    const Dmp& mean = posterior.course.primitive;
    for (const auto spread : {Spread::latent, Spread::predictive}) {
      constexpr int draws = 100000;
      const Random random(7);
      Vector sum = Vector::Zero(27);
      Matrix squares = Matrix::Zero(27, 27);
      for (int i = 0; i < draws; ++i) {
        Random own = random.split(static_cast<std::uint64_t>(i));
        const Matrix deviation = R * (draw(posterior, spread, own).primitive.weights - mean.weights).transpose();
        const Vector y = deviation.reshaped();
        sum += y / draws;
        squares += y * y.transpose() / draws;
      }
      const auto covariance = motion_covariance(posterior, times, spread);
      Matrix expected = Matrix::Zero(27, 27);
      if (covariance.size() == 1) {
        expected = covariance[0];
      } else {
        for (Eigen::Index j = 0; j < 3; ++j)
          expected.block(9 * j, 9 * j, 9, 9) = covariance[static_cast<std::size_t>(j)];
      }
      // Standard errors: of a mean sd / sqrt(n), of a covariance under sd sd (2 + excess)^(1/2) / sqrt(n).
      const Vector sd = expected.diagonal().cwiseSqrt();
      const double unit = 5 / std::sqrt(static_cast<double>(draws));
      CHECK((sum.array().abs() <= unit * sd.array() + 1e-12).all());
      CHECK(((squares - expected).array().abs() <= (2 * unit * sd * sd.transpose()).array() + 1e-14).all());
    }
    Random random(1);
    const Course sample = draw(posterior, Spread::predictive, random);
    CHECK((rollout(sample, linspace(0, 2, 2)).positions.row(1).transpose() - some_goal().position).norm() < 1e-9);
  }
}

TEST_CASE("conditioning is that of a Student-t, and of a Gaussian where there are infinite degrees of freedom") {
  for (const bool gaussian : {false, true}) {
    for (const double sd : {0.0, 0.003}) {
      Skill skill = joint().skill();
      for (auto& model : skill.models) {
        if (gaussian) model.process.omega_rule = OmegaRule::ml;
        model.process.output_transform = Matrix();  // a benign metric, so that brute force is exact enough
        model.process.omega.diagonal().array() += 0.1 * model.process.omega.diagonal().maxCoeff();
      }
      const SkillPredictor predictor(skill);
      const Vector x = some_goal().position - skill.start;
      const MvgpPrediction row = predictor.processes()[0].predict(x);
      MotionConstraints constraints;
      constraints.via.push_back(via_beside(predictor, vec(0.02, 0, -0.03), sd));
      constraints.end_velocity = vec(0, 0, 0);
      const MotionPosterior posterior = predict_motion(predictor, some_goal(), constraints);

      // Brute force on the weights, 24 of them: end, velocity at the end, via.
      const Matrix C = MvgpPredictor(skill.models[0].process).weight_covariance(row.variance);
      Vector at(2);
      at << 0.9, 2.0;
      const DmpResponse R = response(skill.dmp, 2, at);
      const Motion before = rollout(predictor.primitive(some_goal()), at);
      Matrix H = Matrix::Zero(9, 24);
      Vector e(9);
      Matrix S = Matrix::Zero(9, 9);
      for (Eigen::Index j = 0; j < 3; ++j) {
        H.block(3 * j, 8 * j, 1, 8) = R.position.row(0);
        H.block(3 * j + 1, 8 * j, 1, 8) = R.position.row(1);
        H.block(3 * j + 2, 8 * j, 1, 8) = R.velocity.row(1);
        e[3 * j] = constraints.via[0].position[j] - before.positions(0, j);
        e[3 * j + 1] = some_goal().position[j] - before.positions(1, j);
        e[3 * j + 2] = -before.velocities(1, j);
        S(3 * j, 3 * j) = sd * sd;
      }
      const Matrix M = (H * C * H.transpose() + S).inverse();
      const Vector w = C * H.transpose() * M * e;
      const double delta = e.dot(M * e);
      const double nu = row.degrees_of_freedom;
      const double c = gaussian ? 1.0 : (nu - 2 + delta) / (nu + 9 - 2);
      const Matrix expected = c * (C - C * H.transpose() * M * H * C);
      const Matrix mean = posterior.course.primitive.weights - predictor.primitive(some_goal()).weights;
      const double size = C.cwiseAbs().maxCoeff();
      CHECK(distance(mean.transpose().reshaped(), w) < 1e-7 * (1 + w.norm()));
      // The projections keep digits that brute force cancels: the bound is that of the latter.
      CHECK(distance(posterior.blocks[0].latent * posterior.blocks[0].latent.transpose(), expected) / size < 1e-6);
      CHECK(posterior.distance == Approx(std::sqrt(delta)).epsilon(1e-6));
      if (!gaussian) CHECK(posterior.blocks[0].degrees_of_freedom == nu + 9);
    }
  }
}

TEST_CASE("a point to pass is met to 1e-9 m with the end exact, by the smallest change there is") {
  for (const auto* predictor : {&full(), &joint(), &scaled()}) {
    MotionConstraints constraints;
    constraints.via.push_back(via_beside(*predictor, vec(0.02, -0.01, 0.03)));
    constraints.via.push_back({1.4, vec(0.28, 0.08, 0.31), 0});
    constraints.start_velocity = vec(0.05, 0, -0.02);
    constraints.end_velocity = vec(0, 0, -0.1);
    const MotionPosterior posterior = predict_motion(*predictor, some_goal(), constraints);
    Vector at(4);
    at << 0, 0.9, 1.4, 2.0;
    const Motion motion = rollout(posterior.course, at);
    CHECK((motion.velocities.row(0).transpose() - *constraints.start_velocity).norm() < 1e-12);
    CHECK((motion.positions.row(1).transpose() - constraints.via[0].position).norm() < 1e-9);
    CHECK((motion.positions.row(2).transpose() - constraints.via[1].position).norm() < 1e-9);
    CHECK((motion.positions.row(3).transpose() - some_goal().position).norm() < 1e-9);
    CHECK((motion.velocities.row(3).transpose() - *constraints.end_velocity).norm() < 1e-8);
    CHECK(posterior.distance > 0.1);

    // Karush-Kuhn-Tucker system of: least u^T u with G u = e, u the deviation in the factor's coordinates.
    const MotionPosterior start = predict_motion(*predictor, some_goal());
    const Vector two = at.tail(3);
    const DmpResponse R = response(predictor->skill().dmp, 2, two);
    Course before = start.course;
    before.start_velocity = *constraints.start_velocity;
    const Motion was = rollout(before, two);
    double delta = 0;
    for (std::size_t b = 0; b < start.blocks.size(); ++b) {
      // The unconditioned factor again, from the skill: k^ Omega.
      const auto& outputs = start.blocks[b].outputs;
      const Eigen::Index q = static_cast<Eigen::Index>(outputs.size());
      const SkillModel& model = predictor->skill().models[b];
      const double variance =
          predictor->processes()[b].predict(some_goal().position - predictor->skill().start).variance;
      Matrix F = std::sqrt(variance) * cholesky(model.process.omega);
      F = Matrix(model.process.output_transform.transpose()).fullPivLu().solve(F);
      Matrix H = Matrix::Zero(4 * q, 8 * q);
      Vector e(4 * q);
      for (Eigen::Index p = 0; p < q; ++p) {
        const int j = outputs[static_cast<std::size_t>(p)];
        const double s = start.course.primitive.scale()[j];
        H.block(4 * p, 8 * p, 3, 8) = s * R.position;
        H.block(4 * p + 3, 8 * p, 1, 8) = s * R.velocity.row(2);
        for (Eigen::Index i = 0; i < 3; ++i) e[4 * p + i] = motion.positions(i + 1, j) - was.positions(i, j);
        e[4 * p + 3] = motion.velocities(3, j) - was.velocities(2, j);
      }
      const Matrix G = H * F;
      Matrix kkt = Matrix::Zero(12 * q, 12 * q);
      kkt << Matrix::Identity(8 * q, 8 * q), G.transpose(), G, Matrix::Zero(4 * q, 4 * q);
      Vector right = Vector::Zero(12 * q);
      right.tail(4 * q) = e;
      const Vector u = kkt.fullPivLu().solve(right).head(8 * q);
      const Vector w = F * u;
      delta += u.squaredNorm();
      for (Eigen::Index p = 0; p < q; ++p) {
        const int j = outputs[static_cast<std::size_t>(p)];
        const Vector change =
            (posterior.course.primitive.weights.row(j) - start.course.primitive.weights.row(j)).transpose();
        const Matrix Rt = response_matrix(predictor->skill().dmp, 2, linspace(0, 2, 51));
        CHECK(distance(Rt * change, Rt * w.segment(8 * p, 8)) * std::abs(start.course.primitive.scale()[j]) < 1e-8);
      }
    }
    CHECK(posterior.distance == Approx(std::sqrt(delta)).epsilon(1e-5));
  }
}

TEST_CASE("demands that cannot be met are refused") {
  MotionConstraints twice;
  twice.via.push_back(via_beside(full(), vec(0.01, 0, 0)));
  twice.via.push_back(via_beside(full(), vec(0.02, 0, 0)));
  CHECK_THROWS_AS(predict_motion(full(), some_goal(), twice), DataError);
  twice.via[1] = twice.via[0];
  CHECK_NOTHROW(predict_motion(full(), some_goal(), twice));
  // An axis that the goal scales by nothing cannot move.
  Goal flat = some_goal();
  flat.start = vec(0, 0, flat.position[2]);
  MotionConstraints up;
  up.via.push_back({1.0, vec(0.15, 0.05, flat.position[2] + 0.01), 0});
  CHECK_THROWS_AS(predict_motion(scaled(), flat, up), DataError);
  MotionConstraints late;
  late.via.push_back({2.0, vec(0.15, 0.05, 0), 0});
  CHECK_THROWS_AS(predict_motion(full(), some_goal(), late), DataError);
  late.via[0].time = 0;
  CHECK_THROWS_AS(predict_motion(full(), some_goal(), late), DataError);
}

TEST_CASE("a motion of another duration is the same motion on another clock") {
  MotionConstraints slow;
  slow.via.push_back(via_beside(full(), vec(0.02, 0, 0.01)));
  MotionConstraints fast = slow;
  fast.via[0].time /= 4;
  const MotionPosterior a = predict_motion(full(), some_goal(2.0), slow);
  const MotionPosterior b = predict_motion(full(), some_goal(0.5), fast);
  CHECK(distance(positions(a, linspace(0, 2.4, 49)), positions(b, linspace(0, 0.6, 49))) < 1e-12);
  CHECK(distance(standard_deviation(a, linspace(0, 2, 41), Spread::latent),
                 standard_deviation(b, linspace(0, 0.5, 41), Spread::latent)) < 1e-12);
}

TEST_CASE("bands are quantiles of Student's t, and the path band holds whole paths") {
  const Vector times = linspace(0, 2, 41);
  const MotionPosterior posterior = predict_motion(full(), some_goal());
  const Samples sd = standard_deviation(posterior, times, Spread::latent);
  const Samples point = band(posterior, times, BandKind::pointwise);
  const double nu = posterior.blocks[1].degrees_of_freedom;
  CHECK(point(20, 1) == Approx(student_t_quantile(0.975, nu) * std::sqrt((nu - 2) / nu) * sd(20, 1)));
  const Samples path = band(posterior, times, BandKind::path);
  CHECK((path - point).minCoeff() >= 0);
  int inside = 0;
  int inside_at_once = 0;
  const Matrix R = response_matrix(full().skill().dmp, 2, times);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    Random random = Random(11).split(i);
    const Course sample = draw(posterior, Spread::latent, random);
    const Matrix off = R * (sample.primitive.weights - posterior.course.primitive.weights).transpose();
    inside += (off.array().abs() <= path.array() + 1e-9).all() ? 1 : 0;
    inside_at_once += std::abs(off(20, 1)) <= point(20, 1) ? 1 : 0;
  }
  CHECK(inside / 5000.0 == Approx(0.95).margin(0.012));
  CHECK(inside_at_once / 5000.0 == Approx(0.95).margin(0.012));
}

TEST_CASE("the band of a motion is the calibration's where there is one, and narrows with demands") {
  const Vector times = linspace(0, 2, 41);
  const MotionPosterior plain = predict_motion(full(), some_goal());
  CHECK(motion_band(full(), plain, times, BandKind::pointwise) == band(plain, times, BandKind::pointwise));
  Skill skill = full().skill();
  skill.calibration = Calibration{
      9, Vector::Constant(3, 0.01), Vector::Constant(3, 1e-4), linspace(0.5, 0.95, 2), Vector(2), Vector(2)};
  skill.calibration->pointwise << 0.8, 2.4;
  skill.calibration->path << 1.5, 3.0;
  const SkillPredictor calibrated(skill);
  const Vector change = some_goal().position - skill.start;
  for (const auto kind : {BandKind::pointwise, BandKind::path}) {
    const Samples half = motion_band(calibrated, plain, times, kind);
    CHECK(half == band(calibrated, change, times / 2.0, kind));
    MotionConstraints via;
    via.via.push_back(via_beside(calibrated, vec(0, 0, 0)));
    const Samples narrow = motion_band(calibrated, predict_motion(calibrated, some_goal(), via), times, kind);
    CHECK(narrow.row(18).maxCoeff() < 1e-9);
    CHECK((half - narrow).minCoeff() > -1e-12);
    CHECK(narrow.maxCoeff() > 1e-3);
  }
}

TEST_CASE("a goal that is not exactly known spreads the motion: at the end as itself, at the start not at all") {
  MotionConstraints via;
  via.via.push_back(via_beside(full(), vec(0.002, 0, 0.001)));
  const Vector times = linspace(0, 2, 21);
  Goal goal = some_goal();
  CHECK(goal_spread(full(), goal, {}, times).factors.empty());
  goal.covariance = Matrix::Zero(3, 3);
  goal.covariance(0, 0) = 4e-6;
  goal.covariance(0, 1) = goal.covariance(1, 0) = 1e-6;
  goal.covariance(1, 1) = 1e-6;  // the third signal is exactly known
  for (const auto& constraints : {MotionConstraints(), via}) {
    const GoalSpread spread = goal_spread(full(), goal, constraints, times);
    const Samples variance = spread.variance(Samples::Zero(21, 3));
    CHECK(variance.row(0).maxCoeff() < 1e-15);
    Matrix end(3, 3);
    for (Eigen::Index j = 0; j < 3; ++j) end.row(j) = spread.factors[static_cast<std::size_t>(j)].row(20);
    CHECK(distance(end * end.transpose(), goal.covariance) < 1e-10);
    if (constraints.empty()) continue;
    CHECK(variance.row(9).maxCoeff() < 1e-15);  // the point to pass stays where it is
  }
  // Many goals drawn from that distribution: the spread of their motions.
  const GoalSpread spread = goal_spread(full(), goal, {}, times);
  const Samples variance = spread.variance(Samples::Zero(21, 3));
  const Matrix L = cholesky(goal.covariance + 1e-18 * Matrix::Identity(3, 3));
  const Samples mean = positions(predict_motion(full(), some_goal()), times);
  Samples squares = Samples::Zero(21, 3);
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    Goal drawn = some_goal();
    drawn.position += L * vec(random.normal(), random.normal(), random.normal());
    squares.array() += (positions(predict_motion(full(), drawn), times) - mean).array().square() / 2000;
  }
  CHECK(distance(squares, variance) < 0.15 * variance.maxCoeff());
}

TEST_CASE("Student's t has the quantiles of the tables") {
  CHECK(student_t_quantile(0.975, 4) == Approx(2.7764451051977987).epsilon(1e-12));
  CHECK(student_t_quantile(0.975, 21) == Approx(2.0796138447276626).epsilon(1e-12));
  CHECK(student_t_quantile(0.95, 9.5) == Approx(1.8216).epsilon(1e-3));
}
