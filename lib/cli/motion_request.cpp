#include "lfdtools/cli/motion_request.hpp"

#include <fmt/format.h>

#include "lfdtools/parallel.hpp"
#include "motion_goals.hpp"
#include "motion_rows.hpp"

namespace lfd::cli {
namespace {

void write_weights(LabelledTable& table, const Goal& goal, const WeightPrediction& weights,
                   const std::vector<std::string>& columns) {
  for (Eigen::Index j = 0; j < weights.mean.rows(); ++j) {
    for (Eigen::Index i = 0; i < weights.mean.cols(); ++i) {
      CsvWriter& row = table.begin(goal.labels);
      row.labels(goal.labels);
      row.text(columns[static_cast<std::size_t>(j)]);
      row.integer(i + 1);
      row.number(weights.mean(j, i));
      row.number(weights.sd(j, i));
      row.end_row();
    }
  }
}

/// The answers to one request, goal by goal.
class Answer {
 public:
  Answer(const SkillFile& file, const MotionRequest& request, const std::string& sha256, Run& run)
      : file_(file),
        request_(request),
        run_(run),
        predictor_(file.skill),
        constraints_(constraints_of(request, file.skill.columns.size())),
        changes_(changes_of(request, file.skill.columns.size())),
        header_{file.skill.columns, {}, append(file.header.provenance, run.provenance(sha256))} {}

  void weights(const Goal& goal, LabelledTable& table) {
    gates(goal);
    write_weights(table, goal, predictor_.weights(predictor_.reach(goal)), file_.skill.columns);
  }

  void motion(const Goal& goal, std::size_t number, LabelledTable& table) {
    gates(goal);
    const std::string name = target_prefix(goal.labels);
    MotionPosterior posterior;
    if (!request_.needs_posterior().empty() || !constraints_.empty()) {
      posterior = predict_motion(predictor_, goal, constraints_);
      if (!constraints_.empty()) report_demands(posterior, name);
    } else {
      posterior.course.primitive = predictor_.primitive(goal);
    }
    Course& course = posterior.course;
    for (GoalChange next : changes_) {
      Goal later = goal;
      later.position = next.goal;
      gates(later);
      next.weights = predictor_.primitive(later).weights;
      course.changes.push_back(next);
    }
    report_duration(goal, course, name);
    const Motion mean = generate(course, request_.dt);
    if (request_.approach) report_approach(course, mean, name, request_, run_);
    GoalSpread from_goal;
    if (!request_.sd.empty() || request_.band || request_.max_sd || !request_.covariance.empty()) {
      from_goal = goal_spread(predictor_, goal, constraints_, mean.times);
    }
    if (request_.max_sd) gate_sd(posterior, mean.times, from_goal, name);
    if (!request_.covariance.empty()) {
      header_.labels = goal.labels;
      if (covariance_ == nullptr) covariance_ = &run_.beside(request_.covariance);
      write_covariance_of(posterior, mean, from_goal, covariance_factors(predictor_, predictor_.reach(goal)), header_,
                          request_, *covariance_);
    }
    if (request_.samples > 0) return draws(posterior, goal, number, table);
    Samples rows = rows_of(mean, request_);
    const Samples more = from_goal.variance(mean.positions);
    if (!request_.sd.empty()) {
      const Samples sd = standard_deviation(posterior, mean.times, request_.spread());
      rows = beside(rows, (sd.array().square() + more.array()).sqrt());
    }
    if (request_.band) {
      const Samples half = motion_band(predictor_, posterior, mean.times, *request_.band);
      rows = beside(rows, (half.array().square() + 1.959963984540054 * 1.959963984540054 * more.array()).sqrt());
    }
    table.write(goal.labels, rows);
  }

 private:
  void gates(const Goal& goal) {
    const Skill& skill = file_.skill;
    const std::string name = target_prefix(goal.labels);
    if (!goal.start && skill.start_spread > start_tolerance) {
      run_.refuse("start", fmt::format("{}the demonstrations start up to {:.1f} mm apart, so a goal needs a start",
                                       name, 1e3 * skill.start_spread));
    }
    if (sees_teachers(skill) && goal.labels.teacher && predictor_.reach(goal).teacher < 0) {
      run_.messages().warning("generate.unknown_teacher",
                              name + "no demonstration is of teacher " + *goal.labels.teacher +
                                  ": the motion is what all teachers share, and its sd that of somebody unknown");
    }
    const double excess = region_excess(skill, predictor_.reach(goal));
    if (excess > 0) {
      run_.refuse(
          "region",
          fmt::format("{}the {} {:.1f} mm outside the demonstrated region (range of goal - start, and of the start, "
                      "widened by a tenth)",
                      name, goal.start ? "start and goal lie" : "goal lies", 1e3 * excess));
    }
  }

  void gate_sd(const MotionPosterior& posterior, const Vector& times, const GoalSpread& goal, const std::string& name) {
    Samples variance = standard_deviation(posterior, times, Spread::predictive).array().square();
    variance += goal.variance(variance);
    Eigen::Index at = 0;
    Eigen::Index signal = 0;
    const double largest = std::sqrt(variance.maxCoeff(&at, &signal));
    run_.figure("sd", largest);
    if (largest > *request_.max_sd) {
      run_.refuse("sd", fmt::format("{}a motion's predictive sd is {:.2f} mm, over {:.2f} mm, in {} at {:.3f} s", name,
                                    1e3 * largest, 1e3 * *request_.max_sd,
                                    file_.skill.columns[static_cast<std::size_t>(signal)], times[at]));
    }
  }

  void report_demands(const MotionPosterior& posterior, const std::string& name) {
    const auto D = static_cast<double>(file_.skill.columns.size());
    const double count = D * (static_cast<double>(constraints_.via.size()) + (constraints_.end_velocity ? 1 : 0));
    run_.figure("demand_distance", posterior.distance);
    const std::string text = fmt::format(
        "{}the demands lie {:.2f} standard deviations (Mahalanobis) from the motion "
        "predicted without them",
        name, posterior.distance);
    if (posterior.distance > 4 * std::sqrt(std::max(1.0, count))) {
      run_.messages().warning("generate.far_demand", text + ": no demonstration says that this may be done");
    } else {
      run_.detail("generate.demand", text);
    }
  }

  void report_duration(const Goal& goal, const Course& course, const std::string& name) {
    const double tau = course.primitive.tau;
    const double sd = goal.duration ? 0.0 : file_.skill.duration.sd;
    run_.figure("duration", tau);
    run_.figure("duration_sd", sd);
    run_.detail("generate.duration",
                goal.duration ? fmt::format("{}duration {:.4g} s, as given", name, tau)
                              : fmt::format("{}duration {:.4g} s, sd {:.2g} s of a demonstration", name, tau, sd));
  }

  /// Draw i of goal number `number` has a stream of its own, so neither -j nor the other goals matter.
  void draws(const MotionPosterior& posterior, const Goal& goal, std::size_t number, LabelledTable& table) {
    constexpr std::size_t at_once = 256;
    const Random stream = Random(run_.seed()).split(number);
    const auto total = static_cast<std::size_t>(request_.samples);
    for (std::size_t first = 0; first < total; first += at_once) {
      std::vector<Samples> rows(std::min(at_once, total - first));
      parallel_for(rows.size(), run_.jobs(), [&](std::size_t i) {
        Random random = stream.split(first + i);
        rows[i] = rows_of(generate(draw(posterior, request_.spread(), random), request_.dt), request_);
      });
      for (std::size_t i = 0; i < rows.size(); ++i) {
        Labels labels = goal.labels;
        labels.sample = fmt::format("{}", first + i + 1);
        table.write(labels, rows[i]);
      }
    }
  }

  const SkillFile& file_;
  const MotionRequest& request_;
  Run& run_;
  SkillPredictor predictor_;
  MotionConstraints constraints_;
  std::vector<GoalChange> changes_;
  FileHeader header_;
  Output* covariance_ = nullptr;
};

}  // namespace

void generate_from_skill(const SkillFile& file, const MotionRequest& request, const std::string& sha256, Run& run) {
  if (!request.target.empty() && request.goals_file.empty()) {
    throw UsageError("generate.target", "--target chooses among the goals of --goals, or the primitives of a file");
  }
  const auto& columns = file.skill.columns;
  const auto goals = goals_of(request, columns, run);
  if (goals.empty()) throw UsageError("generate.no_goal", "a skill needs a goal: --goal X,Y,Z or --goals FILE");
  if (!request.goal_at.empty() && goals.size() > 1) {
    throw UsageError("generate.one_goal", "--goal-at moves one goal, and here are several");
  }
  Answer answer(file, request, sha256, run);
  LabelledTable table(run.output(), request.weights ? std::vector<std::string>{"signal", "basis", "mean", "sd"}
                                                    : value_columns(columns, request));
  for (std::size_t i = 0; i < goals.size(); ++i) {
    request.weights ? answer.weights(goals[i], table) : answer.motion(goals[i], i, table);
  }
}

}  // namespace lfd::cli
