#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "problems/classic/classic_problems.hpp"
#include "solvers/box/boundary_map.hpp"
#include "solvers/lattice/coordinate_search.hpp"
#include "solvers/lattice/greedy_scan.hpp"
#include "solvers/population/genetic_thesis.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/valley_problem.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

Result run_on(const Problem& problem, const std::string& spec, std::uint64_t seed,
              std::int64_t evaluations = 0, double target = -std::numeric_limits<double>::infinity(),
              const std::string& polish = "") {
  SolveOptions options;
  options.seed = seed;
  options.budget.max_evaluations = evaluations;
  options.budget.target_cost = target;
  options.polish.name = polish;
  return solve(problem, parse_solver_list(spec).front(), problem.start(), options);
}

std::string refusal(const std::string& spec) {
  try {
    const Problem problem = make_classic_problem("sphere", 3);
    run_on(problem, spec, 1, 10);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// --- the boundary map ---

TEST(BoundaryMap, StaysInTheBoxAndReachesTheBoundsExactly) {
  const BoundaryMap map(0.1);
  EXPECT_EQ(map.to_box(1.1), 1.0);
  EXPECT_EQ(map.to_box(-1.1), -1.0);
  for (int i = -4000; i <= 4000; ++i) {
    const double y = 0.01 * i;
    const double u = map.to_box(y);
    ASSERT_LE(std::abs(u), 1.0) << y;
    ASSERT_EQ(map.to_box(-y), -u) << y;
    ASSERT_NEAR(map.to_box(y + 4.4), u, 1e-12) << y;                   // period 4 (1 + a)
    ASSERT_NEAR(map.to_box(2.2 - y), u, 1e-12) << y;                   // folded at 1 + a
    ASSERT_LE(std::abs(map.to_box(y + 1e-3) - u), 1e-3 + 1e-12) << y;  // never steeper than 1
  }
}

TEST(BoundaryMap, InverseAndSlope) {
  const BoundaryMap map(0.05);
  for (double u = -1.0; u <= 1.0; u += 0.0009765625) EXPECT_NEAR(map.to_box(map.from_box(u)), u, 1e-14) << u;
  EXPECT_EQ(map.to_box(0.3), 0.3);
  const double h = 1e-7;  // u' continuous where the zones meet, 0 at the bound
  EXPECT_NEAR((map.to_box(0.95 + h) - map.to_box(0.95 - h)) / (2 * h), 1.0, 1e-5);
  EXPECT_NEAR((map.to_box(1.05) - map.to_box(1.05 - h)) / h, 0.0, 1e-5);
  EXPECT_THROW(BoundaryMap(0.0), std::invalid_argument);
  EXPECT_THROW(BoundaryMap(1.5), std::invalid_argument);
}

// --- the required accuracy, on a quick stand-in for the calibration problem with a known optimum ---

TEST(Valley, TheStatedOptimumIsTheLowestCost) {
  const Problem valley{testing::ValleyProblem()};
  EXPECT_GT(valley.cost(valley.start()), 300.0);
  Random random(4);
  Vector x(12);
  for (int k = 0; k < 2000; ++k) {
    for (double& v : x) v = random.uniform(-1, 1);
    EXPECT_GT(valley.cost(x), testing::ValleyProblem::kOptimum);
  }
}

struct Requirement {
  std::string solver;
  int evaluations;
  double gap;  // relative to the optimum
  int of_ten;
};

void PrintTo(const Requirement& r, std::ostream* out) {
  *out << r.solver << " within " << r.gap << " after " << r.evaluations << " evaluations";
}

class Required : public ::testing::TestWithParam<Requirement> {};

TEST_P(Required, OnTheValley) {
  const Requirement& need = GetParam();
  const double target = testing::ValleyProblem::kOptimum * (1 + need.gap);
  const Problem valley{testing::ValleyProblem()};
  int reached = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Result r = run_on(valley, need.solver, seed, need.evaluations, target);
    reached += r.cost <= target;
    EXPECT_LE(r.counts.total(), need.evaluations);
  }
  EXPECT_GE(reached, need.of_ten);
}

TEST_P(Required, OnTheRealRecordings) {
  ODOBENCH_NEEDS_SHARED();
#ifndef NDEBUG
  GTEST_SKIP() << "tens of thousands of evaluations of 136,439 samples: only in optimised builds";
#endif
  const Requirement& need = GetParam();
  const double target = testing::kVitkoOptimum * (1 + need.gap);
  const Problem problem(testing::vitko_model());
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {  // all ten seeds: docs/solvers.md
    const Result r = run_on(problem, need.solver, seed, need.evaluations, target);
    EXPECT_LE(r.cost, target) << r.brief();
    EXPECT_TRUE(Box(problem.parameters()).contains(r.x));
  }
}

INSTANTIATE_TEST_SUITE_P(Population, Required,
                         ::testing::Values(Requirement{"cmaes", 30000, 1e-6, 9},
                                           Requirement{"de", 30000, 1e-6, 9},
                                           Requirement{"ga", 50000, 1e-2, 8},
                                           Requirement{"pso", 50000, 1e-2, 8}),
                         [](const auto& parameter) { return parameter.param.solver; });

TEST(Population, PolishedRunsEndAtTheOptimumOfTheRealRecordings) {
  ODOBENCH_NEEDS_SHARED();
#ifndef NDEBUG
  GTEST_SKIP() << "thousands of evaluations of 136,439 samples: only in optimised builds";
#endif
  const Problem problem(testing::vitko_model());
  for (const char* solver : {"ga", "pso", "ga[variant=thesis]", "pso[variant=matlab]"}) {
    const Result r = run_on(problem, solver, 3, 1500, 0, "lm");
    EXPECT_LE(r.cost, testing::kVitkoLimit) << r.brief();
    ASSERT_TRUE(r.cost_before_polish.has_value());
    EXPECT_GT(*r.cost_before_polish, testing::kVitkoLimit);
  }
}

TEST(Population, BoundsAndRotatedValleysOfTheClassics) {
  for (const char* solver : {"cmaes[restarts=0]", "ga", "pso", "de[evaluations=60000]"}) {
    EXPECT_LE(run_on(make_classic_problem("ellipsoid", 8), solver, 5).cost, 1e-15) << solver;
    EXPECT_LE(run_on(make_classic_problem("rosenbrock", 6), solver, 5).cost, 1e-15) << solver;
    const Problem corner = make_classic_problem("corner", 8);
    const double best = run_on(corner, "lm", 0).cost;
    const Result r = run_on(corner, solver, 5);
    EXPECT_LE(r.cost, best * (1 + 1e-10)) << r.brief();
    EXPECT_EQ(r.termination, Termination::Converged) << r.brief();  // by itself, without any budget
  }
}

TEST(Population, OneParameterIsEnough) {
  struct Parabola {
    std::vector<ParameterInfo> list{{"x", "1", 0, -1, 2}};
    std::string name() const { return "parabola"; }
    const std::vector<ParameterInfo>& parameters() const { return list; }
    double cost(const ConstVectorRef& x) const { return 3 + (x[0] - 1.75) * (x[0] - 1.75); }
  };
  for (const char* solver :
       {"cmaes", "ga", "pso", "de", "coordinate", "pso[variant=matlab]", "ga[variant=thesis,crossover=0]"})
    EXPECT_NEAR(run_on(Problem(Parabola{}), solver, 2, 20000).cost, 3.0, 1e-3) << solver;
}

// --- cmaes ---

TEST(Cmaes, RestartsFindTheLowestOfManyMinima) {
  const Problem rastrigin = make_classic_problem("rastrigin", 6);
  EXPECT_GT(run_on(rastrigin, "cmaes[restarts=0]", 1).cost, 0.5);  // one descent does not
  for (const char* solver : {"cmaes", "cmaes[strategy=bipop]"}) {
    const Result r = run_on(rastrigin, solver, 1, 400000, 1e-10);
    EXPECT_LE(r.cost, 1e-10) << r.brief();
  }
}

TEST(Cmaes, EndsWhenARestartFindsTheSamePoint) {
  const Result r = run_on(Problem{testing::ValleyProblem()}, "cmaes", 3);
  EXPECT_EQ(r.termination, Termination::Settled);  // no derivatives: nobody can say more
  EXPECT_THAT(r.message, HasSubstr("restart 1 ended at the best point again"));
  const Result limited = run_on(make_classic_problem("rastrigin", 10), "cmaes[restarts=1]", 3);
  EXPECT_EQ(limited.termination, Termination::IterationLimit);
  EXPECT_THAT(limited.message, HasSubstr("1 restarts with a doubled population >= limit 1"));
}

TEST(Cmaes, PopulationIsHonoured) {
  const Problem sphere = make_classic_problem("sphere", 4);
  EXPECT_EQ(run_on(sphere, "cmaes[population=25,generations=7,restarts=0]", 1).counts.total(), 25 * 7);
  EXPECT_EQ(run_on(sphere, "cmaes[population=25,generations=7,restarts=1]", 1).counts.total(),
            25 * 7 + 50 * 7);
}

// --- ga ---

TEST(GeneticThesis, SpendsTheProgramsEvaluations) {
  const Problem problem{testing::ValleyProblem()};
  const Result r = run_on(problem, "ga[variant=thesis]", 1);
  EXPECT_EQ(r.counts.total(), 12 * 601);
  EXPECT_EQ(r.termination, Termination::IterationLimit);
  for (int kind = 0; kind <= 6; ++kind) {
    const auto spec = [&](int generations) {
      return "ga[variant=thesis,crossover=" + std::to_string(kind) +
             ",generations=" + std::to_string(generations) + "]";
    };
    EXPECT_LT(run_on(problem, spec(600), 1).cost, run_on(problem, spec(1), 1).cost) << kind;
  }
}

TEST(GeneticThesis, CrossoversKeepTheSumOfTheParentsAndDoWhatTheyAreNamedFor) {
  const Vector p0 = Vector::LinSpaced(9, 1, 9), q0 = Vector::LinSpaced(9, 30, 12);
  for (int kind = 0; kind <= 6; ++kind) {
    Random random(17);
    bool changed = false;
    for (int k = 0; k < 200; ++k) {
      Vector p = p0, q = q0;
      thesis_crossover(random, kind, 5.0, p, q);
      EXPECT_LE((p + q - p0 - q0).cwiseAbs().maxCoeff(), 1e-12) << kind;
      changed = changed || p != p0;
      const Vector share = (p - q0).cwiseQuotient(p0 - q0);  // 1: from p, 0: from q
      const double spread = share.maxCoeff() - share.minCoeff();
      if (kind == 0) {  // a head of one parent and a tail of the other
        EXPECT_EQ(share[0], 1.0);
        EXPECT_EQ(share[8], 0.0);
        EXPECT_TRUE(std::is_sorted(share.data(), share.data() + 9, std::greater<>()));
      }
      if (kind == 2 || kind == 5 || kind == 6) {  // one factor for all genes
        EXPECT_LE(spread, 1e-12) << kind;
      }
      if (kind == 2) {
        EXPECT_TRUE(share[0] >= 0 && share[0] <= 1);
      }
      if (kind == 3) {
        EXPECT_TRUE(((share.array() == 0) || (share.array() == 1)).all());
      }
      if (kind == 1 || kind == 4) {  // every gene from one of two sums with the factors c and 1 - c
        const double c = share[0];
        for (double s : share) EXPECT_LE(std::min(std::abs(s - c), std::abs(s - 1 + c)), 1e-12) << kind;
      }
    }
    EXPECT_TRUE(changed) << kind;
  }
}

TEST(GeneticThesis, RouletteDrawsByOneMinusTheShareOfTheCost) {
  Vector costs(4);
  costs << 10, 20, 30, 40;  // f = 0.9, 0.8, 0.7, 0.6 over 3
  Random random(3);
  Vector drawn = Vector::Zero(4);
  for (int k = 0; k < 20000; ++k)
    for (Eigen::Index i : roulette(random, costs)) drawn[i] += 1;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(drawn[i] / 80000, (0.9 - 0.1 * i) / 3.0, 0.008) << i;

  costs[2] = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 500; ++k) EXPECT_THAT(roulette(random, costs), ::testing::Not(::testing::Contains(2)));
  costs.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_THAT(roulette(random, costs), ::testing::Each(::testing::AllOf(::testing::Ge(0), ::testing::Lt(4))));
}

TEST(Genetic, RefusesImpossibleOptions) {
  EXPECT_THAT(refusal("ga[population=2]"), HasSubstr("population=2; expected auto or 3..100000"));
  EXPECT_THAT(refusal("ga[population=10,parents=11]"), HasSubstr("parents=11 > population=10"));
  EXPECT_THAT(refusal("ga[crossover=7]"), HasSubstr("expected 0..6"));
  EXPECT_THAT(refusal("ga[factor_low=2]"), HasSubstr("factor_low=2 > factor_high=1.05"));
  EXPECT_EQ(refusal("ga[population=10,parents=10,children=3,elitist=true]"), "accepted");
}

// --- pso ---

TEST(ParticleSwarmThesis, FollowsItsEquation) {
  const Problem problem{testing::ValleyProblem()};
  const auto cost = [&](const std::string& options) {
    return run_on(problem, "pso[variant=thesis,swarm=20," + options + "]", 9).cost;
  };
  // Without velocity and attraction nobody moves; each attraction alone does something, and they differ (the
  // thesis prints c1 in both terms).
  const double frozen = cost("inertia=0,c1=0,c2=0,iterations=1");
  EXPECT_EQ(cost("inertia=0,c1=0,c2=0,iterations=40"), frozen);
  EXPECT_EQ(cost("inertia=0.7,c1=1.5,c2=0,iterations=40"),
            frozen);  // at its own best, at rest: p - x = 0 for ever
  EXPECT_LT(cost("inertia=0.7,c1=0,c2=1.5,iterations=40"), frozen);
  EXPECT_NE(cost("inertia=0.7,c1=1.5,c2=1,iterations=40"), cost("inertia=0.7,c1=1,c2=1.5,iterations=40"));
  EXPECT_EQ(run_on(problem, "pso[variant=thesis]", 1).counts.total(), 100 * 501);
}

TEST(ParticleSwarmMatlab, StopsByItsStallRule) {
  const Problem problem{testing::ValleyProblem()};
  const Result r = run_on(problem, "pso[variant=matlab]", 1);
  EXPECT_EQ(r.termination, Termination::Settled);
  EXPECT_THAT(r.message, HasSubstr("in 20 iterations"));
  EXPECT_EQ(r.counts.total() % 100, 0);  // min(100, 10 n) particles
  EXPECT_LT(r.counts.total(), 200 * 12 * 100);
  const Result patient = run_on(problem, "pso[variant=matlab,function_tolerance=0,iterations=300]", 1);
  EXPECT_EQ(patient.termination, Termination::IterationLimit);
  EXPECT_EQ(patient.counts.total(), 100 * 301);
  EXPECT_LE(patient.cost, r.cost);
}

TEST(ParticleSwarm, RefusesImpossibleOptions) {
  EXPECT_THAT(refusal("pso[swarm=1]"), HasSubstr("swarm=1; expected auto or 2..100000"));
  EXPECT_THAT(refusal("pso[inertia=-0.5]"), HasSubstr("inertia=-0.5; expected auto or 0..2"));
  EXPECT_THAT(refusal("pso[variant=classic]"), HasSubstr("modern|thesis|matlab"));
}

// --- coordinate ---

TEST(CoordinateSearch, NeighboursInOrderInsideTheBox) {
  Vector u(3);
  u << 1.0, 0.0, -0.75;
  Matrix expected(3, 5);
  expected << 0.5, 1, 1, 1, 1,  //
      0, 0.5, -0.5, 0, 0,       //
      -0.75, -0.75, -0.75, -0.25, -1;
  EXPECT_EQ(coordinate_neighbours(u, 0.5), expected);  // no +e1: it would be clamped back onto u
}

TEST(CoordinateSearch, GreedyChoiceTakesTheFirstOfTheBest) {
  Vector costs(5);
  costs << 4, 2, 3, 2, std::numeric_limits<double>::infinity();
  EXPECT_EQ(greedy_choice(costs, 5), 1);
  EXPECT_EQ(greedy_choice(costs, 2), -1);  // strictly better only
  EXPECT_EQ(greedy_choice(Vector(), 5), -1);
}

TEST(CoordinateSearch, GreedyScanWalksAnyNeighbourhood) {
  const Problem problem = make_classic_problem("sphere", 2);
  odobench::Run run(problem, {}, problem.start(), 1);
  // A lattice of spacing 1/4 of which only the first coordinate may move, upwards.
  const Neighbourhood up = [](const Vector& u) {
    Matrix one = u;
    one(0, 0) += 0.25;
    return u[0] + 0.25 <= 1.0 ? one : Matrix(u.size(), 0);
  };
  Vector u(2);
  u << -1, 0;
  double cost = run.cost(u);
  int moves = 100;
  EXPECT_EQ(greedy_scan(run, up, u, cost, moves), ScanEnd::LocalMinimum);
  EXPECT_EQ(u[0], 0.25);  // the lattice point nearest to 1/3
  EXPECT_EQ(moves, 95);
  EXPECT_EQ(cost, run.cost(u));
  u[0] = -1;
  cost = run.cost(u);
  moves = 2;
  EXPECT_EQ(greedy_scan(run, up, u, cost, moves), ScanEnd::MoveLimit);
  EXPECT_EQ(u[0], -0.5);
}

TEST(CoordinateSearch, EndsByStepOrByMoves) {
  const Result r = run_on(make_classic_problem("sphere", 5), "coordinate", 1);
  EXPECT_LE(r.cost, 1e-16);
  EXPECT_EQ(r.termination, Termination::Stalled);
  EXPECT_THAT(r.message, HasSubstr("< 1e-09"));
  const Result limited = run_on(make_classic_problem("ellipsoid", 5), "coordinate[moves=50]", 1);
  EXPECT_EQ(limited.termination, Termination::IterationLimit);
  EXPECT_THAT(limited.message, HasSubstr("50 moves >= limit 50"));
  EXPECT_THAT(refusal("coordinate[step=0.1,tolerance=0.2]"), HasSubstr("tolerance=0.2 > step=0.1"));
}

}  // namespace
}  // namespace odobench
