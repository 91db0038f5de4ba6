// The adapters around Ceres, Ipopt and NLopt: what they reach, and that the known stalls are cured where they
// should be.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>
#include <thread>

#include "datasets/import/vitko2024/vitko2024.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/classic/classic_problems.hpp"
#include "solvers/certificate/optimality.hpp"
#include "solvers/certificate/verdict.hpp"
#include "solvers/libraries/ceres_solver.hpp"
#include "solvers/registry.hpp"
#include "solvers/solve.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

SolverSpec spec(const std::string& text) {
  return parse_solver_list(text).front();
}

Result solve_with(const Problem& problem, const std::string& solver, int evaluations = 100000,
                  const Vector* start = nullptr) {
  SolveOptions options;
  options.budget.max_evaluations = evaluations;
  options.seed = 11;
  return solve(problem, spec(solver), start == nullptr ? problem.start() : *start, options);
}

// ---------------------------------------------------------------- compression of the residuals

NormalEquations equations_of(const Matrix& j, const Vector& r) {
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

void expect_same_equations(const NormalEquations& e) {
  Matrix j;
  Vector r;
  compress_residuals(e, j, r);
  ASSERT_EQ(j.rows(), e.jtr.size() + 1);
  ASSERT_EQ(j.cols(), e.jtr.size());
  const Vector size = e.jtj.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    EXPECT_NEAR(j.col(i).dot(r), e.jtr[i], 1e-13 * size[i] * std::sqrt(e.cost));
    for (Eigen::Index k = 0; k < size.size(); ++k)
      EXPECT_NEAR(j.col(i).dot(j.col(k)), e.jtj(i, k), 1e-13 * size[i] * size[k]);
  }
  EXPECT_NEAR(r.squaredNorm(), e.cost, 1e-13 * e.cost);
}

TEST(CeresCompression, KeepsNormalEquations) {
  Random random(5);
  for (const double spread : {1.0, 1e3, 1e7}) {
    Matrix j(40, 6);
    Vector r(40);
    for (Eigen::Index i = 0; i < j.rows(); ++i) {
      r[i] = random.normal();
      for (Eigen::Index k = 0; k < j.cols(); ++k)
        j(i, k) = random.normal() * std::pow(spread, static_cast<double>(k) / 5);
    }
    expect_same_equations(equations_of(j, r));
    j.col(3) = 2.0 * j.col(1) - j.col(2);  // rank deficient
    expect_same_equations(equations_of(j, r));
    expect_same_equations(
        equations_of(j, j.col(0) + j.col(5)));  // r in the range of J: an exact fit is ahead
    j.col(4).setZero();                         // a parameter without influence
    expect_same_equations(equations_of(j, r));
  }
}

TEST(CeresCompression, ZeroStaysZero) {
  Matrix j;
  Vector r;
  compress_residuals({0.0, Vector::Zero(3), Matrix::Zero(3, 3)}, j, r);
  EXPECT_EQ(j.norm(), 0.0);
  EXPECT_EQ(r.norm(), 0.0);
}

// ---------------------------------------------------------------- optimality

TEST(Optimality, DropsWhatTheBoundsHold) {
  const Vector u = (Vector(4) << -1, 1, -1, 0.5).finished();
  const Vector g = (Vector(4) << 3, -5, -2, 1).finished();  // -g leaves the box at the first two
  EXPECT_EQ(projected_gradient(u, g), 2.0);
  const Vector near = (Vector(4) << -1 + 1e-9, 1 - 1e-9, -1 + 1e-9, 0.5).finished();
  EXPECT_EQ(projected_gradient(near, g), 5.0);
  EXPECT_EQ(put_on_bounds(near, g, 1e-8), (Vector(4) << -1, 1, -1 + 1e-9, 0.5).finished());
  EXPECT_EQ(put_on_bounds(near, g, 1e-10), near);
}

TEST(Optimality, PromiseIsExactForLinearResiduals) {
  const Problem p = make_classic_problem("corner", 5);
  const Result best = solve_with(p, "lm");
  odobench::Run at_start(p, {}, p.start(), 1);
  NormalEquations e;
  const double cost = at_start.normal_equations(at_start.start(), e);
  EXPECT_NEAR(bounded_promise(at_start.start(), e), (cost - best.cost) / cost, 1e-9);
}

// ---------------------------------------------------------------- bounds that are active at the solution

class ReachesCorner : public ::testing::TestWithParam<std::string> {};

TEST_P(ReachesCorner, FromNominalAndRandomStarts) {
  const Problem p = make_classic_problem("corner", 12);
  const double optimum = solve_with(p, "lm").cost;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const Vector start = k == 0 ? p.start() : random_start(p, k);
    const Result r = solve_with(p, GetParam(), 200000, &start);
    EXPECT_LE(r.cost, optimum * (1 + 1e-6)) << r.full();
    EXPECT_EQ(r.termination, Termination::Converged) << r.brief();
  }
}

INSTANTIATE_TEST_SUITE_P(ThirdParty, ReachesCorner,
                         ::testing::Values("ceres", "ceres[strategy=dogleg]", "ceres[residuals=full]", "ip",
                                           "ip[hessian=gauss-newton]", "ip[hessian=lbfgs]",
                                           "ip[mu_strategy=monotone]", "nlopt:slsqp", "nlopt:lbfgs",
                                           "nlopt:tnewton-precond", "nlopt:var2", "nlopt:bobyqa"));

TEST(Ceres, AloneStallsAndSaysSo) {
  const Problem p = make_classic_problem("corner", 12);
  const double optimum = solve_with(p, "lm").cost;
  const Result r = solve_with(p, "ceres[active_set=false]");
  EXPECT_GT(r.cost, 1.01 * optimum);
  EXPECT_EQ(r.termination, Termination::Stalled) << r.brief();
  EXPECT_NE(r.message.find("promises"), std::string::npos) << r.message;
}

TEST(Nlopt, DerivativeFreeStopFarFromTheMinimumIsNotCalledConverged) {
  const Problem p = make_classic_problem("corner", 12);
  const double optimum = solve_with(p, "lm").cost;
  for (const char* solver :
       {"nlopt:praxis", "nlopt:cobyla[xtol=1e-2,restarts=0]", "nlopt:neldermead[xtol=1e-2,restarts=0]"}) {
    const Result r = solve_with(p, solver);
    ASSERT_GT(r.cost, optimum * (1 + 1e-5)) << solver;
    EXPECT_NE(r.termination, Termination::Converged) << r.brief();
  }
}

TEST(InteriorPoint, PutsActiveParametersOnTheirBounds) {
  const Problem p = make_classic_problem("corner", 8);
  const Vector exact = solve_with(p, "lm").x;
  const Vector x = solve_with(p, "ip").x;
  int active = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::abs(exact[i]) != 1.0) continue;
    ++active;
    EXPECT_EQ(x[i], exact[i]) << i;
  }
  EXPECT_GE(active, 2);
}

TEST(ThirdParty, GlobalMethodsFindTheRastriginMinimum) {
  const Problem p = make_classic_problem("rastrigin", 2);
  for (const char* solver :
       {"nlopt:stogo", "nlopt:stogo-rand", "nlopt:mlsl", "nlopt:mlsl-lds", "nlopt:mlsl[local=bobyqa]",
        "nlopt:direct", "nlopt:direct-l", "nlopt:direct-l-rand", "nlopt:direct-noscal", "nlopt:direct-orig",
        "nlopt:crs2[population=200]", "nlopt:isres", "nlopt:esch", "nlopt:ags"}) {
    // MLSL's own work grows with the square of the evaluations.
    const Result r =
        solve_with(p, solver, std::string(solver).find("mlsl") == std::string::npos ? 30000 : 5000);
    EXPECT_LE(r.cost, 0.1) << r.brief();  // the next minimum is 0.99
  }
}

TEST(ThirdParty, OptionsReachTheLibraries) {
  const Problem p = make_classic_problem("ellipsoid", 6);
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"nlopt:bobyqa", "nlopt:bobyqa[step=0.01]"},
      {"nlopt:crs2", "nlopt:crs2[population=300]"},
      {"nlopt:lbfgs", "nlopt:lbfgs[memory=2]"},
      {"nlopt:mlsl", "nlopt:mlsl[local=slsqp]"},
      {"ceres", "ceres[radius=1e-2]"},
      {"ip[restarts=0]", "ip[restarts=0,mu_strategy=monotone]"},
      {"ip[hessian=lbfgs]", "ip[hessian=lbfgs,memory=2]"}};
  for (const auto& [one, other] : pairs) {
    const Result a = solve_with(p, one, 400), b = solve_with(p, other, 400);
    EXPECT_TRUE(a.cost != b.cost || a.counts.total() != b.counts.total())
        << one << " and " << other << ": " << a.brief();
  }
  for (const char* solver : {"ceres[iterations=2]", "ip[iterations=2]", "nlopt:cobyla[evaluations=20]"}) {
    const Result r = solve_with(p, solver);
    EXPECT_EQ(r.termination, Termination::IterationLimit) << r.brief();
    EXPECT_GT(r.cost, 1e-3);
  }
}

TEST(ThirdParty, EveryApplicableNloptAlgorithmIsRegisteredOnce) {
  std::set<std::string> names;
  for (const SolverEntry& entry : solver_registry())
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
  for (const char* name : {"slsqp",
                           "lbfgs",
                           "tnewton",
                           "tnewton-restart",
                           "tnewton-precond",
                           "tnewton-precond-restart",
                           "var1",
                           "var2",
                           "mma",
                           "ccsaq",
                           "bobyqa",
                           "newuoa",
                           "cobyla",
                           "neldermead",
                           "sbplx",
                           "praxis",
                           "crs2",
                           "isres",
                           "esch",
                           "direct",
                           "direct-l",
                           "direct-l-rand",
                           "direct-noscal",
                           "direct-l-noscal",
                           "direct-l-rand-noscal",
                           "direct-orig",
                           "direct-l-orig",
                           "stogo",
                           "stogo-rand",
                           "ags",
                           "mlsl",
                           "mlsl-lds"})
    EXPECT_EQ(names.count("nlopt:" + std::string(name)), 1u) << name;
}

TEST(ThirdParty, NothingIsPrinted) {
  const Problem p = make_classic_problem("rosenbrock", 4);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (const SolverEntry& entry : solver_registry()) solve_with(p, entry.name, 500);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// Ipopt and MUMPS are not safe in several threads, NLopt's generator is thread-local, StoGO has static
// variables.
TEST(ThirdParty, ManyThreadsGiveTheBitsOfOne) {
  const std::vector<std::string> solvers{"ip",           "ip[hessian=lbfgs]", "ceres",
                                         "nlopt:crs2",   "nlopt:stogo-rand",  "nlopt:mlsl",
                                         "nlopt:praxis", "nlopt:isres"};
  const Problem p = make_classic_problem("rosenbrock", 5);
  constexpr int kRepeats = 6;
  std::vector<Result> serial, parallel(solvers.size() * kRepeats);
  for (const std::string& solver : solvers) serial.push_back(solve_with(p, solver, 1000));
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < parallel.size(); i = next++)
        parallel[i] = solve_with(p, solvers[i % solvers.size()], 1000);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < parallel.size(); ++i) {
    const Result& expected = serial[i % solvers.size()];
    EXPECT_EQ(parallel[i].cost, expected.cost) << expected.solver;
    EXPECT_EQ(parallel[i].counts.total(), expected.counts.total()) << expected.solver;
    EXPECT_TRUE(parallel[i].x == expected.x) << expected.solver;
  }
}

// A model that throws: the exception must not cross the libraries' frames; it ends the run as failed.
struct Throwing {
  std::vector<ParameterInfo> list = make_classic_problem("sphere", 3).parameters();
  std::shared_ptr<int> calls = std::make_shared<int>(0);
  std::string name() const { return "throwing"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  Eigen::Index residual_count() const { return 3; }
  void count() const {
    if (++*calls == 12) throw std::runtime_error("the model broke at call 12");
  }
  double cost(const ConstVectorRef& x) const {
    count();
    return (x.array() - 0.3).square().sum() + std::pow(x[0] + x[1], 4);
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const { r = x.array() - 0.3; }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j = Matrix::Identity(3, 3) * 1e-3;  // wrong on purpose: keeps the methods busy
    count();
  }
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const {
    count();
    Vector r = x.array() - 0.3;
    out = {r.squaredNorm() + std::pow(x[0] + x[1], 4), 1e-3 * r, 1e-6 * Matrix::Identity(3, 3)};
  }
};

TEST(ThirdParty, ExceptionOfTheModelEndsTheRun) {
  for (const SolverEntry& entry : solver_registry()) {
    if (entry.name != "ceres" && entry.name != "ip" && entry.name.rfind("nlopt:", 0) != 0) continue;
    const Result r = solve_with(Problem(Throwing{}), entry.name, 2000);
    if (r.counts.total() < 12) continue;  // was done before
    EXPECT_EQ(r.termination, Termination::Failed) << r.brief();
    EXPECT_EQ(r.counts.total(), 12) << r.brief();
    EXPECT_EQ(r.message, "the model broke at call 12") << entry.name;
  }
}

// ---------------------------------------------------------------- the real calibration

constexpr double kOptimum = 98.11878293;

const Problem& calibration() {
  static const Problem problem = [] {
    const Dataset set = import_vitko2024(testing::shared_folder() / "datasets" / "vitko2024");
    return Problem(CalibrationProblem(set.robot.parameters, set.recordings));
  }();
  return problem;
}

void expect_optimum(const Result& r) {
  EXPECT_LE(r.cost, kOptimum * (1 + 1e-6)) << r.full();
  ASSERT_TRUE(r.usable());
  const auto& parameters = calibration().parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double x = r.x[static_cast<Eigen::Index>(i)];
    EXPECT_TRUE(x >= parameters[i].lower && x <= parameters[i].upper)
        << r.solver << " " << parameters[i].name;
  }
  EXPECT_NEAR(r.cost, calibration().cost(r.x), 1e-12 * r.cost) << r.solver;
}

TEST(Calibration, GradientMethodsAndBobyqaReachTheOptimumFromNominal) {
  ODOBENCH_NEEDS_SHARED();
  for (const char* solver :
       {"ceres", "ip", "ip[mu_strategy=monotone]", "nlopt:slsqp", "nlopt:lbfgs", "nlopt:bobyqa"}) {
    const Result r = solve_with(calibration(), solver, 20000);
    expect_optimum(r);
    EXPECT_EQ(r.termination, Termination::Converged) << r.brief();
  }
}

TEST(Calibration, CeresAndIpReachItFromTwentyRandomStarts) {
  ODOBENCH_NEEDS_SHARED();
#ifdef NDEBUG
  constexpr std::uint64_t kStarts = 20;
#else  // the same code under sanitizers, in a bearable time
  constexpr std::uint64_t kStarts = 2;
#endif
  for (const char* solver : {"ceres", "ip"})
    for (std::uint64_t k = 1; k <= kStarts; ++k) {
      const Vector start = random_start(calibration(), k);
      expect_optimum(solve_with(calibration(), solver, 3000, &start));
    }
}

TEST(Calibration, CeresAloneStalls) {
  ODOBENCH_NEEDS_SHARED();
  const Result r = solve_with(calibration(), "ceres[active_set=false,cost_tolerance=1e-14,radius=1e4]", 3000);
  EXPECT_GT(r.cost, kOptimum * 1.0001) << r.brief();
  EXPECT_EQ(r.termination, Termination::Stalled) << r.brief();
}

}  // namespace
}  // namespace odobench
