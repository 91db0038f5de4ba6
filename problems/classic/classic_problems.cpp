#include "problems/classic/classic_problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "problems/classic/more_garbow_hillstrom.hpp"
#include "problems/classic/nist.hpp"
#include "problems/classic/test_functions.hpp"

namespace odobench {

DimensionRule DimensionRule::at_least(int n, int step) {
  return {n, std::numeric_limits<int>::max(), step};
}

bool DimensionRule::allows(int n) const {
  return n >= least && n <= most && (n - least) % step == 0;
}

std::string DimensionRule::text() const {
  if (least == most) return fmt::format("{}", least);
  const bool open = most == std::numeric_limits<int>::max();
  if (step != 1) {
    const std::string list = fmt::format("{}, {}, {}, ...", least, least + step, least + 2 * step);
    return open ? list : fmt::format("{}, {}", list, most);
  }
  return open ? fmt::format(">= {}", least) : fmt::format("{}..{}", least, most);
}

const std::vector<ClassicEntry>& classic_catalogue() {
  static const std::vector<ClassicEntry> catalogue = [] {
    std::vector<ClassicEntry> all;
    for (const auto& family : {test_function_entries(), nist_entries(), mgh_entries()})
      all.insert(all.end(), family.begin(), family.end());
    return all;
  }();
  return catalogue;
}

const std::vector<std::string>& classic_problem_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const ClassicEntry& entry : classic_catalogue()) list.push_back(entry.name);
    return list;
  }();
  return names;
}

const ClassicEntry* find_classic_problem(const std::string& name) {
  for (const ClassicEntry& entry : classic_catalogue())
    if (entry.name == name) return &entry;
  return nullptr;
}

Problem make_classic_problem(const std::string& name, int dimension) {
  const ClassicEntry* entry = find_classic_problem(name);
  if (entry == nullptr) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  const int n = dimension == 0 ? entry->dimension : dimension;
  if (!entry->dimensions.allows(n))
    throw std::invalid_argument(
        fmt::format("problem '{}': dimension {}; expected {}", name, n, entry->dimensions.text()));
  if (entry->family == "nist") return make_nist_problem(name);
  if (entry->family == "mgh") return make_mgh_problem(name, n);
  return make_test_function(name, n);
}

double log_relative_error(const ConstVectorRef& x, const std::vector<Vector>& minimisers) {
  if (minimisers.empty()) throw std::invalid_argument("log relative error: no known minimiser");
  double best = 0;
  for (const Vector& c : minimisers) {
    if (c.size() != x.size())
      throw std::invalid_argument(
          fmt::format("log relative error: {} parameters, expected {}", x.size(), c.size()));
    double worst = kMostDigits;
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      const double error = c[i] == 0 ? std::abs(x[i]) : std::abs((x[i] - c[i]) / c[i]);
      worst = std::isfinite(error) ? std::min(worst, -std::log10(error)) : 0;
    }
    best = std::max(best, worst);
  }
  return best;
}

bool reaches_known_optimum(const Problem& problem, const ConstVectorRef& x, double cost) {
  if (!problem.known_optimum())
    throw std::logic_error(fmt::format("problem '{}' has no known optimum", problem.name()));
  if (problem.name().rfind("nist:", 0) == 0) return log_relative_error(x, problem.known_minimisers()) >= 6;
  const double best = *problem.known_optimum();
  if (problem.name().rfind("bbob:", 0) == 0) return cost - best <= 1e-8;
  return cost - best <= std::max(1e-6 * std::abs(best), 1e-12);
}

}  // namespace odobench
