// What ur10-ik writes in a row of a solution or of a joint path. For joint_path_request.cpp alone.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/cli/joint_path_request.hpp"

namespace lfd::cli {

/// Columns of the output behind the labels. @param passed  columns of the input that go on beside a path
[[nodiscard]] std::vector<std::string> joint_path_columns(const JointPathRequest& request,
                                                          const std::vector<std::string>& passed);

/// The row of one solution. @param number  of the solution, from 1   @param time  of its pose [s]
[[nodiscard]] Samples solution_row(const InverseKinematics& arm, const IkSolution& solution, std::size_t number,
                                   double time, const JointPathRequest& request);

/// The rows of a path, T x columns without those passed on.
[[nodiscard]] Samples path_rows(const InverseKinematics& arm, const JointPath& path, const JointRates& rates,
                                const JointPathRequest& request);

/// Rates of a path by the spline through its joints, so that speeds do not lag half a sample.
[[nodiscard]] JointRates rates_along(const JointPath& path);

/// Values at given times as values at others, linearly between them.
/// @param given  rising [s]   @param values  a row a given time   @param times  rising, within the given ones [s]
[[nodiscard]] Samples between(const Vector& given, const Samples& values, const Vector& times);

}  // namespace lfd::cli
