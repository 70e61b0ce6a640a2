#include "lfdtools/ur10.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "arm_fixture.hpp"
#include "lfdtools/error.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

constexpr double pi = std::numbers::pi;

double apart(const Joints& a, const Joints& b) {
  double largest = 0.0;
  for (int j = 0; j < 6; ++j) largest = std::max(largest, std::abs(std::remainder(a[j] - b[j], 2.0 * pi)));
  return largest;
}

/// What went wrong over many poses.
struct Tally {
  double worst_residual = 0.0;  // by forward kinematics of the robot's own rows
  double worst_original = 0.0;  // distance of the joints the pose came from to the nearest solution
  int unsolved = 0;
  int twins = 0;
  int bad_angles = 0;  // not finite or outside (-pi, pi]
  int wrong_order = 0;
  double clear_wrist = 1e-4;  // |sin q5| and |sin q3| from which the original joints must be found
  double clear_elbow = 0.0;
  std::array<int, 9> count{};

  void add(const InverseKinematics& arm, const Joints& q, const IkOptions& options = {}) {
    const double nearest = add_pose(arm, forward_kinematics(arm.robot(), q), options, &q);
    if (std::abs(std::sin(q[4])) > clear_wrist && std::abs(std::sin(q[2])) >= clear_elbow) {
      worst_original = std::max(worst_original, nearest);
    }
  }

  double add_pose(const InverseKinematics& arm, const Pose& pose, const IkOptions& options, const Joints* original) {
    const IkSolutions found = arm(pose, options);
    double nearest = 10.0;
    ++count[found.size()];
    if (found.empty()) ++unsolved;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Joints& q = found[i].joints;
      for (const double angle : q) bad_angles += angle > -pi && angle <= pi ? 0 : 1;
      worst_residual = std::max(worst_residual, distance(forward_kinematics(arm.robot(), q), pose).largest());
      if (original != nullptr) nearest = std::min(nearest, apart(q, *original));
      for (std::size_t k = 0; k < i; ++k) twins += apart(q, found[k].joints) < 2e-7 ? 1 : 0;
      if (i > 0 && found[i].branch <= found[i - 1].branch) ++wrong_order;
    }
    return nearest;
  }
};

void require_right(const Tally& tally, double original = 1e-6) {
  CHECK(tally.worst_residual < 1e-9);
  CHECK(tally.worst_original < original);
  CHECK(tally.unsolved == 0);
  CHECK(tally.twins == 0);
  CHECK(tally.bad_angles == 0);
  CHECK(tally.wrong_order == 0);
}

}  // namespace

TEST_CASE("a million random poses are solved, each solution verified, the original among them") {
  const InverseKinematics arm(nominal_ur10());
  Random random(1);
  Tally tally;
  constexpr int poses = 1'000'000;
  for (int i = 0; i < poses; ++i) tally.add(arm, random_joints(random));
  require_right(tally);
  CHECK(tally.worst_residual < 1e-12);
  const auto share = [&](std::size_t n) { return static_cast<double>(tally.count[n]) / poses; };
  CHECK(share(8) == Approx(0.791).margin(0.002));
  CHECK(share(6) == Approx(0.048).margin(0.002));
  CHECK(share(4) == Approx(0.134).margin(0.002));
  CHECK(share(2) == Approx(0.026).margin(0.001));
}

TEST_CASE("poses at and near every singularity are solved without twins") {
  const Robot robot = GENERATE(nominal_ur10(), nominal_ur10e());
  const InverseKinematics arm(robot);
  const UrGeometry g = ur_geometry(robot);
  Random random(2);
  for (const int kind : {0, 1, 2, 3, 4}) {
    Tally tally;
    // An angle near its double root is known to 3e-7, and a second near-singularity multiplies that.
    tally.clear_wrist = 0.1;
    tally.clear_elbow = kind == 4 ? 0.1 : 0.0;
    for (int exponent = 2; exponent <= 18; ++exponent) {
      for (int i = 0; i < 6000; ++i) {
        const double offset = exponent > 17 ? 0.0 : (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, -exponent);
        Joints q = random_joints(random);
        if (kind == 0) q[4] = offset;
        if (kind == 1) q[4] = pi + offset;
        if (kind == 2) q[2] = offset;
        if (kind == 3) q[2] = pi + offset;
        if (kind == 4) {  // wrist centre above or below the shoulder: a2 c2 + a3 c23 + d5 s234 = offset
          const double rest = offset - g.a2 * std::cos(q[1]) - g.a3 * std::cos(q[1] + q[2]);
          if (std::abs(rest) > g.d5) {
            --i;
            continue;
          }
          q[3] = std::asin(rest / g.d5) - q[1] - q[2];
        }
        tally.add(arm, q);
      }
    }
    INFO("kind " << kind);
    // Folded, the shoulder turns a3 / (a2 - a3), 15 times as far as the elbow.
    require_right(tally, kind == 3 ? 1e-5 : 2e-6);
  }
}

TEST_CASE("axis-aligned poses and joints at multiples of a right angle") {
  const InverseKinematics arm(nominal_ur10());
  Tally tally;
  for (int code = 0; code < 4096; ++code) {
    Joints q;
    for (int j = 0, rest = code; j < 6; ++j, rest /= 4) q[j] = (rest % 4) * pi / 2.0;
    tally.add(arm, q);
  }
  require_right(tally);

  // Exact zeros and ones in the rotation, exact positions; not all of these are within reach.
  Tally exact;
  for (const double x : {-0.9, 0.0, 0.163941, 0.4, 1.0}) {
    for (const double y : {-0.6, 0.0, 0.163941, 0.5}) {
      for (const double z : {-0.2, 0.0, 0.0351, 0.2195, 0.6}) {
        for (int turn = 0; turn < 64; ++turn) {
          const Vector3 rpy = Vector3((turn % 4) * pi / 2.0, (turn / 4 % 4) * pi / 2.0, (turn / 16) * pi / 2.0);
          Pose pose{rotation_from_rpy(rpy), Vector3(x, y, z)};
          pose.rotation = pose.rotation.array().round().matrix();
          exact.add_pose(arm, pose, {}, nullptr);
        }
      }
    }
  }
  CHECK(exact.worst_residual < 1e-9);
  CHECK(exact.twins == 0);
  CHECK(exact.bad_angles == 0);
  CHECK(exact.count[8] > 1000);
}

TEST_CASE("Newton steps from random starts find no solution that the closed form has not") {
  const InverseKinematics arm(nominal_ur10());
  Random random(3);
  int checked = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose pose = forward_kinematics(arm.robot(), random_joints(random));
    const IkSolutions found = arm(pose);
    std::set<int> hit;
    for (int start = 0; start < 60; ++start) {
      const auto newton = refine(arm.robot(), pose, random_joints(random), 1e-11);
      if (!newton) continue;
      double nearest = 10.0;
      for (const IkSolution& s : found) {
        if (apart(s.joints, newton->joints) < nearest) nearest = apart(s.joints, newton->joints);
        if (apart(s.joints, newton->joints) < 1e-5) hit.insert(s.branch);
      }
      CHECK(nearest < 1e-5);
    }
    checked += static_cast<int>(hit.size());
  }
  CHECK(checked > 200);
}

TEST_CASE("a singular wrist takes the q6 nearest to the seed for which the elbow closes") {
  const InverseKinematics arm(nominal_ur10());
  Random random(4);
  int moved = 0;
  for (int i = 0; i < 2000; ++i) {
    Joints q = random_joints(random);
    q[4] = i % 2 == 0 ? 0.0 : pi;
    if (i % 4 < 2) q[2] = random.uniform(-0.15, 0.15);  // near the edge of reach, where not every q6 will do
    const Pose pose = forward_kinematics(arm.robot(), q);
    IkOptions own;
    own.seed = q;
    double nearest = 10.0;
    for (const IkSolution& s : arm(pose, own)) nearest = std::min(nearest, apart(s.joints, q));
    CHECK(nearest < 1e-6);

    IkOptions other;
    other.seed = random_joints(random);
    const IkSolutions found = arm(pose, other);
    REQUIRE(!found.empty());
    CHECK(std::any_of(found.begin(), found.end(), [](const IkSolution& s) { return s.wrist_free; }));
    for (const IkSolution& s : found) {
      if (!s.wrist_free) continue;  // on the other shoulder the wrist is an ordinary one
      CHECK(distance(forward_kinematics(arm.robot(), s.joints), pose).largest() < 1e-9);
      const double off = std::abs(std::remainder(s.joints[5] - (*other.seed)[5], 2.0 * pi));
      if (off < 1e-12) continue;
      // Not the seed's own value: then a hair nearer to it no solution may exist for this shoulder.
      ++moved;
      CHECK(std::abs(std::sin(s.joints[2])) < 1e-6);
      Joints nearer = *other.seed;
      nearer[5] = s.joints[5] + 1e-3 * std::copysign(1.0, std::remainder((*other.seed)[5] - s.joints[5], 2.0 * pi));
      IkOptions probe;
      probe.seed = nearer;
      for (const IkSolution& t : arm(pose, probe)) {
        if (!t.wrist_free || (t.branch & 4) != (s.branch & 4)) continue;
        CHECK(std::abs(std::remainder(t.joints[5] - s.joints[5], 2.0 * pi)) < 1e-6);
      }
    }
  }
  CHECK(moved > 100);
}

TEST_CASE("words for a pose out of reach say what is true of it, and of no pose that is reached") {
  const InverseKinematics arm(nominal_ur10());
  const UrGeometry& g = arm.geometry();
  Random random(11);
  int far = 0, near = 0, turned = 0;
  for (int i = 0; i < 2000; ++i) {
    Joints q;
    for (int j = 0; j < 6; ++j) q[j] = random.uniform(-pi, pi);
    Pose pose = forward_kinematics(arm.robot(), q);
    CHECK(out_of_reach_words(g, pose).find("elbow") != std::string::npos);
    for (int k = 0; k < 3; ++k) pose.position[k] = random.uniform(-1.5, 1.5);
    if (!arm(pose).empty()) continue;
    const std::string words = out_of_reach_words(g, pose);
    far += words.find("from the shoulder") != std::string::npos ? 1 : 0;
    near += words.find("from the axis") != std::string::npos ? 1 : 0;
    turned += words.find("elbow") != std::string::npos ? 1 : 0;
  }
  CHECK(far > 100);
  CHECK(near > 10);
  CHECK(turned > 10);
  Pose beyond;
  beyond.position << 2.0, 0.0, g.d1 + g.d6;  // the hand points up, so its wrist is 2 m away at the shoulder's height
  CHECK(out_of_reach_words(g, beyond) == "the wrist is 2.000 m from the shoulder, 690 mm more than the arm is long");
}

TEST_CASE("branches follow the signs they name, and poses out of reach have no solution") {
  const InverseKinematics arm(nominal_ur10());
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    for (const IkSolution& s : arm(forward_kinematics(arm.robot(), random_joints(random)))) {
      CHECK(s.branch == arm.branch(s.joints));
    }
  }
  CHECK(branch_name(0) == "left-wrist+-elbow+");
  CHECK(branch_name(7) == "right-wrist--elbow-");

  Pose pose;
  pose.position << 2.0, 0.0, 0.0;
  CHECK(arm(pose).empty());
  pose.position << 0.0, 0.0, 0.5;  // inside the cylinder round the base axis
  pose.rotation = rotation_from_rpy(Vector3(pi, 0.0, 0.0));
  CHECK(arm(pose).empty());
  // The stretched arm, moved out by less and by more than the tolerance.
  Joints stretched;
  stretched << 0.3, -0.7, 0.0, -0.4, 0.9, 0.2;
  Pose edge = forward_kinematics(arm.robot(), stretched);
  const Vector3 out =
      joint_frames(arm.robot(), stretched)[3].position - joint_frames(arm.robot(), stretched)[1].position;
  edge.position += 5e-10 * out.normalized();
  CHECK(arm(edge).size() > 0);
  const std::size_t with_edge = arm(edge).size();
  edge.position += 2e-9 * out.normalized();
  CHECK(arm(edge).size() == with_edge - 1);

  Pose skewed;
  skewed.rotation(0, 1) = 1e-6;
  CHECK_THROWS_AS(arm(skewed), DataError);
  Pose not_finite;
  not_finite.position[1] = std::nan("");
  CHECK_THROWS_AS(arm(not_finite), DataError);
}
