#include "lfdtools/cli/joint_path_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "demonstrated_branch.hpp"
#include "joint_path_rows.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/retime.hpp"

namespace lfd::cli {
namespace {

/// [rad/s^2], of movej in the URScript manual: 80 deg/s^2.
constexpr double usual_acceleration = 1.4;
/// A millimetre at a metre's reach: a generated motion strays by half of one before it settles within 0.1 mm.
constexpr double at_rest = 1e-3;
/// An interval may become 64.
constexpr int most_halvings = 6;

/// Paths of one run.
class Answer {
 public:
  Answer(const JointPathRequest& request, Run& run)
      : request_(request), run_(run), tool_(tool_pose(request.pose)), arm_(arm_of(request, run)) {
    warn_of_degrees();
    (void)frame_in_base(arm_.robot(), request.pose.frame);
    if (request.seed) options_.seed = Eigen::Map<const Joints>(request.seed->data());
    if (!request.posture.empty()) options_.branch = demonstrated_branch(request.posture, arm_, run);
    options_.refinements = request.given_rows ? 0 : most_halvings;
    if (request.retime) options_.curve_rest = at_rest;
  }

  void run() {
    CsvTable table(run_.open(), run_.messages());
    const bool fixed = request_.pose.orientation || request_.pose.rpy;
    quaternions_ = !fixed && table.has("qw") && table.has("qx") && table.has("qy") && table.has("qz");
    if (!fixed && !quaternions_) {
      std::string missing;
      for (const char* name : {"qw", "qx", "qy", "qz"}) {
        if (!table.has(name)) missing += (missing.empty() ? "" : ", ") + std::string(name);
      }
      throw UsageError("ik.no_orientation",
                       fmt::format("the path has no column {}: give --orientation or --rpy", missing));
    }
    for (const auto& name : table.columns()) {
      if (name.starts_with("sd_") || name.starts_with("cov_")) passed_.push_back(name);
    }
    const std::vector<std::string> orientation =
        quaternions_ ? std::vector<std::string>{"qw", "qx", "qy", "qz"} : std::vector<std::string>{};
    const DemonstrationSource source(
        std::move(table), run_.messages(),
        {.columns = {"x", "y", "z"}, .extras = joined(orientation, passed_), .min_samples = 1});
    LabelledTable out(run_.output(), joint_path_columns(request_, passed_));
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
      (void)out.begin(recording.demonstration.labels);  // a table without rows has its header, too
      const auto poses = flange_poses(recording, quaternions_, arm_.robot(), request_.pose);
      request_.all ? write_solutions(recording, poses, out) : write_path(recording, poses, out);
    }
  }

 private:
  static InverseKinematics arm_of(const JointPathRequest& request, Run& run) {
    const std::string file = find_data_file(request.robot, "robots");
    Robot robot = load_robot(file, run.messages(), run.options().strict);
    if (request.acceleration) robot.limits.acceleration = Joints::Constant(*request.acceleration);
    if (request.retime && !robot.limits.acceleration) {
      robot.limits.acceleration = Joints::Constant(usual_acceleration);
    }
    try {
      return InverseKinematics(std::move(robot));
    } catch (const ConfigError& error) {  // of the rows: what else a robot can have wrong, reading it has refused
      throw ConfigError(error.id(), error.what(), {file, 0, 0, file.ends_with(".urdf") ? "/robot" : "/dh"});
    }
  }

  void warn_of_degrees() {
    const auto look = [&](std::string_view option, const std::optional<std::vector<double>>& angles) {
      if (!angles) return;
      const auto over = [](double angle) { return std::abs(angle) > 2 * std::numbers::pi; };
      const auto first = std::find_if(angles->begin(), angles->end(), over);
      if (first == angles->end()) return;
      run_.messages().warning(
          "joints.degrees",
          fmt::format("{} has {:g}, over a turn: is it in degrees? radians are needed", option, *first));
    };
    look("--rpy", request_.pose.rpy);
    look("--seed-joints", request_.seed);
  }

  void write_solutions(const Recording& recording, const std::vector<Pose>& poses, LabelledTable& out) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const IkSolutions found = arm_(poses[i]);
      if (found.empty()) {
        run_.messages().warning("ik.unreachable",
                                "the pose is out of reach: " + out_of_reach_words(arm_.geometry(), poses[i]),
                                recording.place(row));
      }
      for (std::size_t k = 0; k < found.size(); ++k) {
        const double time = recording.demonstration.trajectory.times[row];
        out.write(recording.demonstration.labels, solution_row(arm_, found[k], k + 1, time, request_));
      }
    }
  }

  void write_path(const Recording& recording, const std::vector<Pose>& poses, LabelledTable& out) {
    const Vector& given = recording.demonstration.trajectory.times;
    JointPath path = solve_path(arm_, poses, given, options_);
    if (request_.retime && path.joints.rows() > 1) path = moving(recording, path);
    const Vector times = path.times;
    if (request_.retime && path.joints.rows() == 1) path.times[0] = 0.0;
    const bool law = request_.retime && path.joints.rows() > 1;
    const JointRates rates = law ? retimed(recording, path) : rates_along(path);
    if (options_.seed) judge_start(path, recording, *options_.seed, request_.start_tolerance, run_);
    if (!judge(path, rates, recording, arm_.robot(), tool_, request_.limits, run_,
               better_posture(arm_, path, poses, given, options_, request_.limits))) {
      return;
    }
    warn_of_postures(path, recording);
    report_rows(recording, path);
    Samples rows = path_rows(arm_, path, rates, request_);
    if (!passed_.empty()) {
      rows = beside(rows, between(given, recording.extras.rightCols(static_cast<Eigen::Index>(passed_.size())), times));
    }
    out.write(recording.demonstration.labels, rows);
  }

  JointPath moving(const Recording& recording, const JointPath& path) {
    JointPath moving = without_rest(path, at_rest);
    const Eigen::Index less = path.joints.rows() - moving.joints.rows();
    if (less > 0) {
      run_.messages().note(
          "ik.rest_cut",
          fmt::format(
              "{}{} rows are left out: within {} rad of the first or last, or a tenth of that of the row kept before",
              prefix_of(recording.demonstration.labels), less, at_rest));
    }
    return moving;
  }

  /// Gives the path the times of the fastest motion along it, from 0.
  JointRates retimed(const Recording& recording, JointPath& path) {
    RetimeOptions options;
    options.velocity = arm_.robot().limits.velocity;
    options.acceleration = *arm_.robot().limits.acceleration;
    options.tool = tool_;
    const bool tip_lifted = run_.options().all_lifted || run_.options().lifted.count("tcp_speed") > 0;
    if (!tip_lifted) options.tip_speed = request_.limits.tcp_speed;
    const Retiming law = retime(arm_.robot(), path.joints, options);
    const Vector before = path.times;
    path.times = law.times();
    run_.detail("ik.retime", fmt::format("{}{:.4g} s instead of {:.4g} s", prefix_of(recording.demonstration.labels),
                                         law.duration(), before[before.size() - 1] - before[0]));
    run_.figure("duration", law.duration());
    JointRates rates{Samples(path.times.size(), 6), Samples(path.times.size(), 6), true};
    for (Eigen::Index t = 0; t < path.times.size(); ++t) {
      const Retiming::State state = law(law.times()[t]);
      rates.speeds.row(t) = state.velocity.transpose();
      rates.accelerations.row(t) = state.acceleration.transpose();
    }
    return rates;
  }

  /// Says where a path starts in another posture than the first: the arm would have to turn over between them.
  void warn_of_postures(const JointPath& path, const Recording& recording) {
    const int branch = path.branch.front();
    if (!first_branch_) first_branch_ = branch;
    if (branch == *first_branch_) return;
    const std::string words = describe(recording.demonstration.labels);
    run_.messages().warning(
        "ik.postures_differ",
        fmt::format("{}starts in posture {}, the first path in {}: --seed-joints or --posture hold "
                    "them together",
                    words.empty() ? "the path " : words + " ", branch_name(branch), branch_name(*first_branch_)),
        recording.place(0));
  }

  void report_rows(const Recording& recording, const JointPath& path) {
    std::size_t more = 0, first = 0;
    for (std::size_t row = path.given.size(); row-- > 0;) {
      if (!path.inserted(row)) continue;
      first = row;
      ++more;
    }
    if (more == 0) return;
    run_.messages().note("ik.refined",
                         fmt::format("{}{} rows put between those given, which are too far apart for the hand to keep "
                                     "its path",
                                     prefix_of(recording.demonstration.labels), more),
                         recording.place(path.given[first]));
  }

  const JointPathRequest& request_;
  Run& run_;
  Pose tool_;
  InverseKinematics arm_;
  PathOptions options_;
  std::optional<int> first_branch_;
  bool quaternions_ = false;
  std::vector<std::string> passed_;
};

}  // namespace

void answer(const JointPathRequest& request, Run& run) {
  Answer(request, run).run();
}

}  // namespace lfd::cli
