#include <gtest/gtest.h>

#include "problems/classic/classic_problems.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

TEST(Problem, LmSolvesClassicLeastSquares) {
  for (const char* name : {"sphere", "ellipsoid", "rosenbrock", "powell"}) {
    const Problem p = make_classic_problem(name, 4);
    const Result r = solve(p, {"lm", {}}, p.start(), {});
    EXPECT_LE(r.cost, 1e-12) << name << "\n" << r.full();
  }
}

}  // namespace
}  // namespace odobench
