#include "bench/studies/calibration/rule_remark.hpp"

#include <fmt/format.h>

namespace odobench {

std::string rule_remark(const LoadedProblem& loaded, const RunRecord& record) {
  using robots::IntegrationRule;
  if (!loaded.calibration || !loaded.dataset || !record.cost || record.parameters.empty()) return "";
  const CalibrationProblem& problem = *loaded.calibration;
  if (problem.options().as_in_thesis()) return "";
  Vector z(static_cast<Eigen::Index>(record.parameters.size()));
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    z[static_cast<Eigen::Index>(i)] = record.parameters[i].value;
  double lowest = 0.25 * *record.cost;
  std::string text;
  for (const IntegrationRule rule : {IntegrationRule::Euler, IntegrationRule::Arc}) {  // midpoint: as arc
    CalibrationOptions options = problem.options();
    if (options.rule == rule) continue;
    options.rule = rule;
    const double cost =
        CalibrationProblem(loaded.dataset->robot, problem.recordings(), options, problem.kernel()).cost(z);
    if (!(cost < lowest)) continue;
    lowest = cost;
    text = fmt::format(
        "the drives look as if poses were summed up by the rule {0}: J of the same parameters is {1:.4g} by "
        "it, {2:.4g} by {3}; try --integration={0}",
        name_of(rule), cost, *record.cost, name_of(problem.options().rule));
  }
  return text;
}

}  // namespace odobench
