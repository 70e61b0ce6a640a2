#include "demonstrated_branch.hpp"

#include <fmt/format.h>

#include "lfdtools/io/demonstrations.hpp"
#include "lfdtools/posture.hpp"

namespace lfd::cli {

int demonstrated_branch(const std::string& file, const InverseKinematics& arm, Run& run) {
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

}  // namespace lfd::cli
