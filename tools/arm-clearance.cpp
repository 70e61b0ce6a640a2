// How far every link of the arm stays from what stands around it.
#include "lfdtools/cli/clearance_report.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  cli::ClearanceRequest request;
  cli::Program program("arm-clearance",
                       "Tell how far every link of the arm stays from obstacles and from the arm itself.");
  cli::declare_clearance(program, request);
  return program.run(argc, argv, [&](cli::Run& run) { cli::report_clearance(request, run); });
}
