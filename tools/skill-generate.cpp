// Generates motions for new goals (paper Table 1, step 3), or replays primitives.
#include "lfdtools/cli/motion_request.hpp"
#include "lfdtools/cli/program.hpp"
#include "lfdtools/io/transform_file.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  cli::MotionRequest request;
  cli::Program program("skill-generate", "Generate the motion of a skill for new goals, or replay a primitive.");
  program.reads("skill JSON or DMP JSON").uses_jobs().uses_seed();
  cli::declare_motion_request(program, request);
  return program.run(argc, argv, [&](cli::Run& run) {
    if (!request.camera.empty()) {
      request.camera_pose = load_transform(request.camera, run.messages(), run.options().strict);
    }
    JsonStream stream(run.open(), run.messages(), run.json_options());
    std::vector<DmpFile> primitives;
    while (auto document = stream.next()) {
      if (primitives.empty() && document->format() != "lfdtools.dmp") {
        const SkillFile file = read_skill(*document);
        if (stream.next()) throw DataError("json.one_document", "a skill file holds one skill");
        return cli::generate_from_skill(file, request, stream.sha256(), run);
      }
      primitives.push_back(read_dmp(*document));
    }
    cli::replay(std::move(primitives), request, run);
  });
}
