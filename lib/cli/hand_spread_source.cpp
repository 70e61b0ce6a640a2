#include "hand_spread_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lfdtools/io/robot_file.hpp"

namespace lfd::cli {
namespace {

// A covariance whose mean is further from the joints' hand than this belongs to another tool, frame or motion [m].
constexpr double same_path = 1e-3;

const std::vector<std::string> position_names = {"x", "y", "z"};

}  // namespace

HandSpreadSource::HandSpreadSource(const ClearanceRequest& request, const Robot& robot, Run& run)
    : request_(request),
      robot_(robot),
      run_(run),
      frame_(frame_in_base(robot, request.pose.frame)),
      tool_(tool_pose(request.pose)) {
  if (request.covariance.empty()) return;
  std::vector<Input> inputs;
  inputs.push_back(Input(request.covariance));
  JsonStream stream(std::move(inputs), run.messages(), run.json_options());
  while (const auto document = stream.next()) {
    files_.push_back(read_covariance(*document));
    if (files_.back().header.columns != position_names) {
      document->root().at("columns").fail("clearance.covariance_columns", "the signals must be x, y, z");
    }
  }
}

HandSpread HandSpreadSource::of(const Recording& recording) const {
  const Samples positions = tips(recording.demonstration.trajectory.positions);
  HandSpread spread;
  if (!files_.empty()) {
    const CovarianceFile& file = file_of(recording);
    judge_mean(file, positions, recording);
    spread = of_file(file);
  }
  if (!request_.goal_sd) return spread;
  return files_.empty() ? of_goal(positions) : together(spread, of_goal(positions));
}

/// The tool tip at every sample, T x 3, in the base [m].
Samples HandSpreadSource::tips(const Samples& joints) const {
  Samples positions(joints.rows(), 3);
  for (Eigen::Index k = 0; k < joints.rows(); ++k) {
    positions.row(k) = (forward_kinematics(robot_, joints.row(k).transpose()) * tool_).position.transpose();
  }
  return positions;
}

const CovarianceFile& HandSpreadSource::file_of(const Recording& recording) const {
  const auto& target = recording.demonstration.labels.target;
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const CovarianceFile& file) {
    return file.header.labels.target == target || (files_.size() == 1 && !(file.header.labels.target && target));
  });
  if (found == files_.end()) {
    throw DataError("clearance.covariance_target",
                    fmt::format("{} has no covariance for target {}", request_.covariance, target.value_or("(none)")),
                    recording.place(0));
  }
  // Times may differ, as those of a retimed path do: judge_mean holds the samples against each other by their places.
  const Eigen::Index samples = recording.demonstration.trajectory.samples();
  if (found->times.size() != samples) {
    throw DataError("clearance.covariance_samples",
                    fmt::format("{} is of {} samples, the joints have {}: ur10-ik leaves out or puts in rows with "
                                "--retime and without --given-rows, so take the probability from joints with neither",
                                request_.covariance, found->times.size(), samples),
                    recording.place(0));
  }
  return *found;
}

void HandSpreadSource::judge_mean(const CovarianceFile& file, const Samples& positions,
                                  const Recording& recording) const {
  const Samples mean = (file.mean * frame_.rotation.transpose()).rowwise() + frame_.position.transpose();
  Eigen::Index sample = 0;
  const double off = (mean - positions).rowwise().norm().maxCoeff(&sample);
  if (!(off > same_path)) return;
  const std::string text =
      fmt::format("{}the hand is {:.1f} mm from the covariance's motion: another --tool or --frame?",
                  prefix_of(recording.demonstration.labels), 1e3 * off);
  if (request_.max_probability) {
    run_.refuse("mean_differs", text, recording.place(sample));
  } else {
    run_.messages().warning("clearance.mean_differs", text, recording.place(sample));
  }
}

HandSpread HandSpreadSource::of_file(const CovarianceFile& file) const {
  if (file.calibration.size() == 0) {
    run_.messages().warning("clearance.not_calibrated",
                            request_.covariance + " has no calibration: chances are what the process says of itself");
  }
  if (request_.goal_sd && file.goal_factor.size() > 0) {
    run_.messages().warning("clearance.goal_twice",
                            request_.covariance + " holds an uncertain goal already, and --goal-sd adds to it");
  }
  try {
    return hand_spread(calibrated(file), frame_.rotation);
  } catch (const DataError& error) {
    throw DataError(error.id(), error.what(), {request_.covariance, 0, 0, "/covariance"});
  }
}

HandSpread HandSpreadSource::of_goal(const Samples& positions) const {
  const auto& sd = *request_.goal_sd;
  const Vector3 each = sd.size() == 1 ? Vector3(Vector3::Constant(sd[0])) : Vector3(sd[0], sd[1], sd[2]);
  return hand_shift(each, share_of_way(positions), frame_.rotation);
}

}  // namespace lfd::cli
