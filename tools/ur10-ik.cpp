// Joint paths along hand paths, or every inverse kinematics solution of each pose.
#include "lfdtools/cli/joint_path_request.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  cli::JointPathRequest request;
  cli::Program program("ur10-ik", "Find the joint path along a path of the tool tip.");
  program.reads("trajectory CSV with x,y,z and, unless given here, qw,qx,qy,qz");
  cli::declare_joint_path_request(program, request);
  return program.run(argc, argv, [&](cli::Run& run) { cli::answer(request, run); });
}
