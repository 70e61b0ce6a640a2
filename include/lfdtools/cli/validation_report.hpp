// What skill-validate writes: scores, a readable table, reliability of bands, figures of the run.
#pragma once

#include "lfdtools/cli/run.hpp"
#include "lfdtools/comparison.hpp"

namespace lfd::cli {

/// CSV `target,[teacher,]method,rmse,end_error,dtw,outside,coverage95,path95`, a row a target and method.
void write_scores(const Validation& validation, Output& out);

/// Methods down, targets across, rmse in mm; below them the noise floor, and the default skill beside the best simple
/// opponent if both were judged.
void write_table(const Validation& validation, Output& out);

/// CSV `method,nominal,pointwise,path,width`, a row a method with a band and nominal level.
void write_reliability(const Validation& validation, Output& out);

/// Mean rmse of each method, noise floor and the ratio to the best simple opponent for --summary; processor times and
/// lifted gates as notes.
void report(const Validation& validation, Run& run);

}  // namespace lfd::cli
