#include "lfdtools/cli/joint_path_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "lfdtools/interpolation.hpp"
#include "lfdtools/io/data_files.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/robot_file.hpp"
#include "lfdtools/posture.hpp"
#include "lfdtools/retime.hpp"
#include "lfdtools/singularity.hpp"

namespace lfd::cli {
namespace {

const std::vector<std::string> speed_names = {"qd1", "qd2", "qd3", "qd4", "qd5", "qd6"};
const std::vector<std::string> acceleration_names = {"qdd1", "qdd2", "qdd3", "qdd4", "qdd5", "qdd6"};
/// [rad/s^2], of movej in the URScript manual: 80 deg/s^2.
constexpr double usual_acceleration = 1.4;
/// A millimetre at a metre's reach: a generated motion strays by half of one before it settles within 0.1 mm.
constexpr double at_rest = 1e-3;
/// An interval may become 64.
constexpr int most_halvings = 6;

/// The branch that demonstrations keep; warns where they do not agree.
int posture_of(const std::string& file, const InverseKinematics& arm, Run& run) {
  const DemonstrationSource source(CsvTable(open_inputs({file}), run.messages()), run.messages(),
                                   {.columns = joint_columns(), .extras = {}, .min_samples = 1});
  std::vector<Recording> recordings;
  std::vector<Samples> joints;
  for (std::size_t i = 0; i < source.recordings(); ++i) {
    recordings.push_back(source.recording(i));
    joints.push_back(recordings.back().demonstration.trajectory.positions);
  }
  const DemonstratedPosture posture = demonstrated_posture(arm, joints);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::string words = describe(recordings[i].demonstration.labels);
    const std::string name = words.empty() ? "the demonstration" : words;
    const auto warn = [&](std::string_view id, const std::string& text) {
      run.messages().warning(id, name + text, recordings[i].place(0));
    };
    if (posture.branches[i] != posture.branch) {
      warn("ik.posture_differs", fmt::format(" is in posture {}, most are in {}", branch_name(posture.branches[i]),
                                             branch_name(posture.branch)));
    }
    if (posture.samples_elsewhere[i] > 0) {
      warn("ik.posture_changes",
           fmt::format(" leaves its posture {} in {} of {} samples", branch_name(posture.branches[i]),
                       posture.samples_elsewhere[i], joints[i].rows()));
    }
    if (posture.samples_singular[i] > 0) {
      warn("ik.posture_singular",
           fmt::format(" is near a singularity in {} of {} samples, which say nothing of posture",
                       posture.samples_singular[i], joints[i].rows()));
    }
  }
  run.detail("ik.posture", fmt::format("the demonstrations keep {}", branch_name(posture.branch)));
  return posture.branch;
}

/// Paths of one run.
class Answer {
 public:
  Answer(const JointPathRequest& request, Run& run)
      : request_(request), run_(run), tool_(tool_pose(request.pose)), arm_(arm_of(request, run)) {
    warn_of_degrees();
    (void)frame_in_base(arm_.robot(), request.pose.frame);
    if (request.seed) options_.seed = Eigen::Map<const Joints>(request.seed->data());
    if (!request.posture.empty()) options_.branch = posture_of(request.posture, arm_, run);
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
    LabelledTable out(run_.output(), columns());
    for (std::size_t i = 0; i < source.recordings(); ++i) {
      const Recording recording = source.recording(i);
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

  [[nodiscard]] std::vector<std::string> columns() const {
    auto columns = joined(request_.all ? std::vector<std::string>{"t", "solution"} : std::vector<std::string>{"t"},
                          joint_columns());
    if (request_.speeds) columns = joined(columns, speed_names);
    if (request_.accelerations) columns = joined(columns, acceleration_names);
    if (request_.diagnostics) columns = joined(columns, {"branch", "residual", "condition"});
    if (request_.singularities) columns = joined(columns, {"manipulability", "shoulder", "elbow", "wrist"});
    return request_.all ? columns : joined(columns, passed_);
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
        Samples cells(1, 8);
        const Joints& q = found[k].joints;
        cells << recording.demonstration.trajectory.times[row], static_cast<double>(k + 1), q.transpose();
        if (request_.diagnostics) {
          const double condition = condition_number(jacobian(arm_.robot(), q));
          cells = beside(cells, Eigen::RowVector3d(found[k].branch, found[k].residual, condition));
        }
        if (request_.singularities) cells = beside(cells, singularities(q));
        out.write(recording.demonstration.labels, cells);
      }
    }
  }

  void write_path(const Recording& recording, const std::vector<Pose>& poses, LabelledTable& out) {
    const Vector& given = recording.demonstration.trajectory.times;
    JointPath path = solve_path(arm_, poses, given, options_);
    if (request_.retime && path.joints.rows() > 1) path = moving(recording, path);
    const Vector times = path.times;
    double start = 0.0;
    JointRates rates;
    if (request_.retime && path.joints.rows() > 1) {
      // Judged from 0: beside a large time, such as one counted from 1970, the law's would be rounded.
      start = times[0];
      rates = retimed(recording, path);
    } else {
      rates = rates_along(path);
    }
    if (options_.seed) judge_start(path, recording, *options_.seed, request_.start_tolerance, run_);
    if (!judge(path, rates, recording, arm_.robot(), tool_, request_.limits, run_,
               better_posture(arm_, path, poses, given, options_, request_.limits))) {
      return;
    }
    warn_of_postures(path, recording);
    report_rows(recording, path);
    Samples rows = beside(path.times.array() + start, path.joints);
    if (request_.speeds) rows = beside(rows, rates.speeds);
    if (request_.accelerations) rows = beside(rows, rates.accelerations);
    if (request_.diagnostics) rows = beside(rows, diagnostics(path));
    if (request_.singularities) rows = beside(rows, singularities(path));
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

  /// By the spline through the joints, so that speeds do not lag half a sample.
  static JointRates rates_along(const JointPath& path) {
    const Eigen::Index T = path.joints.rows();
    if (T < 2) return {Samples::Zero(T, 6), Samples::Zero(T, 6)};
    const CubicSpline spline(path.times, path.joints);
    return {spline.derivative(path.times), spline.second_derivatives()};
  }

  static Samples diagnostics(const JointPath& path) {
    Samples figures(path.times.size(), 3);
    for (Eigen::Index t = 0; t < figures.rows(); ++t) {
      figures.row(t) << path.branch[static_cast<std::size_t>(t)], path.residual[t], path.condition[t];
    }
    return figures;
  }

  [[nodiscard]] Samples singularities(const JointPath& path) const {
    Samples figures(path.times.size(), 4);
    for (Eigen::Index t = 0; t < figures.rows(); ++t) {
      figures.row(t) = singularities(path.joints.row(t).transpose());
    }
    return figures;
  }

  [[nodiscard]] Eigen::RowVector4d singularities(const Joints& q) const {
    const SingularityDistances d = singularity_distances(arm_.geometry(), q);
    return {manipulability(jacobian(arm_.robot(), q)), d.shoulder, d.elbow, d.wrist};
  }

  /// Values at the given times, at others linearly between.
  static Samples between(const Vector& given, const Samples& values, const Vector& times) {
    Samples rows(times.size(), values.cols());
    Eigen::Index k = 0;
    for (Eigen::Index t = 0; t < times.size(); ++t) {
      while (given[k] < times[t]) ++k;
      rows.row(t) = values.row(k);
      if (given[k] == times[t]) continue;
      const double share = (times[t] - given[k - 1]) / (given[k] - given[k - 1]);
      rows.row(t) = (1.0 - share) * values.row(k - 1) + share * values.row(k);
    }
    return rows;
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
