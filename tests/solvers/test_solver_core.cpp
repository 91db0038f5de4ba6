// What all solvers share: option parsing, seeds, the unit box, the driver and the box-constrained quadratic
// model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "problems/classic/classic_problems.hpp"
#include "solvers/box/box_quadratic.hpp"
#include "solvers/local/levenberg_marquardt.hpp"
#include "solvers/registry.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Options, SplitsSolverListsOutsideBrackets) {
  const auto specs = parse_solver_list("lm, pso[swarm=60, inertia=0.7],nlopt:bobyqa[]");
  ASSERT_EQ(specs.size(), 3u);
  EXPECT_EQ(specs[0].name, "lm");
  EXPECT_EQ(specs[1].text(), "pso[inertia=0.7,swarm=60]");
  EXPECT_EQ(specs[2].text(), "nlopt:bobyqa");
}

TEST(Options, RefusesMalformedSolverLists) {
  for (const char* text : {"", "lm,", "pso[swarm=60", "pso]swarm[", "pso[[a=1]]", "pso[swarm]", "pso[=3]",
                           "pso[a=1,a=2]", "pso[a=1]x", "pso[a=1,]"})
    EXPECT_NE(refusal([&] { parse_solver_list(text); }), "accepted") << text;
}

TEST(Options, UnknownNamesSuggestTheNearest) {
  EXPECT_THAT(refusal([] { find_solver("lmm"); }), HasSubstr("unknown solver 'lmm', did you mean 'lm'?"));
  EXPECT_THAT(refusal([] {
                find_solver("lm").make({{"lamda", "1"}}, nullptr);
              }),
              HasSubstr("unknown option 'lamda', did you mean 'lambda'?; known: lambda"));
  EXPECT_THAT(refusal([] {
                find_solver("lm").make({{"lambda", "-1"}}, nullptr);
              }),
              HasSubstr("option lambda=-1; expected"));
  EXPECT_THAT(refusal([] {
                find_solver("lm").make({{"lambda", "1e-3x"}}, nullptr);
              }),
              HasSubstr("expected a number"));
  EXPECT_THAT(refusal([] {
                find_solver("lm").make({{"iterations", "2.5"}}, nullptr);
              }),
              HasSubstr("expected a whole number"));
}

TEST(Options, ValuesInForceCarryDefaultsAndGivenValues) {
  OptionValues values;
  find_solver("lm").make({{"lambda", "0.5"}}, &values);
  EXPECT_EQ(values.at("lambda"), "0.5");
  EXPECT_EQ(values.at("iterations"), "1000");
}

TEST(Seeds, DependOnEveryPartAndOnTheSplit) {
  std::set<std::uint64_t> seeds;
  seeds.insert(derive_seed(1, {"a", "b"}));
  seeds.insert(derive_seed(2, {"a", "b"}));
  seeds.insert(derive_seed(1, {"ab"}));
  seeds.insert(derive_seed(1, {"ab", ""}));
  seeds.insert(derive_seed(1, {"", "ab"}));
  seeds.insert(derive_seed(1, {"b", "a"}));
  EXPECT_EQ(seeds.size(), 6u);
  EXPECT_EQ(derive_seed(1, {"a", "b"}), derive_seed(1, {"a", "b"}));
}

TEST(BoxScaling, BoundsAreExactAndPointsStayInside) {
  const std::vector<ParameterInfo> parameters{{"p", "m", 0.1125, 0.1125 * 0.95, 0.1125 * 1.05},
                                              {"fixed", "m", 3, 3, 3},
                                              {"q", "m", -0.1125, -0.1125 * 1.05, -0.1125 * 0.95}};
  const Box box(parameters);
  ASSERT_EQ(box.dimension(), 2);
  EXPECT_EQ(box.to_parameters(Eigen::Vector2d(-1, 1)),
            Eigen::Vector3d(parameters[0].lower, 3, parameters[2].upper));
  EXPECT_EQ(box.to_parameters(Eigen::Vector2d(1.5, -7)),
            Eigen::Vector3d(parameters[0].upper, 3, parameters[2].lower));
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const double near = k % 2 == 0 ? 1.0 : 1e-15;  // also points next to a bound
    const Eigen::Vector2d u(random.uniform(-1, 1), 1 - near * random.uniform());
    const Vector x = box.to_parameters(u);
    ASSERT_TRUE(box.contains(x));
    ASSERT_LE((box.to_unit(x) - u).lpNorm<Eigen::Infinity>(), 1e-14);
  }
}

TEST(Driver, BudgetIsNeverExceededAndBatchesAreCut) {
  Budget budget;
  budget.max_evaluations = 10;
  const Problem problem = make_classic_problem("sphere", 3);
  odobench::Run run(problem, budget, problem.start(), 1);
  Vector costs(7);
  const Matrix candidates = Matrix::Random(3, 7);
  run.batch_cost(candidates, costs);
  EXPECT_TRUE(costs.allFinite());
  EXPECT_FALSE(run.stop());
  run.batch_cost(candidates, costs);
  EXPECT_TRUE(costs.head(3).allFinite());
  EXPECT_TRUE((costs.tail(4).array() == std::numeric_limits<double>::infinity()).all());
  EXPECT_TRUE(run.stop());
  EXPECT_EQ(run.stop_reason(), Termination::MaxEvaluations);
  EXPECT_EQ(run.stop_message(), "10 evaluations >= limit 10");
  Vector g(3);
  EXPECT_EQ(run.cost_and_gradient(run.start(), g), std::numeric_limits<double>::infinity());
  EXPECT_EQ(run.evaluations(), 10);
}

TEST(Driver, LargeBatchesHaveTheSameBitsOnAnyThreadCount) {
  const Problem problem = make_classic_problem("rosenbrock", 12);
  const Matrix candidates = Matrix::Random(12, 100);
  std::vector<Vector> results;
  for (int threads : {1, 2, 3}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      odobench::Run run(problem, {}, problem.start(), 1, nullptr, {}, threads);
      Vector costs(100);
      run.batch_cost(candidates, costs);
      EXPECT_EQ(run.evaluations(), 100);
      results.push_back(costs);
    });
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(Driver, TargetEndsABatchAtTheSameCandidateOnAnyThreadCount) {
  const Problem problem = make_classic_problem("sphere", 4);
  Matrix candidates = Matrix::Constant(4, 200, 0.9);
  candidates.col(40).setConstant(1.0 / 3);
  for (int threads : {1, 2}) {
    Budget budget;
    budget.target_cost = 1e-6;
    odobench::Run run(problem, budget, problem.start(), 1, nullptr, {}, threads);
    Vector costs(200);
    run.batch_cost(candidates, costs);
    EXPECT_EQ(run.evaluations(), 64);
    EXPECT_EQ(run.stop_reason(), Termination::TargetReached);
  }
}

TEST(Driver, TraceIsBoundedAndEndsAtTheBest) {
  const Problem problem = make_classic_problem("sphere", 2);
  odobench::Run run(problem, {}, problem.start(), 1);
  for (int k = 0; k < 5000; ++k) run.cost(Vector::Constant(2, 1.0 - k * 1e-4));
  EXPECT_LE(run.trace().size(), 400u);
  EXPECT_EQ(run.trace().back().cost, run.best_cost());
  for (std::size_t i = 1; i < run.trace().size(); ++i)
    EXPECT_LT(run.trace()[i].cost, run.trace()[i - 1].cost);
}

TEST(Driver, PolishGoesOnFromTheBestWithinTheSameBudget) {
  const Problem problem = make_classic_problem("ellipsoid", 12);
  SolveOptions options;
  options.budget.max_evaluations = 300;
  options.polish = {"lm", {}};
  const Result r = solve(problem, {"coordinate", {}}, problem.start(), options);
  ASSERT_TRUE(r.cost_before_polish.has_value());
  EXPECT_GT(*r.cost_before_polish, 1e-3);
  EXPECT_LE(r.cost, 1e-12) << r.full();
  EXPECT_LE(r.counts.total(), 300);
  EXPECT_THAT(r.message, HasSubstr("polished by lm"));
}

TEST(Driver, AllParametersFixedIsOneEvaluation) {
  struct Fixed {
    std::vector<ParameterInfo> list{{"p", "1", 2, 2, 2}};
    std::string name() const { return "fixed"; }
    const std::vector<ParameterInfo>& parameters() const { return list; }
    double cost(const ConstVectorRef& x) const { return x[0]; }
  };
  const Problem problem{Fixed{}};
  for (const SolverEntry& entry : solver_registry()) {
    const Result r = solve(problem, {entry.name, {}}, problem.start(), {});
    if (r.termination == Termination::NotApplicable) continue;
    EXPECT_EQ(r.cost, 2) << entry.name;
    EXPECT_EQ(r.counts.total(), 1) << entry.name;
  }
}

// KKT conditions of min g'd + 1/2 d'Hd on a box, to `tolerance` of the gradient.
void expect_kkt(const Matrix& h, const Vector& g, const Vector& low, const Vector& high, const Vector& d,
                double tolerance) {
  const Vector reduced = g + h * d;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    ASSERT_GE(d[i], low[i]);
    ASSERT_LE(d[i], high[i]);
    const double scale =
        tolerance * std::sqrt(h(i, i)) * (g.array() / h.diagonal().array().sqrt()).matrix().norm();
    if (d[i] > low[i]) {
      ASSERT_LE(reduced[i], scale) << i;
    }
    if (d[i] < high[i]) {
      ASSERT_GE(reduced[i], -scale) << i;
    }
  }
}

TEST(BoxQuadratic, SatisfiesKktOnRandomIllConditionedModels) {
  Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index m = 1 + trial % 12;
    Matrix a(m, m);
    for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] = random.normal();
    const Matrix q = Eigen::SelfAdjointEigenSolver<Matrix>(a + a.transpose()).eigenvectors();
    Vector spectrum(m);
    for (Eigen::Index i = 0; i < m; ++i) spectrum[i] = std::pow(10.0, random.uniform(-4, 4));
    const Matrix h = q * spectrum.asDiagonal() * q.transpose();
    Vector g(m), low(m), high(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      g[i] = 100 * random.normal();
      low[i] = random.uniform() < 0.2 ? 0.0 : -random.uniform();
      high[i] = random.uniform() < 0.2 ? 0.0 : random.uniform();
    }
    expect_kkt(0.5 * (h + h.transpose()), g, low, high,
               solve_box_quadratic(0.5 * (h + h.transpose()), g, low, high), 1e-9);
  }
}

TEST(LevenbergMarquardt, ScalingTheCostChangesNothing) {
  // r -> 1e-4 r, so J -> 1e-8 J: every tolerance is relative.
  struct Scaled {
    Problem inner;
    double factor;
    std::string name() const { return "scaled"; }
    const std::vector<ParameterInfo>& parameters() const { return inner.parameters(); }
    Vector start() const { return inner.start(); }
    double cost(const ConstVectorRef& x) const { return factor * Problem(inner).cost(x); }
    void normal_equations(const ConstVectorRef& x, NormalEquations& e) const {
      Problem(inner).normal_equations(x, e);
      e.cost *= factor;
      e.jtr *= factor;
      e.jtj *= factor;
    }
  };
  const Problem inner = make_classic_problem("corner", 12);
  const double factor = std::ldexp(1.0, -27);  // a power of two: the very same bits must come out
  const Problem plain(Scaled{inner, 1.0}), scaled(Scaled{inner, factor});
  const Result a = solve(plain, {"lm", {}}, plain.start(), {}),
               b = solve(scaled, {"lm", {}}, plain.start(), {});
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.cost * factor, b.cost);
  EXPECT_EQ(a.counts.total(), b.counts.total());
  EXPECT_EQ(a.termination, Termination::Converged);
}

}  // namespace
}  // namespace odobench
