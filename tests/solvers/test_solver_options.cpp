// Every option of every registered solver against what no user means: refused with its range, or harmless.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/classic/classic_problems.hpp"
#include "solvers/registry.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& solver, const OptionValues& values) {
  try {
    find_solver(solver).make(values, nullptr);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

class SolverOptions : public ::testing::TestWithParam<std::string> {};

// What is taken must run: within its budget, its memory and its box.
void expect_sound_run(const std::string& solver, const OptionValues& values) {
  const Problem problem = make_classic_problem("rosenbrock", 4);
  SolveOptions options;
  options.budget.max_evaluations = 60;
  options.budget.max_seconds = 20;
  const Result result = solve(problem, {solver, values}, problem.start(), options);
  if (result.termination == Termination::NotApplicable) return;
  ASSERT_TRUE(result.usable()) << result.brief();
  EXPECT_LE(result.counts.total(), 60);
  EXPECT_LT(result.seconds, 60);
  EXPECT_EQ(result.cost, problem.cost(result.x));
}

TEST_P(SolverOptions, WhatNobodyMeansIsRefusedOrHarmless) {
  for (const OptionDescription& option : find_solver(GetParam()).options()) {
    for (const char* value :
         {"-1", "0", "1e300", "-1e300", "nan", "inf", "-inf", "", "1e9", "2147483648", "x"}) {
      SCOPED_TRACE(option.name + "=" + value);
      const std::string message = refusal(GetParam(), {{option.name, value}});
      if (message.empty()) {
        expect_sound_run(GetParam(), {{option.name, value}});
        continue;
      }
      EXPECT_THAT(message, HasSubstr(option.name + "=" + value));
      if (option.allowed != "a solver") {
        EXPECT_THAT(message, AnyOf(HasSubstr(option.allowed), HasSubstr("expected true or false"),
                                   HasSubstr("expected factor_low <= factor_high")));
      }
    }
  }
}

TEST_P(SolverOptions, EveryNumberHasARange) {
  for (const OptionDescription& option : find_solver(GetParam()).options()) EXPECT_NE(option.allowed, "any");
}

TEST_P(SolverOptions, WhatIsInForceCanBeTyped) {
  OptionValues in_force, again;
  find_solver(GetParam()).make({}, &in_force);
  EXPECT_EQ(refusal(GetParam(), in_force), "");
  find_solver(GetParam()).make(in_force, &again);
  EXPECT_EQ(in_force, again);
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const SolverEntry& entry : solver_registry()) list.push_back(entry.name);
  return list;
}
INSTANTIATE_TEST_SUITE_P(All, SolverOptions, ::testing::ValuesIn(names()), [](const auto& parameter) {
  std::string name = parameter.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

TEST(SolverOptionsRanges, WhatTakesMemoryHasAnUpperLimit) {
  for (const char* text :
       {"swarm=0", "swarm=-1", "swarm=1e9", "swarm=100001", "iterations=0", "inertia=-1"}) {
    const std::string option(text);
    const auto equals = option.find('=');
    EXPECT_THAT(refusal("pso", {{option.substr(0, equals), option.substr(equals + 1)}}),
                HasSubstr("expected auto or"))
        << text;
  }
  EXPECT_THAT(refusal("pso", {{"informants", "1000"}}), HasSubstr("expected 0..100"));
  EXPECT_THAT(refusal("cmaes", {{"population", "1000000"}}), HasSubstr("expected auto or 2..100000"));
  EXPECT_THAT(refusal("de", {{"cost_tolerance", "1e300"}}), HasSubstr("expected 0..1"));
  EXPECT_THAT(refusal("multistart", {{"effort", "1e300"}}), HasSubstr("expected 0..1"));
}

}  // namespace
}  // namespace odobench
