// What is written and said of a motion; shared by the files that answer a request.
#pragma once

#include "lfdtools/cli/motion_request.hpp"
#include "lfdtools/io/labelled_table.hpp"

namespace lfd::cli {

/// `target 3: ` for messages; empty without a target.
[[nodiscard]] std::string target_prefix(const Labels& labels);

/// Columns of the trajectory that the request asks for.
[[nodiscard]] std::vector<std::string> value_columns(const std::vector<std::string>& columns,
                                                     const MotionRequest& request);
/// Those of a motion alone: t, positions, and on request their derivatives.
[[nodiscard]] Samples rows_of(const Motion& motion, const MotionRequest& request);

/// Direction of arrival and lateral deviation over the last 20 mm, against --approach.
/// @throws UsageError [usage.arity]
void report_approach(const Course& course, const Motion& motion, const std::string& name, const MotionRequest& request,
                     Run& run);

/// One document of --covariance; a goal that is not exactly known makes it joint.
void write_covariance_of(const MotionPosterior& posterior, const Motion& motion, const GoalSpread& goal,
                         const Vector& calibration, const FileHeader& header, const MotionRequest& request,
                         Output& out);

}  // namespace lfd::cli
