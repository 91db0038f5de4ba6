#include "problems/suites/more_wild.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "problems/classic/mgh_problem.hpp"
#include "problems/suites/more_wild_functions.hpp"

namespace odobench {
namespace {

struct Case {
  const char* function;
  int n;
  bool far;      // also from ten times the start
  bool several;  // the function appears in several dimensions
  const char* hard;
};

// In the order of the paper's table.
constexpr Case kCases[] = {
    {"linear-full-rank", 9, true, false, "nothing: a linear problem"},
    {"linear-rank-1", 7, true, false, "a line of minima, badly scaled"},
    {"linear-rank-1-zero", 7, true, false, "a space of minima, parameters without effect"},
    {"rosenbrock", 2, true, false, "a bent valley"},
    {"helical-valley", 3, true, false, "a helical valley with a jump of the angle"},
    {"powell-singular", 4, true, false, "a singular Jacobian at the minimum"},
    {"freudenstein-roth", 2, true, false, "a second minimum at the end of a valley"},
    {"bard", 3, true, false, "poles, a valley to infinity"},
    {"kowalik-osborne", 4, false, false, "poles, a valley to infinity"},
    {"meyer", 3, false, false, "scales from 1e-3 to 1e4, a long exponential valley"},
    {"watson", 6, true, true, "nearly dependent parameters"},
    {"watson", 9, true, true, "nearly dependent parameters, condition 1e8"},
    {"watson", 12, true, true, "nearly dependent parameters, condition 1e12"},
    {"box-3d", 3, false, false, "lines of equal cost"},
    {"jennrich-sampson", 2, false, false, "large residuals, plateaus"},
    {"brown-dennis", 4, true, false, "large residuals"},
    {"chebyquad", 6, false, true, "permutations of the nodes"},
    {"chebyquad", 7, false, true, "permutations of the nodes"},
    {"chebyquad", 8, false, true, "permutations of the nodes, no zero"},
    {"chebyquad", 9, false, true, "permutations of the nodes"},
    {"chebyquad", 10, false, true, "permutations of the nodes, local minima"},
    {"chebyquad", 11, false, true, "permutations of the nodes, local minima"},
    {"brown-almost-linear", 10, false, false, "a product beside linear equations, a second minimum"},
    {"osborne-1", 5, false, false, "two exponentials of nearly one rate"},
    {"osborne-2", 11, true, false, "an exponential and three peaks, local minima"},
    {"bdqrtic", 8, false, true, "parameters that only fourth powers see"},
    {"bdqrtic", 10, false, true, "parameters that only fourth powers see"},
    {"bdqrtic", 11, false, true, "parameters that only fourth powers see"},
    {"bdqrtic", 12, false, true, "parameters that only fourth powers see"},
    {"cube", 5, false, true, "a valley that bends with the third power"},
    {"cube", 6, false, true, "a valley that bends with the third power"},
    {"cube", 8, false, true, "a valley that bends with the third power"},
    {"mancino", 5, true, true, "costs of 1e9, rippled"},
    {"mancino", 8, false, true, "costs of 1e9, rippled"},
    {"mancino", 10, false, true, "costs of 1e9, rippled"},
    {"mancino", 12, true, true, "costs of 1e9, rippled"},
    {"heart8", 8, true, false, "polynomials of degree four, valleys, local minima"},
};

const MghFunction& function_of(std::string_view name) {
  for (const auto* list : {&mgh_fixed_functions(), &mgh_variable_functions(), &more_wild_functions()})
    for (const MghFunction& function : *list)
      if (name == function.name) return function;
  throw std::logic_error(fmt::format("more_wild: no function '{}'", name));
}

bool is_new(std::string_view name) {
  const auto& list = more_wild_functions();
  return std::any_of(list.begin(), list.end(), [&](const MghFunction& f) { return name == f.name; });
}

int residual_count(const Case& c) {
  const std::string_view name = c.function;
  if (name == "linear-full-rank") return 45;
  if (name.starts_with("linear-rank-1")) return 35;
  return function_of(name).residual_count(c.n);
}

Vector start_of(const Case& c, int factor) {
  const std::string_view name = c.function;
  Vector start = name == "watson" ? Vector(Vector::Constant(c.n, 0.5)) : function_of(name).start(c.n);
  if (name == "osborne-1") start[2] = 1;
  return factor * start;
}

MghOptimum optimum_of(const Case& c) {
  const std::string_view name = c.function;
  if (is_new(name)) return more_wild_optimum(name, c.n);
  if (name == "chebyquad" && c.n == 11) return {0.00279976155186576664, {}};
  return mgh_optimum(name, c.n, residual_count(c));
}

std::string case_name(const Case& c, int factor) {
  return fmt::format("mw:{}{}{}", c.function, c.several ? fmt::format("-{}", c.n) : "",
                     factor == 1 ? "" : "/10");
}

template <class Act>
void for_each_case(const Act& act) {
  for (const Case& c : kCases)
    for (const int factor : {1, 10})
      if (factor == 1 || c.far) act(c, factor);
}

}  // namespace

std::vector<ClassicEntry> more_wild_entries() {
  std::vector<ClassicEntry> list;
  for_each_case([&](const Case& c, int factor) {
    ClassicEntry entry{
        case_name(c, factor),
        "mw",
        c.n,
        DimensionRule::exactly(c.n),
        residual_count(c),
        fmt::format("More, Wild (2009) {}{}", c.function, factor == 1 ? "" : ", 10 times the start"),
        optimum_of(c).cost};
    entry.hard = c.hard;
    list.push_back(std::move(entry));
  });
  return list;
}

Problem make_more_wild_problem(const std::string& name) {
  std::optional<Problem> problem;
  for_each_case([&](const Case& c, int factor) {
    if (name == case_name(c, factor))
      problem.emplace(
          MghProblem(name, function_of(c.function), optimum_of(c), residual_count(c), start_of(c, factor)));
  });
  if (!problem) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  return *problem;
}

}  // namespace odobench
