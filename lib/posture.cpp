#include "lfdtools/posture.hpp"

#include <algorithm>
#include <array>

#include "lfdtools/error.hpp"
#include "lfdtools/singularity.hpp"

namespace lfd {
namespace {

constexpr double near_singular = 0.005;  // [m]
constexpr double near_wrist = 0.05;      // |sin q5|
constexpr double border = 1e-10;         // [m]: where rounding decides on which side of a singularity the joints are
constexpr double border_wrist = 1e-8;    // |sin q5|

int most(const std::array<Eigen::Index, 8>& votes) {
  return static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

}  // namespace

DemonstratedPosture demonstrated_posture(const InverseKinematics& arm, const std::vector<Samples>& demonstrations) {
  if (demonstrations.empty()) throw DataError("posture.shape", "there is no demonstration");
  DemonstratedPosture posture;
  std::array<Eigen::Index, 8> demonstrations_in{};
  for (const Samples& joints : demonstrations) {
    if (joints.rows() < 1 || joints.cols() != 6) {
      throw DataError("posture.shape", "a demonstration needs a sample at least, and six joints");
    }
    std::array<Eigen::Index, 8> clear{}, all{};
    Eigen::Index singular = 0;
    for (Eigen::Index t = 0; t < joints.rows(); ++t) {
      const Joints q = joints.row(t).transpose();
      const auto branch = static_cast<std::size_t>(arm.branch(q));
      const SingularityDistances d = singularity_distances(arm.geometry(), q);
      const bool near = std::min(d.shoulder, d.elbow) < near_singular || d.wrist < near_wrist;
      ++all[branch];
      clear[branch] += near ? 0 : 1;
      singular += near ? 1 : 0;
    }
    const int branch = most(singular < joints.rows() ? clear : all);
    const auto own = static_cast<std::size_t>(branch);
    posture.branches.push_back(branch);
    posture.samples_singular.push_back(singular);
    posture.samples_elsewhere.push_back(singular < joints.rows() ? joints.rows() - singular - clear[own]
                                                                 : joints.rows() - all[own]);
    ++demonstrations_in[own];
  }
  posture.branch = most(demonstrations_in);
  posture.elsewhere =
      demonstrations.size() - static_cast<std::size_t>(demonstrations_in[static_cast<std::size_t>(posture.branch)]);
  return posture;
}

int border_bits(const InverseKinematics& arm, const Joints& q) {
  const SingularityDistances d = singularity_distances(arm.geometry(), q);
  return (d.shoulder < border ? 4 : 0) + (d.wrist < border_wrist ? 2 : 0) + (d.elbow < border ? 1 : 0);
}

bool keeps_branch(const InverseKinematics& arm, const Joints& q, int branch) {
  const int other = arm.branch(q) ^ branch;
  return other == 0 || (other & ~border_bits(arm, q)) == 0;
}

std::vector<int> branches_along(const InverseKinematics& arm, const Samples& joints) {
  const auto T = static_cast<std::size_t>(joints.rows());
  std::vector<int> branches(T), borders(T);
  for (std::size_t t = 0; t < T; ++t) {
    const Joints q = joints.row(static_cast<Eigen::Index>(t)).transpose();
    branches[t] = arm.branch(q);
    borders[t] = border_bits(arm, q);
  }
  for (const int bit : {4, 2, 1}) {
    const auto decided = std::find_if(borders.begin(), borders.end(), [&](int bits) { return (bits & bit) == 0; });
    const auto first = decided == borders.end() ? 0 : static_cast<std::size_t>(decided - borders.begin());
    int side = T > 0 ? branches[first] & bit : 0;
    for (std::size_t t = 0; t < T; ++t) {
      if ((borders[t] & bit) == 0) side = branches[t] & bit;
      branches[t] = (branches[t] & ~bit) | side;
    }
  }
  return branches;
}

}  // namespace lfd
