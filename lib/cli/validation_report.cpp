#include "lfdtools/cli/validation_report.hpp"

#include <fmt/format.h>

#include <optional>

#include "lfdtools/io/labelled_table.hpp"

namespace lfd::cli {
namespace {

/// Millimetres in a column of the table.
std::string cell(std::optional<double> metres) {
  return metres ? fmt::format("{:>8.1f}", 1e3 * *metres) : fmt::format("{:>8}", "-");
}

}  // namespace

void write_scores(const Validation& validation, Output& out) {
  LabelledTable table(out, {"method", "rmse", "end_error", "dtw", "outside", "coverage95", "path95"});
  for (const auto& score : validation.scores) {
    CsvWriter& row = table.begin(score.labels);
    row.labels(score.labels);
    row.text(score.method);
    for (const double value : {score.rmse, score.end_error, score.dtw, score.outside}) row.number(value);
    if (score.band95) {
      row.number(score.band95->pointwise);
      row.number(score.band95->path);
    } else {
      row.text("");
      row.text("");
    }
    row.end_row();
  }
}

void write_table(const Validation& validation, Output& out) {
  const auto errors = errors_by_method(validation);
  std::string header = fmt::format("{:<18}{:>8}", "rmse [mm]", "mean");
  for (std::size_t i = 0; i < validation.noise_floor.size(); ++i) {
    const Labels& labels = validation.scores[i * errors.size()].labels;
    header += fmt::format("{:>8}", labels.teacher ? describe(labels) : labels.target.value_or("-"));
  }
  out.write(header + "\n");
  for (const auto& method : errors) {
    std::string cells = cell(method.mean);
    for (const double rmse : method.rmse) cells += cell(rmse);
    out.write(fmt::format("{:<18}{}\n", method.method, cells));
  }
  std::string floors = cell(mean_noise_floor(validation));
  for (const auto& floor : validation.noise_floor) floors += cell(floor);
  out.write(fmt::format("{:<18}{}\n", "noise floor", floors));
  if (const auto ratio = against_best_simple(validation)) {
    out.write(fmt::format("{} over {}: {:.2f}, 95 % interval {:.2f} to {:.2f}\n", ratio->method, ratio->opponent,
                          ratio->ratio, ratio->low, ratio->high));
  }
}

void write_reliability(const Validation& validation, Output& out) {
  CsvWriter table(out, {"method", "nominal", "pointwise", "path", "width"});
  for (const auto& row : reliability(validation)) {
    table.text(row.method);
    for (const double value : {row.nominal, row.pointwise, row.path, row.width}) table.number(value);
    table.end_row();
  }
}

void report(const Validation& validation, Run& run) {
  for (const auto& method : errors_by_method(validation)) run.figure("rmse_" + method.method, method.mean);
  if (const auto floor = mean_noise_floor(validation)) run.figure("noise_floor", *floor);
  if (const auto ratio = against_best_simple(validation)) {
    run.figure("ratio", ratio->ratio);
    run.figure("ratio_low", ratio->low);
    run.figure("ratio_high", ratio->high);
  }
  for (const auto& time : validation.times) {
    run.detail("validate.time", fmt::format("{}: {:.3f} s to learn and predict", time.method, time.seconds));
  }
  if (validation.lifted_gates > 0) {
    run.messages().note("validate.lifted_gate",
                        fmt::format("the gate goal_change of --scaling goal would have refused {} training rows of "
                                    "--paper",
                                    validation.lifted_gates));
  }
}

}  // namespace lfd::cli
