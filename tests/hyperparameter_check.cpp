// Where the search for hyperparameters ends, beside many plain descents, and what an evaluation of the evidence costs.
//
//   hyperparameter_check STARTS skill.json ...
//
// Of each skill, trained with the defaults, the objective is put together anew from the file: evidence of the principal
// directions of Y - M to the power targets / rows, times the priors. It is descended from STARTS log-uniform draws over
// four decades of every hyperparameter. A line a skill: what was found, what the best of the draws found, both in nats.
// Status 1 if fewer than 95 % of the skills are within 1e-3 nats of their best. STARTS 0: the costs alone.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "lfdtools/box_minimum.hpp"
#include "lfdtools/io/skill_file.hpp"
#include "lfdtools/random.hpp"

using namespace lfd;

namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A hyperparameter in logarithms: its prior, box, and the four decades of its draws.
struct Parameter {
  double median, sd, lower, upper, draw_from, draw_to;
};

Parameter length_scale(double range) {
  const double unit = std::log(range);
  return {unit + std::log(2.0), 1.0, unit + std::log(1e-3), unit + std::log(1e3), unit + std::log(1e-2),
          unit + std::log(1e2)};
}

Parameter variance(double smallest, double largest) {
  return {std::log(0.1), 2.0, std::log(smallest), std::log(largest), std::log(1e-3), std::log(10.0)};
}

std::vector<Parameter> parameters(const MvgpModel& model) {
  const Vector ranges = (model.X.colwise().maxCoeff() - model.X.colwise().minCoeff()).transpose();
  std::vector<Parameter> all;
  for (const auto& term : model.kernel.terms) {
    all.push_back(variance(1e-12, 1e4));
    if (term.type == KernelType::constant || term.type == KernelType::linear) continue;
    // Of an input that is always the same the largest range stands in.
    for (const int j : term.inputs) {
      all.push_back(length_scale(ranges[j] > 1e-9 * ranges.maxCoeff() ? ranges[j] : ranges.maxCoeff()));
    }
  }
  all.push_back(variance(1e-14, 1e2));
  return all;
}

/// Y - M of each model on its principal directions: those with over 1e-7 of the largest model's sum of squares.
std::vector<OutputBlock> principal_blocks(const Skill& skill) {
  std::vector<Matrix> residuals;
  double largest = 0;
  for (const auto& [inputs, outputs, process] : skill.models) {
    residuals.push_back(process.Y - mean_basis(process.mean, process.X) * process.coefficients);
    largest = std::max(largest, residuals.back().squaredNorm());
  }
  std::vector<OutputBlock> blocks;
  for (std::size_t m = 0; m < residuals.size(); ++m) {
    const MvgpModel& process = skill.models[m].process;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(residuals[m].transpose() * residuals[m]);
    const Eigen::Index r = (eigen.eigenvalues().array() > 1e-7 * largest).count();
    const auto left = static_cast<double>(residuals[m].cols() - r);
    if (r > 0) blocks.push_back({residuals[m] * eigen.eigenvectors().rightCols(r), process.psi, process.nu - left});
  }
  return blocks;
}

struct Found {
  double trained, best;
  int evaluations = 0;
};

Found check_skill(const Skill& skill, int starts) {
  const MvgpModel& model = skill.models.front().process;
  const auto all = parameters(model);
  const auto count = static_cast<Eigen::Index>(all.size());
  Evidence evidence(model.X, principal_blocks(skill), model.kernel, {});
  const double power =
      static_cast<double>(repetition_groups(skill.rows).size()) / static_cast<double>(skill.rows.size());
  const Objective objective = [&](const Vector& theta, Vector& gradient) {
    double value = power * evidence(theta, &gradient);
    gradient *= power;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Parameter& prior = all[static_cast<std::size_t>(i)];
      const double z = (theta[i] - prior.median) / prior.sd;
      value += z * z / 2;
      gradient[i] += z / prior.sd;
    }
    return value;
  };
  Vector trained(count), gradient(count), lower(count), upper(count), theta(count);
  trained << log_hyperparameters(model.kernel), std::log(model.noise_variance);
  Found found{objective(trained, gradient), std::numeric_limits<double>::infinity()};
  for (Eigen::Index i = 0; i < count; ++i) {
    lower[i] = all[static_cast<std::size_t>(i)].lower;
    upper[i] = all[static_cast<std::size_t>(i)].upper;
  }
  Random random(1);
  for (int s = 0; s < starts; ++s) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const Parameter& of = all[static_cast<std::size_t>(i)];
      theta[i] = random.uniform(of.draw_from, of.draw_to);
    }
    if (!std::isfinite(objective(theta, gradient))) continue;  // K' is not numerically positive definite
    const BoxMinimum end = minimize_in_box(objective, theta, lower, upper, {1000, 1e-4});
    found.evaluations += end.evaluations;
    found.best = std::min(found.best, end.value);
  }
  return found;
}

/// Time of one evaluation with its gradient at n = 60, the shortest of several runs.
void print_costs() {
  constexpr Eigen::Index n = 60;
  fmt::print("evidence and gradient, 60 rows, default kernel of 3 inputs\n{:>10} {:>12}\n", "outputs", "time [us]");
  Random random(2);
  const auto normal = [&] { return random.normal(); };
  const Matrix X = Matrix::NullaryExpr(n, 3, normal);
  for (const Eigen::Index d : {15, 45, 450}) {
    const Matrix Y = Matrix::NullaryExpr(n, d, normal);
    const Kernel kernel = sum_kernel(3);
    EvidenceSettings settings;
    settings.psi = Matrix::Ones(1, 1);
    settings.nu = static_cast<double>(d) + 2;
    Evidence evidence(X, Y, kernel, settings);
    Vector theta = Vector::Constant(evidence.size(), -1.0);
    Vector gradient;
    double shortest = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 20; ++run) {
      const double begin = seconds();
      for (int k = 0; k < 20; ++k) {
        theta[0] += 1e-6;
        (void)evidence(theta, &gradient);
      }
      shortest = std::min(shortest, (seconds() - begin) / 20);
    }
    fmt::print("{:>10} {:>12.0f}\n", d, 1e6 * shortest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int starts = argc > 1 ? std::atoi(argv[1]) : 0;
  int within = 0;
  Messages messages("hyperparameter_check");
  try {
    if (starts > 0) {
      fmt::print("{:<40} {:>12} {:>12} {:>10} {:>8}\n", "skill", "trained", "best", "over", "evals");
    }
    for (int i = 2; starts > 0 && i < argc; ++i) {
      std::vector<Input> inputs;
      inputs.emplace_back(std::string(argv[i]));
      auto document = JsonStream(std::move(inputs), messages).next();
      const Found found = check_skill(read_skill(*document).skill, starts);
      const double over = found.trained - found.best;
      within += over <= 1e-3 ? 1 : 0;
      fmt::print("{:<40} {:>12.4f} {:>12.4f} {:>10.1e} {:>8}\n", std::filesystem::path(argv[i]).stem().string(),
                 found.trained, found.best, over, found.evaluations / starts);
      std::fflush(stdout);
    }
  } catch (const Error& error) {
    messages.error(error);
    return 2;
  }
  if (starts == 0) {
    print_costs();
    return 0;
  }
  fmt::print("within 1e-3 nats of the best of {} starts: {} of {} skills\n", starts, within, argc - 2);
  return 100 * within >= 95 * (argc - 2) ? 0 : 1;
}
