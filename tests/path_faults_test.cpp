// Faults of a path: where and why none is continuous, or none in the branch to keep.
#include <catch2/catch.hpp>

#include "lfdtools/error.hpp"
#include "path_fixture.hpp"

using namespace lfd;

namespace {

/// T samples of a hand that goes straight out, 1 cm a sample.
std::vector<Pose> outward(Eigen::Index T) {
  std::vector<Pose> line;
  for (Eigen::Index t = 0; t < T; ++t) {
    line.push_back({down, Vector3(0.4 + 0.01 * static_cast<double>(t), 0.3, 0.3)});
  }
  return line;
}

}  // namespace

TEST_CASE("a branch is kept where it can be, and the path named that leaves it where not") {
  const InverseKinematics arm(nominal_ur10());
  constexpr Eigen::Index T = 40;
  const Vector times = Vector::LinSpaced(T, 0.0, 4.0);
  const std::vector<Pose> line = outward(T);
  for (int branch = 0; branch < 8; ++branch) {
    PathOptions options;
    options.branch = branch;
    const JointPath path = solve_path(arm, line, times, options);
    INFO(branch_name(branch));
    CHECK(path.status == PathStatus::continuous);
    for (Eigen::Index t = 0; t < T; ++t) CHECK(arm.branch(path.joints.row(t).transpose()) == branch);
  }
  Robot bent_one_way = arm.robot();
  bent_one_way.limits.position.row(2) << 0.0, 3.0;
  PathOptions options;
  options.branch = 1;  // elbow-
  const JointPath other = solve_path(bent_one_way, line, times, options);
  CHECK(other.status == PathStatus::other_branch);
  CHECK(other.joints.rows() == T);
  CHECK((other.branch[0] & 1) == 0);
  CHECK(other.reason.find("left-wrist+-elbow-") != std::string::npos);
  CHECK(other.reason.find("there is a path in " + branch_name(other.branch[0])) != std::string::npos);
  CHECK(other.faults.size() == 1);
  CHECK(other.sample == 0);
  options.branch = 0;
  CHECK(solve_path(bent_one_way, line, times, options).status == PathStatus::continuous);

  // A path over the wrist singularity itself is kept in one branch up to there, and no further.
  std::vector<Pose> over;
  for (Eigen::Index t = 0; t < T; ++t) {
    Joints q;
    q << 0.2, -1.2, 1.4, 0.3, 0.02 * static_cast<double>(t - 20), 1.3;
    over.push_back(forward_kinematics(arm.robot(), q));
  }
  options.branch = arm.branch((Joints() << 0.2, -1.2, 1.4, 0.3, -0.4, 1.3).finished());
  const JointPath crossing = solve_path(arm, over, times, options);
  CHECK(crossing.status == PathStatus::other_branch);
  CHECK(crossing.branch_changes == 1);
  CHECK(crossing.faults.size() == 1);
  CHECK(crossing.reason.find("there is a path") == std::string::npos);  // it changes over

  // One fault does not hide another: the path in another branch jumps, and leaves the hand's path midway.
  options.branch = 1;
  const JointPath worse = solve_path(bent_one_way, {line[0], {line[0].rotation, Vector3(-0.4, -0.5, 0.3)}},
                                     Vector::LinSpaced(2, 0.0, 1.0), options);
  REQUIRE(worse.faults.size() == 3);
  CHECK(worse.status == PathStatus::other_branch);
  CHECK(worse.reason == worse.faults[0].reason);
  CHECK(worse.reason.find("there is a path") == std::string::npos);
  CHECK(worse.faults[1].status == PathStatus::jump);
  CHECK(worse.faults[1].sample == 1);
  CHECK(worse.faults[2].status == PathStatus::deviates);
  CHECK(worse.faults[2].sample == 1);

  options.branch = 8;
  CHECK_THROWS_AS(solve_path(arm, line, times, options), UsageError);
}

TEST_CASE("where there is no path, the result says where and why") {
  const InverseKinematics arm(nominal_ur10());
  constexpr Eigen::Index T = 60;
  const Vector times = Vector::LinSpaced(T, 0.0, 3.0);
  const std::vector<Pose> line = outward(T);
  CHECK(solve_path(arm, line, times).status == PathStatus::continuous);

  auto far = line;
  far[20].position.x() = 3.0;
  far[50].position.z() = 9.0;
  const JointPath out = solve_path(arm, far, times);
  CHECK(out.status == PathStatus::unreachable);
  CHECK(out.sample == 20);
  CHECK(out.unreachable == std::vector<Eigen::Index>{20, 50});
  CHECK(out.joints.rows() == 0);

  auto leap = line;
  for (std::size_t t = 30; t < leap.size(); ++t) leap[t].position.y() = -0.6;
  const JointPath jump = solve_path(arm, leap, times);
  CHECK(jump.status == PathStatus::jump);
  CHECK(jump.sample == 30);
  CHECK(jump.joints.rows() == T);

  Robot narrow = arm.robot();
  narrow.limits.position.row(0) << 3.0, 3.1;
  CHECK(solve_path(narrow, line, times).status == PathStatus::outside_limits);
  PathOptions free;
  free.respect_limits = false;
  CHECK(solve_path(narrow, line, times, free).status == PathStatus::continuous);

  const std::vector<Pose> sparse = {line[0], line[15]};
  PathOptions strict;
  strict.midpoint_tolerance = 1e-3;
  const JointPath off = solve_path(arm, sparse, Vector::LinSpaced(2, 0.0, 3.0), strict);
  CHECK(off.status == PathStatus::deviates);
  CHECK(off.midpoint_deviation[1] > 1e-3);
}
