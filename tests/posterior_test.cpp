#include "lfdtools/posterior.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/gaussian.hpp"
#include "posterior_fixture.hpp"

using namespace lfd;

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
