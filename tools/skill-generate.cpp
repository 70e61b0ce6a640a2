// Generates motions for new goals (paper Table 1, step 3), or replays primitives.
#include "lfdtools/cli/motion_request.hpp"
#include "lfdtools/cli/program.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  cli::MotionRequest request;
  cli::Program program("skill-generate", "Generate the motion of a skill for new goals, or replay a primitive.");
  program.reads("skill JSON or DMP JSON");
  program.number_lists("--goal", request.goals, 0, "goal X,Y,Z [m]; repeatable");
  program.path("--goals", request.goals_file, "goals CSV: [target,][teacher,]x,y,z[,start_x,...][,duration]");
  program.text("--target", request.target, "of the goals, or of a file of primitives, this one alone");
  program.numbers("--start", request.start, {}, "start of the motion [m] (default: the skill's)");
  program.number("--duration", request.duration, cli::positive, "duration [s] (default: the skill's for this goal)");
  program.number("--dt", request.dt, cli::positive, "time step [s] (default: a 200th of the duration)");
  program.flag("--weights", request.weights,
               "write the predicted weights and their latent standard deviations instead");
  program.flag("--derivatives", request.derivatives, "add columns v_ and a_: velocity and acceleration");
  program.gate("region", "goal outside the demonstrated region");
  program.gate("start", "no start is given though the demonstrations start over 20 mm apart");
  program.check([&] {
    if (!request.goals.empty() && !request.goals_file.empty()) {
      throw UsageError("usage.exclusive", "--goal and --goals exclude each other");
    }
    if (request.goals_file == "-") throw UsageError("usage.value", "--goals takes a file, not standard input");
  });
  program.example("skill-generate skill.json --goal 0.45,0.1,0.2", "one motion, to standard output");
  program.example("mvgpr-train dmp.json | skill-generate --goals holes.csv --dt 0.01 -o motions.csv",
                  "several, at 100 Hz");
  program.example("skill-generate dmp.json --target 3", "what the primitive of target 3 does by itself");
  return program.run(argc, argv, [&](cli::Run& run) {
    JsonStream stream(run.open(), run.messages(), run.json_options());
    std::vector<DmpFile> primitives;
    while (auto document = stream.next()) {
      if (primitives.empty() && document->format() != "lfdtools.dmp") {
        const SkillFile file = read_skill(*document);
        if (stream.next()) throw DataError("json.one_document", "a skill file holds one skill");
        return cli::generate_from_skill(file, request, run);
      }
      primitives.push_back(read_dmp(*document));
    }
    cli::replay(std::move(primitives), request, run);
  });
}
