#include "lfdtools/singularity.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lfd {

double manipulability(const Jacobian& J) {
  return std::abs(J.determinant());
}

SingularityDistances singularity_distances(const UrGeometry& geometry, const Joints& q) {
  const UrGeometry& g = geometry;
  const Joints a = q + g.offset;
  const double X = g.a2 * std::cos(a[1]) + g.a3 * std::cos(a[1] + a[2]) + g.d5 * std::sin(a[1] + a[2] + a[3]);
  const double r = std::hypot(X, g.d4);
  const double outer = std::abs(g.a2) + std::abs(g.a3), inner = std::abs(std::abs(g.a2) - std::abs(g.a3));
  // Squares of sines of the half angle in place of differences of lengths, which lose their digits near the ends.
  const bool same_sign = g.a2 * g.a3 > 0.0;
  const double s = std::sin(0.5 * a[2]), c = std::cos(0.5 * a[2]);
  const double bent = 4.0 * std::abs(g.a2 * g.a3) * (same_sign ? s * s : c * c);    // outer^2 - rho^2
  const double opened = 4.0 * std::abs(g.a2 * g.a3) * (same_sign ? c * c : s * s);  // rho^2 - inner^2
  const double rho = std::sqrt(inner * inner + opened);
  SingularityDistances distances;
  distances.shoulder = r > 0.0 ? X * X / (r + std::abs(g.d4)) : 0.0;
  distances.elbow = std::min(bent / (outer + rho), rho > 0.0 ? opened / (rho + inner) : 0.0);
  distances.wrist = std::abs(std::sin(a[4]));
  return distances;
}

std::string nearest_singularity(const SingularityDistances& distances) {
  const double least = std::min({distances.shoulder, distances.elbow, distances.wrist});
  if (!(least < 0.1)) return {};
  if (least == distances.wrist) return fmt::format("the wrist singularity (|sin q5| = {:.2g})", least);
  return fmt::format("the {} singularity ({:.2g} mm)", least == distances.elbow ? "elbow" : "shoulder", 1e3 * least);
}

}  // namespace lfd
