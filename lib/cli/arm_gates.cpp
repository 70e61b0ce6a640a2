#include "lfdtools/cli/arm_gates.hpp"

#include <fmt/format.h>

#include <limits>

namespace lfd::cli {
namespace {

std::string_view gate_of(PathStatus status) {
  switch (status) {
    case PathStatus::unreachable:
      return "unreachable";
    case PathStatus::outside_limits:
      return "joint_range";
    case PathStatus::jump:
      return "joint_step";
    case PathStatus::deviates:
      return "midpoint";
    case PathStatus::other_branch:
      return "posture";
    case PathStatus::continuous:
      break;
  }
  return "";
}

}  // namespace

void declare_arm_gates(Program& program, ArmLimits& limits) {
  program.number("--max-tcp-speed", limits.tcp_speed, Range<double>{JointLimits::least_rate, JointLimits::most_rate},
                 "largest speed of the tool tip [m/s]");
  program.number("--max-tcp-acceleration", limits.tcp_acceleration, positive,
                 "largest acceleration of the tool tip [m/s^2]");
  program.number("--max-condition", limits.condition, positive, "largest condition number of the Jacobian");
  program.gate("unreachable", "a pose out of reach")
      .gate("joint_range", "no way through the poses within the joint ranges")
      .gate("joint_step", "a jump of a joint between two samples")
      .gate("midpoint", "the hand leaves the path between two samples")
      .gate("posture", "the posture of the demonstrations of --posture cannot be kept")
      .gate("branch_change", "shoulder, elbow or wrist change over inside the path")
      .gate("joint_speed", "a joint faster than the robot's limit")
      .gate("joint_acceleration", "the same for accelerations, where the robot file has limits")
      .gate("tcp_speed", "the tool tip faster than --max-tcp-speed")
      .gate("tcp_acceleration", "the same for accelerations, where a limit is given")
      .gate("condition", "the Jacobian's condition number over --max-condition");
}

namespace {

/// A law of motion uses its limits up, and is checked at points that are not the rows.
constexpr double used_up = 1.0 + 1e-6;

/// Of each row the largest share of a limit.
Vector share_of(const Samples& rates, const Joints& limit) {
  return (rates.cwiseAbs().array().rowwise() / limit.transpose().array()).rowwise().maxCoeff();
}

/// Three digits; what is only rounding away from infinite is told as such.
std::string condition_words(double condition) {
  return condition > 1e12 ? "infinite (singular)" : fmt::format("{:.3g}", condition);
}

}  // namespace

void judge_start(const JointPath& path, const Recording& recording, const Joints& current, double tolerance, Run& run) {
  if (path.joints.rows() == 0) return;
  Eigen::Index joint = 0;
  const double off = (path.joints.row(0).transpose() - current).cwiseAbs().maxCoeff(&joint);
  if (!(off > tolerance)) return;
  run.refuse("start",
             fmt::format("{}joint {} starts at {:.4g} rad, {:.3g} rad from the {:.4g} rad of --seed-joints, over {:g}",
                         prefix_of(recording.demonstration.labels), joint + 1, path.joints(0, joint), off,
                         current[joint], tolerance),
             recording.place(0));
}

bool judge(const JointPath& path, const JointRates& rates, const Recording& recording, const Robot& robot,
           const Pose& tool, const ArmLimits& limits, Run& run, const std::string& elsewhere) {
  const std::string name = prefix_of(recording.demonstration.labels);
  const auto refuse = [&](std::string_view gate, Eigen::Index sample, const std::string& text) {
    run.refuse(gate, name + text, recording.place(sample));
  };
  const auto given = [&](Eigen::Index row) { return path.given[static_cast<std::size_t>(row)]; };
  for (const PathFault& fault : path.faults) refuse(gate_of(fault.status), fault.sample, fault.reason);
  if (path.joints.rows() == 0) return false;
  for (std::size_t k = 1; k < path.branch.size(); ++k) {
    if (path.branch[k] == path.branch[k - 1]) continue;
    refuse("branch_change", path.given[k],
           fmt::format("the arm changes from {} to {}{}", branch_name(path.branch[k - 1]), branch_name(path.branch[k]),
                       elsewhere));
    break;
  }
  const MotionFigures figures = motion_figures(robot, path.times, path.joints, tool);
  Vector of_rates = share_of(rates.speeds, robot.limits.velocity);
  if (!rates.of_law) of_rates[0] = of_rates[of_rates.size() - 1] = 0.0;
  const Worst speed = worst(rates.of_law ? of_rates : figures.speed_ratio.cwiseMax(of_rates).eval());
  if (speed.value > used_up) {
    refuse("joint_speed", given(speed.sample),
           fmt::format("a joint moves at {:.2f} times its speed limit", speed.value));
  }
  const bool law_bound = rates.of_law && robot.limits.acceleration;
  const Worst acceleration =
      worst(law_bound ? share_of(rates.accelerations, *robot.limits.acceleration) : figures.acceleration_ratio);
  if (acceleration.value > used_up) {
    refuse("joint_acceleration", given(acceleration.sample),
           fmt::format("a joint accelerates with {:.2f} times its limit", acceleration.value));
  }
  const Worst tcp_speed = worst(figures.tcp_speed);
  if (tcp_speed.value > limits.tcp_speed) {
    refuse("tcp_speed", given(tcp_speed.sample),
           fmt::format("the tool tip moves at {:.3f} m/s, over {:g} m/s", tcp_speed.value, limits.tcp_speed));
  }
  const Worst tcp_acceleration = worst(figures.tcp_acceleration);
  if (limits.tcp_acceleration && tcp_acceleration.value > *limits.tcp_acceleration) {
    refuse("tcp_acceleration", given(tcp_acceleration.sample),
           fmt::format("the tool tip accelerates with {:.3f} m/s^2, over {:g} m/s^2", tcp_acceleration.value,
                       *limits.tcp_acceleration));
  }
  const Worst condition = worst(path.condition);
  if (condition.value > limits.condition) {
    refuse("condition", given(condition.sample),
           fmt::format("the condition number is {}, over {:g}: a singularity is near{}",
                       condition_words(condition.value), limits.condition, elsewhere));
  } else if (condition.value > limits.condition_warning) {
    run.messages().warning("ik.condition",
                           fmt::format("{}the largest condition number is {}", name, condition_words(condition.value)),
                           recording.place(given(condition.sample)));
  }
  run.figure("largest_step", worst(figures.step).value);
  run.figure("largest_speed_ratio", speed.value);
  run.figure("tcp_speed", tcp_speed.value);
  run.figure("condition", condition.value);
  return true;
}

std::string better_posture(const InverseKinematics& arm, const JointPath& path, const std::vector<Pose>& flange,
                           const Vector& times, const PathOptions& options, const ArmLimits& limits) {
  const auto passes = [&](const JointPath& other) {
    return other.status == PathStatus::continuous && other.branch_changes == 0 &&
           other.condition.maxCoeff() <= limits.condition;
  };
  if (path.status != PathStatus::continuous || passes(path) || options.seed || options.branch) return "";
  double least = std::numeric_limits<double>::infinity();
  std::string words;
  for (int branch = 0; branch < 8; ++branch) {
    PathOptions kept = options;
    kept.branch = branch;
    const JointPath other = solve_path(arm, flange, times, kept);
    if (!passes(other) || other.condition.maxCoeff() >= least) continue;
    least = other.condition.maxCoeff();
    words = fmt::format("; in posture {} it is at most {:.3g}: --posture or --seed-joints", branch_name(branch), least);
  }
  return words;
}

}  // namespace lfd::cli
