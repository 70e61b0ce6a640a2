// Generates motions for new goals (paper Table 1, step 3), or replays primitives.
#include <fmt/format.h>

#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/dmp_file.hpp"
#include "lfdtools/io/goals.hpp"
#include "lfdtools/io/labelled_table.hpp"
#include "lfdtools/io/skill_file.hpp"

using namespace lfd;

namespace {

struct Request {
  std::vector<std::vector<double>> goals;
  std::string goals_file;
  std::string target;
  std::optional<std::vector<double>> start;
  std::optional<double> duration;
  std::optional<double> dt;
  bool weights = false;
  bool derivatives = false;
};

Vector position(const std::vector<double>& numbers, std::size_t D, const char* option) {
  if (numbers.size() != D) {
    throw UsageError("usage.arity", fmt::format("{} takes {} numbers here, one a signal, not {}", option, D, numbers.size()));
  }
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(D));
}

std::vector<Goal> goals_of(const Request& request, const std::vector<std::string>& columns, cli::Run& run) {
  std::vector<Goal> goals;
  for (const auto& numbers : request.goals) {
    Goal goal;
    if (request.goals.size() > 1) goal.labels.target = fmt::format("{}", goals.size() + 1);
    goal.position = position(numbers, columns.size(), "--goal");
    goals.push_back(goal);
  }
  if (!request.goals_file.empty()) goals = read_goals(request.goals_file, columns, run.messages());
  if (!request.target.empty() && !request.goals_file.empty()) {
    std::erase_if(goals, [&](const Goal& goal) { return goal.labels.target != request.target; });
    if (goals.empty()) throw UsageError("generate.no_target", fmt::format("no goal is of target '{}'", request.target));
  }
  for (auto& goal : goals) {
    if (request.start) goal.start = position(*request.start, columns.size(), "--start");
    if (request.duration) goal.duration = request.duration;
  }
  return goals;
}

std::vector<std::string> value_columns(const std::vector<std::string>& columns, bool derivatives) {
  auto names = joined({"t"}, columns);
  if (derivatives) names = joined(joined(names, prefixed("v_", columns)), prefixed("a_", columns));
  return names;
}

void write_motion(LabelledTable& table, const Labels& labels, const Dmp& dmp, const Request& request) {
  const Motion motion = generate(dmp, request.dt);
  Samples rows = beside(motion.times, motion.positions);
  if (request.derivatives) rows = beside(rows, beside(motion.velocities, motion.accelerations));
  table.write(labels, rows);
}

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

void generate_from_skill(const SkillFile& file, const Request& request, cli::Run& run) {
  const Skill& skill = file.skill;
  const auto goals = goals_of(request, skill.columns, run);
  if (goals.empty()) throw UsageError("generate.no_goal", "a skill needs a goal: --goal X,Y,Z or --goals FILE");
  const SkillPredictor predictor(skill);
  LabelledTable table(run.output(), request.weights ? std::vector<std::string>{"signal", "basis", "mean", "sd"}
                                                    : value_columns(skill.columns, request.derivatives));
  for (const Goal& goal : goals) {
    const std::string name = goal.labels.target ? describe(goal.labels) + ": " : std::string();
    if (!goal.start && skill.start_spread > 0.02) {
      run.refuse("start", fmt::format("{}the demonstrations start up to {:.1f} mm apart, so a goal needs a start"
                                      "", name, 1e3 * skill.start_spread));
    }
    const Vector change = goal.position - goal.start.value_or(skill.start);
    const double excess = region_excess(skill, change);
    if (excess > 0) {
      run.refuse("region", fmt::format("{}goal - start lies {:.1f} mm outside the demonstrated region (range of each signal, "
                                       "widened by a tenth)", name, 1e3 * excess));
    }
    if (request.weights) {
      write_weights(table, goal, predictor.weights(change), skill.columns);
    } else {
      write_motion(table, goal.labels, predictor.primitive(goal), request);
    }
  }
}

/// Replays a primitive as it is; a goal, start or duration of the command line takes the place of its own.
void replay(std::vector<DmpFile> files, const Request& request, cli::Run& run) {
  if (!request.target.empty()) {
    std::erase_if(files, [&](const DmpFile& file) { return file.header.labels.target != request.target; });
  }
  if (files.empty()) throw UsageError("generate.no_target", fmt::format("no primitive is of target '{}'", request.target));
  if (files.size() > 1) {
    throw UsageError("generate.which", fmt::format("{} primitives: --target says which one to replay", files.size()));
  }
  if (request.weights) throw UsageError("generate.weights", "--weights needs a skill; a primitive's weights are in its file");
  const DmpFile& file = files.front();
  Request rest = request;
  rest.target.clear();
  auto goals = goals_of(rest, file.header.columns, run);
  if (goals.empty()) {
    goals.push_back({file.header.labels, file.dmp.goal, {}, request.duration});
    if (request.start) goals.back().start = position(*request.start, file.header.columns.size(), "--start");
  }
  LabelledTable table(run.output(), value_columns(file.header.columns, request.derivatives));
  for (const Goal& goal : goals) {
    Dmp dmp = file.dmp;
    dmp.goal = goal.position;
    dmp.start = goal.start.value_or(dmp.start);
    dmp.tau = goal.duration.value_or(dmp.tau);
    write_motion(table, goal.labels, dmp, request);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  cli::Program program("skill-generate", "Generate the motion of a skill for new goals, or replay a primitive.");
  program.reads("skill JSON or DMP JSON");
  program.number_lists("--goal", request.goals, 0, "goal X,Y,Z [m]; repeatable");
  program.path("--goals", request.goals_file, "goals CSV: [target,][teacher,]x,y,z[,start_x,...][,duration]");
  program.text("--target", request.target, "of the goals, or of a file of primitives, this one alone");
  program.numbers("--start", request.start, {}, "start of the motion [m] (default: the skill's)");
  program.number("--duration", request.duration, cli::positive, "duration [s] (default: the skill's for this goal)");
  program.number("--dt", request.dt, cli::positive, "time step [s] (default: a 200th of the duration)");
  program.flag("--weights", request.weights, "write the predicted weights and their latent standard deviations instead");
  program.flag("--derivatives", request.derivatives, "add columns v_ and a_: velocity and acceleration");
  program.gate("region", "goal outside the demonstrated region");
  program.gate("start", "no start is given though the demonstrations start over 20 mm apart");
  program.check([&] {
    if (!request.goals.empty() && !request.goals_file.empty()) {
      throw UsageError("usage.exclusive", "--goal and --goals exclude each other");
    }
  });
  program.example("skill-generate skill.json --goal 0.45,0.1,0.2", "one motion, to standard output");
  program.example("mvgpr-train dmp.json | skill-generate --goals holes.csv --dt 0.01 -o motions.csv", "several, at 100 Hz");
  program.example("skill-generate dmp.json --target 3", "what the primitive of target 3 does by itself");
  return program.run(argc, argv, [&](cli::Run& run) {
    JsonStream stream(run.open(), run.messages(), run.json_options());
    std::vector<DmpFile> primitives;
    while (auto document = stream.next()) {
      if (primitives.empty() && document->format() != "lfdtools.dmp") {
        const SkillFile file = read_skill(*document);
        if (stream.next()) throw DataError("json.one_document", "a skill file holds one skill");
        return generate_from_skill(file, request, run);
      }
      primitives.push_back(read_dmp(*document));
    }
    replay(std::move(primitives), request, run);
  });
}
