#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "lfdtools/error.hpp"
#include "lfdtools/posterior.hpp"
#include "posterior_fixture.hpp"

using namespace lfd;

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
