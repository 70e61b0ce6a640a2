#include "lfdtools/clearance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "arm_fixture.hpp"
#include "io_fixture.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/random.hpp"
#include "lfdtools/ur_geometry.hpp"

using namespace lfd;

namespace {

Robot arm_of_file(const std::string& name) {
  CapturedMessages captured;
  return load_robot(find_data_file(name, "robots"), captured.messages, true);
}

Solid plane(double height) {
  Solid solid;
  solid.name = "table";
  solid.shape = SolidShape::plane;
  solid.pose.position = {0, 0, height};
  return solid;
}

Solid box(const Vector3& position, const Vector3& size) {
  Solid solid;
  solid.name = "box";
  solid.pose.position = position;
  solid.size = size;
  return solid;
}

std::vector<Solid> cell() {
  Solid rod;
  rod.shape = SolidShape::cylinder;
  rod.pose = {rotation_from_rpy({0.4, 0.3, 0}), {0.3, 0.5, 0.4}};
  rod.radius = 0.06;
  rod.length = 0.8;
  Solid bar = rod, ball = rod;
  bar.shape = SolidShape::capsule;
  bar.pose.position = {0.4, -0.4, 0.6};
  ball.shape = SolidShape::sphere;
  ball.pose.position = {-0.3, -0.5, 0.7};
  return {plane(-0.05), box({-0.6, 0.3, 0.5}, {0.3, 0.2, 0.4}), rod, bar, ball};
}

}  // namespace

TEST_CASE("an arm stretched out over a table, worked out by hand") {
  Robot robot = nominal_ur10();
  robot.links = {{"pedestal", 0, {0, 0, 0}, {0, 0, 0.05}, 0.1},
                 {"upper", 2, {0, 0, 0}, {0.612, 0, 0}, 0.06},
                 {"hand", 6, {0, 0, -0.02}, {0, 0, 0}, 0.04}};
  const ArmClearance arm(robot, {plane(0.0)}, tool_capsule({Matrix3::Identity(), {0, 0, 0.1}}, 0.01));
  const auto links = arm.links(Joints::Zero());
  // The pedestal stands on the table and never moves: no row.
  REQUIRE(links.size() == 3);
  CHECK(arm.bodies()[static_cast<std::size_t>(links[0].link)].name == "upper");
  CHECK(links[0].distance == Approx(0.1273 - 0.06));
  CHECK(links[1].distance == Approx(0.1273 - 0.1157 - 0.04));
  CHECK(arm.bodies()[static_cast<std::size_t>(links[2].link)].name == "tool");
  CHECK(links[2].distance == Approx(0.1273 - 0.1157 - 0.01));
  CHECK(links[2].normal == Vector3(0, 0, 1));
  CHECK(arm.least(Joints::Zero()) == Approx(0.1273 - 0.1157 - 0.04));
  CHECK(arm.obstacle_name(links[0].obstacle) == "table");
  CHECK(arm.obstacle_name(1) == "pedestal");
}

TEST_CASE("what the arm stands on does not count against the links that only turn on the spot") {
  const Robot robot = arm_of_file("ur10");
  const auto shoulder_counts = [&](double height) {
    const ArmClearance arm(robot, {plane(height)});
    const auto links = arm.links(Joints::Zero());
    return arm.bodies()[static_cast<std::size_t>(links[0].link)].name == "shoulder";
  };
  CHECK_FALSE(shoulder_counts(0.0));
  CHECK(shoulder_counts(-0.2));
}

TEST_CASE("each link has its closest solid, and the least is the least of all") {
  const ArmClearance arm(arm_of_file("ur10"), cell());
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Joints q = random_joints(random);
    const auto pairs = arm.pairs(q);
    double least = 1e9;
    for (const LinkClearance& link : arm.links(q)) {
      for (const LinkClearance& pair : pairs) {
        if (pair.link == link.link) CHECK(pair.distance >= link.distance);
      }
      least = std::min(least, link.distance);
    }
    CHECK(arm.least(q) == least);
    const auto own = arm.pairs_of_arm_itself(q);
    const auto nearest =
        std::min_element(own.begin(), own.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    CHECK(arm.least_of_arm_itself(q) == nearest->distance);
  }
}

TEST_CASE("pairs measured elsewhere have the same distances, and tell the same of what is closer") {
  const ArmClearance arm(arm_of_file("ur10"), cell(), tool_capsule({Matrix3::Identity(), {0, 0.05, 0.2}}, 0.02));
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const Joints q = random_joints(random);
    const auto frames = joint_frames(arm.robot(), q);
    const Joints elsewhere = i % 2 == 0 ? random_joints(random) : Joints(q + 0.05 * random_joints(random));
    for (const bool own : {false, true}) {
      const auto measured = own ? arm.pairs_of_arm_itself(elsewhere) : arm.pairs(elsewhere);
      const auto here = own ? arm.pairs_of_arm_itself(q) : arm.pairs(q);
      REQUIRE(measured.size() == here.size());
      for (std::size_t k = 0; k < here.size(); ++k) {
        const double d = here[k].distance;
        double least = 1e9;
        for (const Gap& gap : arm.gaps(measured[k], frames)) least = std::min(least, gap.distance);
        CHECK(least <= d + 1e-12);
        least = 1e9;
        for (const Gap& gap : arm.gaps(here[k], frames)) least = std::min(least, gap.distance);
        CHECK(least == Approx(d).margin(1e-12));
        CHECK(arm.any_closer({measured[k]}, d + 1e-9, frames));
        CHECK_FALSE(arm.any_closer({measured[k]}, d - 1e-9, frames));
      }
      CHECK(arm.any_closer(measured, (own ? arm.least_of_arm_itself(q) : arm.least(q)) + 1e-9, frames));
      CHECK_FALSE(arm.any_closer(measured, (own ? arm.least_of_arm_itself(q) : arm.least(q)) - 1e-9, frames));
    }
  }
}

TEST_CASE("the slope of a gap is its derivative by the joints") {
  const ArmClearance arm(arm_of_file("ur10e"), cell(), tool_capsule({Matrix3::Identity(), {0.02, 0, 0.15}}, 0.01));
  Random random(2);
  constexpr double step = 1e-6;
  for (int i = 0; i < 40; ++i) {
    const Joints q = random_joints(random);
    for (const bool own : {false, true}) {
      for (const LinkClearance& pair : own ? arm.pairs_of_arm_itself(q) : arm.pairs(q)) {
        const auto gaps = arm.gaps(pair, joint_frames(arm.robot(), q));
        for (int j = 0; j < 6; ++j) {
          const auto moved = [&](double angle) {
            return arm.gaps(pair, joint_frames(arm.robot(), q + angle * Joints::Unit(j)));
          };
          const auto before = moved(-step), after = moved(step);
          for (std::size_t k = 0; k < gaps.size(); ++k) {
            CHECK(gaps[k].slope[j] == Approx((after[k].distance - before[k].distance) / (2 * step)).margin(1e-8));
          }
        }
      }
    }
  }
}

TEST_CASE("no point moves further than the bound, which is not much too large") {
  const ArmClearance arm(arm_of_file("ur10"), {});
  Random random(3);
  double tightest = 1e9;
  for (int i = 0; i < 500; ++i) {
    const Joints q = random_joints(random);
    Joints range;
    for (double& r : range) r = random.uniform(0, 0.05);
    const double bound = arm.furthest_motion(q, range);
    for (int k = 0; k < 30; ++k) {
      Joints moved = q;
      for (int j = 0; j < 6; ++j) moved[j] += range[j] * (k == 0 ? 1.0 : random.uniform(-1, 1));
      const auto before = joint_frames(arm.robot(), q), after = joint_frames(arm.robot(), moved);
      for (const Capsule& body : arm.bodies()) {
        const auto f = static_cast<std::size_t>(body.frame);
        for (const Vector3& end : {body.from, body.to}) {
          const double way =
              ((after[f].rotation * end + after[f].position) - (before[f].rotation * end + before[f].position)).norm();
          CHECK(way <= bound + 1e-12);
          if (way > 0) tightest = std::min(tightest, bound / way);
        }
      }
    }
  }
  CHECK(tightest < 1.5);
}

TEST_CASE("an obstacle between two samples is found") {
  Robot robot = nominal_ur10();
  robot.links = {{"hand", 6, {0, 0, -0.02}, {0, 0, 0}, 0.02}};
  // Joint 1 swings the stretched arm by half a radian: the hand passes through a plate of 2 mm half way.
  Joints from = Joints::Zero(), to = Joints::Zero();
  to[0] = 0.5;
  const Pose middle = forward_kinematics(robot, 0.5 * (from + to));
  Solid plate = box(middle.position, {0.002, 0.3, 0.3});
  plate.pose.rotation = rotation_about_z(0.25 + std::numbers::pi / 2);
  const ArmClearance arm(robot, {plane(-1), plate});
  Samples joints(3, 6);
  joints << from.transpose(), from.transpose(), to.transpose();
  CHECK(std::min(arm.least(from), arm.least(to)) > 0.1);
  const ClosestApproach closest = closest_approach(arm, joints);
  CHECK(closest.distance < -0.02);
  CHECK(closest.sample == 1);
  CHECK(closest.share == Approx(0.5).margin(0.05));
  CHECK(closest.pair.obstacle == 1);
  CHECK(closest.pair.distance == Approx(closest.distance));
}

TEST_CASE("the closest approach is within its tolerance of a dense search") {
  const ArmClearance arm(arm_of_file("ur10"), cell());
  Random random(5);
  for (const bool self : {false, true}) {
    for (int i = 0; i < 6; ++i) {
      Samples joints(3, 6);
      joints.row(0) = random_joints(random).transpose();
      for (int k = 1; k < 3; ++k) joints.row(k) = joints.row(k - 1) + 0.3 * random_joints(random).transpose();
      double dense = 1e9;
      for (int k = 0; k < 2; ++k) {
        for (int s = 0; s <= 2000; ++s) {
          const Joints q = (joints.row(k) + s / 2000.0 * (joints.row(k + 1) - joints.row(k))).transpose();
          dense = std::min(dense, self ? arm.least_of_arm_itself(q) : arm.least(q));
        }
      }
      const ClosestApproach closest =
          self ? closest_approach_of_arm_itself(arm, joints, 1e-4) : closest_approach(arm, joints, 1e-4);
      const double found = closest.distance;
      CHECK(closest.pair.distance == found);
      CHECK(found <= dense + 1e-4);
      CHECK(found >= dense - 2e-3);
    }
  }
}

TEST_CASE("what cannot be told is refused") {
  CHECK(refusal_of([] { ArmClearance(nominal_ur10(), {}); }).id == "robot.no_links");
  Robot still = nominal_ur10();
  still.links = {{"base", 0, {0, 0, 0}, {0, 0, 0.1}, 0.1}};
  CHECK(refusal_of([&] { ArmClearance(still, {}); }).id == "robot.no_links");
  const ArmClearance arm(arm_of_file("ur10"), {});
  CHECK(closest_approach(arm, Samples::Zero(2, 6)).distance > 1e300);
  CHECK(refusal_of([&] { (void)closest_approach(arm, Samples::Zero(0, 6)); }).id == "clearance.shape");
  CHECK(refusal_of([&] { (void)closest_approach(arm, Samples::Zero(2, 5)); }).id == "clearance.shape");
  CHECK(refusal_of([&] { (void)closest_approach(arm, Samples::Constant(2, 6, NAN)); }).id == "clearance.not_finite");
}

TEST_CASE("of the arm itself, neighbours always overlap and are left aside, a folded arm touches itself") {
  const Robot robot = arm_of_file(GENERATE("ur10", "ur10e"));
  const ArmClearance arm(robot, {});
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Joints q = random_joints(random);
    const auto frames = joint_frames(robot, q);
    const auto axis = [&](const Capsule& body) {
      const Pose& frame = frames[static_cast<std::size_t>(body.frame)];
      return Segment{frame.rotation * body.from + frame.position, frame.rotation * body.to + frame.position};
    };
    for (int f = 0; f < 6; ++f) {
      double least = 1e9;
      for (const Capsule& a : robot.links) {
        for (const Capsule& b : robot.links) {
          if (a.frame == f && b.frame == f + 1) {
            least = std::min(least, separation(axis(a), a.radius, axis(b), b.radius).distance);
          }
        }
      }
      CHECK(least < 0);
    }
    for (const LinkClearance& pair : arm.pairs_of_arm_itself(q)) {
      const int near = arm.bodies()[static_cast<std::size_t>(pair.obstacle)].frame;
      CHECK(arm.bodies()[static_cast<std::size_t>(pair.link)].frame - near > 1);
      // These are never far from each other, but must never seem to touch.
      const std::string names =
          arm.bodies()[static_cast<std::size_t>(pair.link)].name + " " + arm.obstacle_name(pair.obstacle);
      if (names == "upper_arm_shoulder base" || names == "wrist_2 forearm_wrist" || names == "wrist_3 wrist_1") {
        CHECK(pair.distance > 0);
        CHECK(pair.distance < 0.04);
      }
    }
  }
  // Upright, at work, and stretched out the arm is clear of itself.
  const double pi = std::numbers::pi;
  for (const Joints& q : {(Joints() << 0, -pi / 2, 0, -pi / 2, 0, 0).finished(), Joints(Joints::Zero()),
                          (Joints() << 0, -1.9, 2.0, -1.6, -1.57, 0).finished()}) {
    CHECK(arm.least_of_arm_itself(q) > 0);
  }
  // Elbow bent by 170 degrees: the wrist is in the shoulder.
  CHECK(arm.least_of_arm_itself((Joints() << 0, -pi / 2, 2.97, 0, 0, 0).finished()) < 0);
}
