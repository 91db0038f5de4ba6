#include "problems/classic/more_garbow_hillstrom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "problems/classic/mgh_functions.hpp"
#include "problems/classic/mgh_problem.hpp"

namespace odobench {
namespace {

constexpr std::array kFactors{1, 10, 100};

Vector far_start(const MghFunction& function, int n, int factor) {
  const Vector start = function.start(n);
  if (factor != 1 && start.isZero(0)) return Vector::Constant(n, factor);
  return factor * start;
}

std::string problem_name(const MghFunction& function, int factor) {
  return factor == 1 ? fmt::format("mgh:{}", function.name) : fmt::format("mgh:{}/{}", function.name, factor);
}

void for_each(const std::function<void(const MghFunction&, int factor)>& act) {
  for (const std::vector<MghFunction>* list : {&mgh_fixed_functions(), &mgh_variable_functions()})
    for (const MghFunction& function : *list)
      for (const int factor : kFactors) act(function, factor);
}

}  // namespace

std::vector<ClassicEntry> mgh_entries() {
  std::vector<ClassicEntry> list;
  for_each([&](const MghFunction& f, int factor) {
    const int n = f.dimension, m = f.residual_count(n);
    const std::string where = factor == 1 ? "" : fmt::format(", {} times the start", factor);
    list.push_back({problem_name(f, factor), "mgh", n, f.dimensions, m,
                    fmt::format("More, Garbow, Hillstrom (1981) {}{}", f.title, where),
                    mgh_optimum(f.name, n, m).cost});
  });
  return list;
}

Problem make_mgh_problem(const std::string& name, int dimension) {
  std::optional<Problem> problem;
  for_each([&](const MghFunction& function, int factor) {
    if (name == problem_name(function, factor))
      problem.emplace(MghProblem(name, function,
                                 mgh_optimum(function.name, dimension, function.residual_count(dimension)),
                                 function.residual_count(dimension), far_start(function, dimension, factor)));
  });
  if (!problem) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  return *problem;
}

}  // namespace odobench
