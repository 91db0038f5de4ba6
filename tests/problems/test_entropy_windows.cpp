// The relative-entropy filter's window: direct and profile form, and the searches, against independent
// 50-digit evaluations.
#include <gtest/gtest.h>

#include <cmath>

#include "problems/entropy/direct_form.hpp"
#include "problems/entropy/window_problem.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/lattice/ternary_kernel.hpp"
#include "solvers/lattice/ternary_search.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/entropy_windows.hpp"

namespace odobench {
namespace {

using nlohmann::json;

Vector vector_of(const json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void expect_close(double value, const json& expected, double floor, const std::string& what) {
  const double e = expected.get<double>();
  EXPECT_LE(std::abs(value - e), std::max(1e-9 * std::abs(e), floor))
      << what << ": " << value << " against " << e;
}

void expect_state(const EntropyState& state, const json& expected, const std::string& what) {
  expect_close(state.r1, expected.at("r1"), 1e-12, what + " r1");
  expect_close(state.sx1, expected.at("sx1"), 1e-12, what + " sx1");
  expect_close(state.sy1, expected.at("sy1"), 1e-12, what + " sy1");
  expect_close(state.ax12, expected.at("ax12"), 1e-12, what + " ax12");
  expect_close(state.ay12, expected.at("ay12"), 1e-12, what + " ay12");
}

// Uniform in [-1, 1].
Vector random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Vector::NullaryExpr(size, [&] { return uniform(engine); });
}

// t of a search that works on blocks, in the thesis' order.
struct Solved {
  Vector t;
  double hamiltonian;
  SearchResult search;
};
Solved solve_blocks(const BlockQuadratic& cost, BlockSearch& search) {
  const Vector g = cost.stacked_g();
  Vector x(g.size());
  const auto size = static_cast<std::size_t>(g.size());
  Solved solved{{}, 0, search.minimise({g.data(), size}, {x.data(), size})};
  solved.t = cost.unstack(x);
  solved.hamiltonian = -(cost.constant + solved.search.cost);
  return solved;
}

TEST(EntropyReference, DirectFormAndClosedForms) {
  ODOBENCH_NEEDS_SHARED();
  const std::vector<EntropyWindow> windows = testing::reference_windows();
  const json expected = testing::expected_of_windows();
  ASSERT_EQ(windows.size(), 40u);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const EntropyWindow& window = windows[i];
    const auto check = [&](const Vector& values, const json& point, const std::string& what) {
      const EntropyState state = closed_form(window, values);
      expect_state(state, point, window.id + " " + what);
      expect_close(hamiltonian(window, values, state), point.at("H"), 0, window.id + " H " + what);
    };
    check(Vector::Zero(increment_count(window.constants.samples)), expected[i].at("zero"), "zero");
    check(vector_of(expected[i].at("random").at("inc")), expected[i].at("random"), "random");
    for (const char* kind : {"greedy", "exact"})
      check(increments(window.constants, vector_of(expected[i].at(kind).at("t"))), expected[i].at(kind),
            kind);
  }
}

TEST(EntropyReference, ProfileForm) {
  ODOBENCH_NEEDS_SHARED();
  const std::vector<EntropyWindow> windows = testing::reference_windows();
  const json expected = testing::expected_of_windows();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const WindowProblem problem(windows[i]);
    const Vector zero = Vector::Zero(increment_count(windows[i].constants.samples));
    expect_close(-problem.cost(zero), expected[i].at("zero").at("H"), 0, windows[i].id + " H0");
    for (const char* kind : {"greedy", "exact"})
      expect_close(-problem.cost(vector_of(expected[i].at(kind).at("t"))), expected[i].at(kind).at("H"), 0,
                   windows[i].id + " H " + kind);
  }
}

TEST(EntropyReference, DirectSearch) {
  ODOBENCH_NEEDS_SHARED();
  const std::vector<EntropyWindow> windows = testing::reference_windows();
  const json expected = testing::expected_of_windows();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const DirectSearch found = direct_search(windows[i]);
    const json& greedy = expected[i].at("greedy");
    EXPECT_EQ(found.t, vector_of(greedy.at("t"))) << windows[i].id;
    EXPECT_EQ(found.iterations, greedy.at("iterations").get<int>()) << windows[i].id;
    EXPECT_EQ(found.evaluations, greedy.at("evaluations").get<long>()) << windows[i].id;
    expect_close(found.hamiltonian, greedy.at("H"), 0, windows[i].id + " H");
    expect_state(found.state, greedy, windows[i].id);
    const EntropyPrediction first =
        Predictor(windows[i].constants).predict(found.state.sx1, found.state.sy1, found.state.r1);
    for (std::size_t w = 0; w < 4; ++w) {
      expect_close(first.x[w], greedy.at("out").at("enc1")[w][0], 1e-12, windows[i].id + " enc x");
      expect_close(first.y[w], greedy.at("out").at("enc1")[w][1], 1e-12, windows[i].id + " enc y");
    }
    expect_close(first.rotation, greedy.at("out").at("dtheta1"), 1e-12, windows[i].id + " rotation");
  }
}

// t and iterations exactly, at every vector width.
TEST(EntropyReference, BlockSearches) {
  ODOBENCH_NEEDS_SHARED();
  const std::vector<EntropyWindow> windows = testing::reference_windows();
  const json expected = testing::expected_of_windows();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const WindowProblem problem(windows[i]);
    const BlockQuadratic& cost = problem.block_quadratic();
    for (const InstructionSet kernel : available_instruction_sets()) {
      const std::string where = windows[i].id + " " + to_string(kernel);
      const Solved greedy = solve_blocks(cost, *ternary_greedy(cost.blocks, kernel));
      EXPECT_EQ(greedy.t, vector_of(expected[i].at("greedy").at("t"))) << where;
      EXPECT_EQ(greedy.search.iterations, expected[i].at("greedy").at("iterations").get<int>()) << where;
      expect_close(greedy.hamiltonian, expected[i].at("greedy").at("H"), 0, where + " greedy H");
      const Solved exact = solve_blocks(cost, *ternary_exact(cost.blocks, {}, kernel));
      EXPECT_EQ(exact.t, vector_of(expected[i].at("exact").at("t"))) << where;
      expect_close(exact.hamiltonian, expected[i].at("exact").at("H"), 0, where + " exact H");
    }
    const Solved relaxed = solve_blocks(cost, *box_relaxation(cost.blocks));
    expect_close(relaxed.hamiltonian, expected[i].at("relaxed_H"), 0, windows[i].id + " relaxed H");
  }
}

// The same through the registry, as every other method runs.
TEST(EntropyReference, Solvers) {
  ODOBENCH_NEEDS_SHARED();
  const std::vector<EntropyWindow> windows = testing::reference_windows();
  const json expected = testing::expected_of_windows();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Problem problem{WindowProblem(windows[i])};
    const auto run = [&](const char* solver) { return solve(problem, {solver, {}}, problem.start(), {}); };
    const Result greedy = run("coordinate"), exact = run("exact"), relaxed = run("relaxed");
    EXPECT_EQ(greedy.x, vector_of(expected[i].at("greedy").at("t"))) << windows[i].id;
    EXPECT_EQ(greedy.iterations, expected[i].at("greedy").at("iterations").get<int>()) << windows[i].id;
    // One change per candidate, as the thesis' program, which evaluates H twice more.
    EXPECT_EQ(greedy.counts.lattice + 2, expected[i].at("greedy").at("evaluations").get<int>());
    EXPECT_EQ(exact.x, vector_of(expected[i].at("exact").at("t"))) << windows[i].id;
    expect_close(-relaxed.cost, expected[i].at("relaxed_H"), 0, windows[i].id + " relaxed");
    // On the lattice derivatives say nothing, whatever was proven.
    EXPECT_EQ(greedy.termination, Termination::Settled) << greedy.brief();
    EXPECT_EQ(exact.termination, Termination::Settled) << exact.brief();
    EXPECT_EQ(relaxed.termination, Termination::Converged) << relaxed.brief();
    for (const Result* result : {&greedy, &exact, &relaxed}) {
      EXPECT_EQ(result->cost, problem.cost(result->x)) << result->brief();
    }
  }
}

class RandomWindows : public ::testing::TestWithParam<int> {};

// H0 <= greedy <= exact <= relaxed <= 0; rounding may show in equal ones.
TEST_P(RandomWindows, OrderOfTheBounds) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const WindowProblem problem(testing::random_window(GetParam(), seed, 0.5 * seed));
    const BlockQuadratic& cost = problem.block_quadratic();
    const double h0 = -cost.constant, slack = 1e-12 * std::abs(h0);
    const double greedy = solve_blocks(cost, *ternary_greedy(cost.blocks)).hamiltonian;
    const double exact = solve_blocks(cost, *ternary_exact(cost.blocks)).hamiltonian;
    const double relaxed = solve_blocks(cost, *box_relaxation(cost.blocks)).hamiltonian;
    EXPECT_LE(h0, greedy + slack);
    EXPECT_LE(greedy, exact + slack);
    EXPECT_LE(exact, relaxed + slack);
    EXPECT_LE(relaxed, 0);
    EXPECT_LT(h0, relaxed) << "nothing to search for in seed " << seed;
  }
}

TEST_P(RandomWindows, ProfileFormIsTheDirectForm) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const WindowProblem problem(testing::random_window(GetParam(), seed));
    const EntropyWindow& window = problem.window();
    const Vector t = random_vector(increment_count(GetParam()), seed);
    const Vector values = increments(window.constants, t);
    const EntropyState state = closed_form(window, values);
    const double direct = hamiltonian(window, values, state);
    EXPECT_NEAR(-problem.cost(t), direct, 1e-12 * std::abs(direct));

    // The closed form is the maximum: every gradient of H vanishes there.
    double EntropyState::*const members[] = {&EntropyState::r1, &EntropyState::sx1, &EntropyState::sy1,
                                             &EntropyState::ax12, &EntropyState::ay12};
    for (double EntropyState::*const member : members) {
      const double h = 1e-4;
      EntropyState up = state, down = state;
      up.*member += h;
      down.*member -= h;
      const double drop = 2 * direct - hamiltonian(window, values, up) - hamiltonian(window, values, down);
      EXPECT_GT(drop, 0);
      EXPECT_NEAR(hamiltonian(window, values, up), hamiltonian(window, values, down),
                  1e-9 * std::abs(direct));
    }

    // Normal equations, residuals and gradient speak of the same cost.
    const Problem handle{WindowProblem(window)};
    Vector r(handle.residual_count()), g(t.size());
    Matrix j(handle.residual_count(), t.size());
    handle.residuals_and_jacobian(t, r, j);
    EXPECT_NEAR(r.squaredNorm(), -direct, 1e-11 * std::abs(direct));
    NormalEquations e;
    handle.normal_equations(t, e);
    EXPECT_EQ(e.cost, handle.cost(t));
    EXPECT_TRUE((j.transpose() * j).isApprox(e.jtj, 1e-8));
    EXPECT_LE((j.transpose() * r - e.jtr).norm(), 1e-8 * (1 + e.jtr.norm()));
    EXPECT_EQ(handle.cost_and_gradient(t, g), e.cost);
    EXPECT_LE((g - 2 * e.jtr).norm(), 1e-14 * (1 + g.norm()));
  }
}

TEST_P(RandomWindows, SearchesAgreeWithTheDirectSearch) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const WindowProblem problem(testing::random_window(GetParam(), seed));
    const DirectSearch direct = direct_search(problem.window());
    const BlockQuadratic& cost = problem.block_quadratic();
    const Solved fast = solve_blocks(cost, *ternary_greedy(cost.blocks));
    EXPECT_EQ(fast.t, direct.t);
    EXPECT_EQ(fast.search.iterations, direct.iterations);
    const Problem handle{WindowProblem(problem.window())};
    const Result generic = solve(handle, {"coordinate", {}}, handle.start(), {});
    EXPECT_EQ(generic.x, direct.t);
    EXPECT_EQ(generic.iterations, direct.iterations);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, RandomWindows, ::testing::Values(3, 4, 5, 10, 12, 15));

// Every lattice point of small windows, and of blocks beyond the tables against brute force.
TEST(TernaryExact, IsTheLowestOfAllPoints) {
  for (const int samples : {3, 4, 5}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const WindowProblem problem(testing::random_window(samples, seed, seed));
      const BlockQuadratic& cost = problem.block_quadratic();
      const Solved exact = solve_blocks(cost, *ternary_exact(cost.blocks));
      Vector t = Vector::Constant(increment_count(samples), -1), best = t;
      double lowest = problem.cost(t);
      for (bool more = true; more;) {
        Eigen::Index i = 0;
        while (i < t.size() && t[i] == 1) t[i++] = -1;
        more = i < t.size();
        if (!more) break;
        t[i] += 1;
        const double value = problem.cost(t);
        if (value < lowest) {
          lowest = value;
          best = t;
        }
      }
      EXPECT_EQ(exact.t, best) << samples << " samples, seed " << seed;
    }
  }
}

TEST(TernaryExact, BranchAndBoundAgreesWithBruteForce) {
  constexpr int n = 11;  // one more than the tables take
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Vector entries = random_vector(n * n, seed), g = 3 * random_vector(n, 100 + seed);
    const Eigen::Map<const Matrix> a(entries.data(), n, n);
    const Matrix q = a.transpose() * a + 0.05 * Matrix::Identity(n, n);
    QuadraticBlock block{{}, q, g};
    for (int i = 0; i < n; ++i) block.index.push_back(i);
    const Solved exact = solve_blocks({0, {block}}, *ternary_exact({block}));
    EXPECT_EQ(solve_blocks({0, {block}}, *ternary_branch_and_bound({block})).t, exact.t);

    // Brute force keeps Q t and the cost up to date as single entries change.
    Vector t = Vector::Constant(n, -1), qt = q * t, best = t;
    double value = t.dot(qt - g), lowest = value;
    const auto set = [&](int i, double to) {
      const double d = to - t[i];
      value += d * (2 * qt[i] + d * q(i, i) - g[i]);
      qt += d * q.col(i);
      t[i] = to;
    };
    for (;;) {
      int i = 0;
      while (i < n && t[i] == 1) set(i++, -1);
      if (i == n) break;
      set(i, t[i] + 1);
      if (value < lowest) {
        lowest = value;
        best = t;
      }
    }
    EXPECT_EQ(exact.t, best) << "seed " << seed;
    EXPECT_NEAR(exact.search.cost, lowest, 1e-9 * std::abs(lowest));
  }
}

// A search that is stopped at once still answers, and not worse than the greedy one.
TEST(TernaryExact, StoppedBranchAndBoundKeepsItsIncumbent) {
  const WindowProblem problem(testing::random_window(30, 2));
  const BlockQuadratic& cost = problem.block_quadratic();
  const double greedy = solve_blocks(cost, *ternary_greedy(cost.blocks)).hamiltonian;
  const Solved stopped = solve_blocks(cost, *ternary_branch_and_bound(cost.blocks, [] { return true; }));
  EXPECT_GE(stopped.hamiltonian, greedy - 1e-9 * std::abs(greedy));
  EXPECT_LT(stopped.search.evaluations, 2000);

  const Problem handle{WindowProblem(problem.window())};
  SolveOptions options;
  options.budget.max_seconds = 0.01;
  const Result cut = solve(handle, {"exact", {}}, handle.start(), options);
  EXPECT_EQ(cut.termination, Termination::TimeLimit) << cut.brief();
  EXPECT_LE(cut.cost, -greedy * (1 + 1e-12)) << cut.brief();
}

// Rows are taken four at a time, and the rest one by one.
TEST(TernaryExact, TheFirstOfEqualRowsIsTheSmallest) {
  for (const InstructionSet set : available_instruction_sets()) {
    const ternary::Kernel kernel = ternary::select(set);
    for (int rows = 1; rows <= 11; ++rows)
      for (int first = 0; first < rows; ++first) {
        const int columns = 2 * ternary::kPad;
        std::vector<double> table(static_cast<std::size_t>(rows * columns), 5.0), row(11, 0.0),
            column(16, 0.0);
        column[3] = -2;
        row[static_cast<std::size_t>(first)] =
            -1;  // 5 - |-2 - 1|, by which the row is lower than those before
        for (int i = first + 1; i < rows; ++i)
          table[static_cast<std::size_t>(i * columns + 11)] = 2;  // as low
        EXPECT_EQ(kernel.smallest(table.data(), row.data(), rows, column.data(), columns), first)
            << to_string(set) << " " << rows;
      }
  }
}

// Equal gains: the smallest scan position wins, and standing still beats a change that gains nothing.
TEST(TernaryGreedy, TiesGoToTheFirstCandidate) {
  QuadraticBlock block{{0, 1, 2}, Matrix::Identity(3, 3), Vector::Zero(3)};
  block.q(0, 1) = block.q(1, 0) = 0.5;
  const auto t_of = [&](const Vector& g, InstructionSet kernel) {
    block.g = g;
    return solve_blocks({0, {block}}, *ternary_greedy({block}, kernel));
  };
  for (const InstructionSet kernel : available_instruction_sets()) {
    // t_0 and t_1 promise the same; taking the first leaves nothing for the second.
    EXPECT_EQ(t_of(Eigen::Vector3d(2, 2, 0), kernel).t, Vector(Eigen::Vector3d(1, 0, 0)));
    EXPECT_EQ(t_of(Eigen::Vector3d(-2, 2, 0), kernel).t, Vector(Eigen::Vector3d(-1, 1, 0)));
    EXPECT_EQ(t_of(Eigen::Vector3d(1, -1, 1), kernel).t, Vector(Vector::Zero(3)));
    EXPECT_EQ(t_of(Eigen::Vector3d(1, -1, 1), kernel).search.iterations, 1);
  }
}

// The first entry promises most, but the two others together turn it back: 0.4 better.
TEST(TernaryGreedy, MovesAreTakenBack) {
  QuadraticBlock block{{0, 1, 2}, Matrix::Identity(3, 3), Vector::Zero(3)};
  for (Eigen::Index i : {1, 2}) block.q(0, i) = block.q(i, 0) = 0.6;
  for (const InstructionSet kernel : available_instruction_sets())
    for (const double sign : {1.0, -1.0}) {
      block.g = sign * Eigen::Vector3d(3, 2.9, 2.9);
      const Solved solved = solve_blocks({0, {block}}, *ternary_greedy({block}, kernel));
      EXPECT_EQ(solved.t, Vector(sign * Eigen::Vector3d(0, 1, 1))) << to_string(kernel);
      EXPECT_NEAR(solved.hamiltonian, 3.8, 1e-14);  // minus the cost
    }
}

TEST(TernarySearch, RefusesBlocksItCannotTrust) {
  const QuadraticBlock indefinite{{0, 1}, -Matrix::Identity(2, 2), Vector::Zero(2)};
  const QuadraticBlock ragged{{0, 1}, Matrix::Identity(2, 2), Vector::Zero(3)};
  for (const QuadraticBlock& block : {indefinite, ragged}) {
    EXPECT_THROW(ternary_greedy({block}), std::invalid_argument);
    EXPECT_THROW(ternary_exact({block}), std::invalid_argument);
    EXPECT_THROW(box_relaxation({block}), std::invalid_argument);
  }
  EXPECT_THROW(ternary_greedy({}), std::invalid_argument);
}

TEST(EntropyWindow, RefusesImpossibleConstants) {
  const auto refused = [](auto change) {
    EntropyWindow window = testing::random_window(10, 1);
    change(window);
    EXPECT_THROW(WindowProblem{window}, std::invalid_argument);
  };
  refused([](EntropyWindow& w) { w.constants.samples = 2; });
  refused([](EntropyWindow& w) { w.constants.samples = 9; });
  refused([](EntropyWindow& w) { w.constants.dt = 0; });
  refused([](EntropyWindow& w) { w.constants.sigma_encoder = -0.01; });
  refused([](EntropyWindow& w) { w.constants.step_rotation = std::nan(""); });
  refused([](EntropyWindow& w) { w.samples[3].steering[2] = std::nan(""); });
}

TEST(EntropySolvers, SayWhatTheyNeed) {
  const Problem window{WindowProblem(testing::random_window(6, 1))};
  for (const char* solver : {"lm", "ceres", "ip", "nlopt:bobyqa", "nlopt:slsqp"}) {
    SolveOptions options;
    options.budget.max_evaluations = 20000;
    const Result relaxed = solve(window, {"relaxed", {}}, window.start(), options);
    const Result result = solve(window, {solver, {}}, window.start(), options);
    EXPECT_NEAR(result.cost, relaxed.cost, 1e-7 * relaxed.cost) << result.brief();
  }
  SolveOptions options;
  options.budget.max_evaluations = 7;
  const Result cut = solve(window, {"coordinate", {}}, window.start(), options);
  EXPECT_EQ(cut.termination, Termination::MaxEvaluations);
  EXPECT_EQ(cut.counts.total(), 7);
}

}  // namespace
}  // namespace odobench
