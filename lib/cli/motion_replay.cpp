// Primitives as they are, for skill-generate.
#include <fmt/format.h>

#include "motion_goals.hpp"
#include "motion_rows.hpp"

namespace lfd::cli {

void replay(std::vector<DmpFile> files, const MotionRequest& request, Run& run) {
  if (!request.target.empty()) {
    std::erase_if(files, [&](const DmpFile& file) { return file.header.labels.target != request.target; });
  }
  if (files.empty())
    throw UsageError("generate.no_target", fmt::format("no primitive is of target '{}'", request.target));
  if (files.size() > 1) {
    throw UsageError(
        "generate.which",
        request.target.empty()
            ? fmt::format("{} primitives: --target says which one to replay", files.size())
            : fmt::format("{} primitives are of target '{}', and one is replayed: dmp-fit makes one a target of the "
                          "references of gmr-regress",
                          files.size(), request.target));
  }
  if (request.weights)
    throw UsageError("generate.weights", "--weights needs a skill; a primitive's weights are in its file");
  if (const std::string option = request.needs_posterior(); !option.empty()) {
    throw UsageError("generate.no_posterior",
                     fmt::format("{} needs a skill: a primitive is one motion, and says nothing of others", option));
  }
  const DmpFile& file = files.front();
  const std::size_t D = file.header.columns.size();
  MotionRequest rest = request;
  rest.target.clear();
  auto goals = goals_of(rest, file.header.columns, run);
  if (goals.empty()) {
    goals.push_back({file.header.labels, file.dmp.goal, {}, request.duration});
    if (request.start) goals.back().start = position(*request.start, D, "--start");
  }
  LabelledTable table(run.output(), value_columns(file.header.columns, request));
  for (const Goal& goal : goals) {
    Course course;
    course.primitive = file.dmp;
    Dmp& dmp = course.primitive;
    dmp.goal = goal.position;
    dmp.start = goal.start.value_or(dmp.start);
    dmp.tau = goal.duration.value_or(dmp.tau);
    if (request.start_velocity) course.start_velocity = position(*request.start_velocity, D, "--start-velocity");
    course.changes = changes_of(request, D);
    for (GoalChange& change : course.changes) change.weights = dmp.weights;
    run.figure("duration", dmp.tau);
    run.figure("duration_sd", 0);
    const Motion motion = generate(course, request.dt);
    if (request.approach) report_approach(course, motion, target_prefix(goal.labels), request, run);
    table.write(goal.labels, rows_of(motion, request));
  }
}

}  // namespace lfd::cli
