#include "reports/kinds/optimisers/optimiser_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/range.hpp"
#include "reports/kinds/optimisers/optimiser_scores.hpp"
#include "reports/statistics/mann_whitney.hpp"
#include "reports/statistics/optimisers/runtimes.hpp"
#include "reports/statistics/optimisers/signed_rank.hpp"

namespace odobench {
namespace {

// Between the ERT of a solver that succeeds and infinity.
constexpr double kUnsolved = 1e100;

double last_gap(const std::vector<Trial>& trials) {
  std::vector<double> gaps;
  for (const Trial& trial : trials)
    gaps.push_back(trial.steps.empty() ? kInfinity : trial.steps.back().second);
  std::sort(gaps.begin(), gaps.end());
  return gaps.empty() ? kInfinity : gaps[gaps.size() / 2];
}

double rank_score(const std::vector<Trial>& trials) {
  const double ert = expected_runtime(trials, kLastGap).evaluations;
  if (std::isfinite(ert)) return ert;
  const double gap = last_gap(trials);
  return std::isfinite(gap) ? kUnsolved * (1 + gap / (1 + gap)) : kInfinity;
}

Cell interval_cell(const ShareInterval& share) {
  return text_cell(fmt::format("{:.2f} [{:.2f}, {:.2f}]", share.share, share.lower, share.upper));
}

std::string gap_note() {
  return "A gap is (J - J*) / (J_0 - J*) with the lowest known J*, or the lowest of these records, and the "
         "median J_0 "
         "of the starts; of bbob it is f - f_opt. ERT: evaluations of all runs until the gap is reached, or "
         "in all, per "
         "success; inf without one.";
}

std::string wilson_note() {
  return "Shares with Wilson's 95 % interval.";
}

Table ert_table(const TrialTable& table) {
  Table out{"ert",
            "Expected running time (ERT), in evaluations, to gaps",
            {text_column("problem"), text_column("solver"), number_column("runs")},
            {},
            {gap_note(), wilson_note()}};
  for (const double gap : kGaps)
    out.columns.push_back(number_column(fmt::format("ert_{:g}", gap), fmt::format("{:g}", gap)));
  out.columns.push_back(text_column("success", fmt::format("success at {:g}", kLastGap)));
  for (const ProblemTrials& problem : table.problems)
    for (std::size_t s = 0; s < table.solvers.size(); ++s) {
      const std::vector<Trial>& trials = problem.of[s];
      if (trials.empty()) continue;
      std::vector<Cell> row{text_cell(problem.problem), text_cell(table.solvers[s]),
                            count_cell(static_cast<double>(trials.size()))};
      for (const double gap : kGaps)
        row.push_back(significant_cell(expected_runtime(trials, gap).evaluations, 4));
      const ExpectedRuntime last = expected_runtime(trials, kLastGap);
      row.push_back(interval_cell(wilson_interval(last.successes, last.trials)));
      out.rows.push_back(std::move(row));
    }
  return out;
}

Table profile_table(const TrialTable& table) {
  const auto share = [](const char* id, const char* name) {
    return best_if(Better::Higher, number_column(id, name));
  };
  Table out{"profiles",
            "Profiles over all problems",
            {text_column("solver"), text_column("success", fmt::format("runs within {:g}", kLastGap)),
             share("ecdf_10", "ECDF 10 n"), share("ecdf_100", "ECDF 100 n"),
             share("ecdf_1000", "ECDF 1000 n"), share("data_10", "data 10"), share("data_100", "data 100"),
             share("data_1000", "data 1000"), share("performance_1", "quickest"),
             share("performance_4", "within 4 times"), share("performance_any", "solved")},
            {},
            {}};
  for (std::size_t s = 0; s < table.solvers.size(); ++s) {
    std::size_t successes = 0, trials = 0;
    for (const ProblemTrials& problem : table.problems) {
      const ExpectedRuntime result = expected_runtime(problem.of[s], kLastGap);
      successes += result.successes;
      trials += result.trials;
    }
    std::vector<Cell> row{text_cell(table.solvers[s]),
                          trials == 0 ? Cell{} : interval_cell(wilson_interval(successes, trials))};
    const StepCurve ecdf = runtime_distribution(table, s);
    for (const double x : {10.0, 100.0, 1000.0}) row.push_back(fixed_cell(value_at(ecdf, x), 3));
    const StepCurve data = data_profile(table, s, kLastGap);
    for (const double x : {10.0, 100.0, 1000.0}) row.push_back(fixed_cell(value_at(data, x), 3));
    const StepCurve performance = performance_profile(table, s, kLastGap);
    for (const double x : {1.0, 4.0, kInfinity}) row.push_back(fixed_cell(value_at(performance, x), 3));
    out.rows.push_back(std::move(row));
  }
  out.notes = {
      wilson_note() +
          " Runs of one problem are not independent: over problems the interval is a description.",
      "ECDF: share of (problem, target) reached within so many evaluations times the dimension n, with 100 "
      "simulated restarts each; targets are gaps from 100 (bbob) or 0.6 down to 1e-8.",
      fmt::format("Data, performance profiles: share of problems solved to {:g} within so many simplex "
                  "gradients (n + 1 evaluations), within a multiple of the quickest solver's evaluations; "
                  "medians over runs.",
                  kLastGap)};
  return out;
}

Table rank_table(const TrialTable& table, const RankScores& ranks) {
  Table out{"ranks",
            "Mean ranks of the solvers",
            {text_column("solver"), best_if(Better::Lower, number_column("mean_rank")),
             number_column("first"), number_column("solved")},
            {},
            {}};
  for (std::size_t s = 0; s < table.solvers.size(); ++s) {
    double first = 0, solved = 0;
    for (const std::vector<double>& row : ranks.scores) {
      if (row[s] == *std::min_element(row.begin(), row.end()) && std::isfinite(row[s])) ++first;
      if (row[s] < kUnsolved) ++solved;
    }
    out.rows.push_back({text_cell(table.solvers[s]), fixed_cell(ranks.test.mean_ranks[s], 3),
                        count_cell(first), count_cell(solved)});
  }
  out.notes = {
      fmt::format(
          "Rank on each of {} problems by ERT to a gap of {:g}; solvers that never reach it come after "
          "those that do, by their median last gap. Ties share their mean rank.",
          ranks.test.problems, kLastGap),
      fmt::format(
          "Friedman: chi2({}) = {:.4g}, p = {:.3g}; Iman and Davenport: F({}, {}) = {:.4g}, p = {:.3g}.",
          table.solvers.size() - 1, ranks.test.chi_squared, ranks.test.p, table.solvers.size() - 1,
          (table.solvers.size() - 1) * (ranks.test.problems - 1), ranks.test.f, ranks.test.f_p),
      fmt::format("Nemenyi's critical difference of mean ranks at {:g}, for all pairs together: {:.4g}.",
                  kAlpha, ranks.critical_difference)};
  return out;
}

struct SolverPair {
  std::size_t a, b;
  SignedRankTest test;
  std::optional<PairedShift> shift;
};

std::vector<SolverPair> solver_pairs(const TrialTable& table) {
  std::vector<SolverPair> pairs;
  for (std::size_t a = 0; a < table.solvers.size(); ++a)
    for (std::size_t b = a + 1; b < table.solvers.size(); ++b) {
      const std::vector<double> ratios = log_ratios(table, a, b);
      std::vector<double> finite = ratios;
      std::erase_if(finite, [](double r) { return !std::isfinite(r); });
      pairs.push_back({a, b, signed_rank_test(ratios), paired_shift(finite)});
    }
  return pairs;
}

Table pair_table(const TrialTable& table, const RankScores& ranks) {
  Table out{"rank_pairs",
            "Solver against solver",
            {text_column("solver"), text_column("other"), number_column("rank_difference"),
             number_column("nemenyi_p"), number_column("problems"), number_column("wilcoxon_p"),
             number_column("holm_p"), number_column("factor"), text_column("interval")},
            {},
            {}};
  const std::vector<SolverPair> pairs = solver_pairs(table);
  std::vector<double> p;
  for (const SolverPair& pair : pairs) p.push_back(pair.test.p);
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const SolverPair& pair = pairs[i];
    const double difference = ranks.test.mean_ranks[pair.b] - ranks.test.mean_ranks[pair.a];
    std::vector<Cell> row{
        text_cell(table.solvers[pair.a]),
        text_cell(table.solvers[pair.b]),
        fixed_cell(difference, 3),
        significant_cell(nemenyi_p(difference, table.solvers.size(), ranks.test.problems), 3),
        count_cell(static_cast<double>(pair.test.pairs)),
        significant_cell(pair.test.p, 3),
        significant_cell(adjusted[i], 3)};
    row.push_back(pair.shift ? significant_cell(std::pow(10, pair.shift->estimate), 4) : Cell{});
    row.push_back(pair.shift && pair.shift->lower
                      ? text_cell(fmt::format("[{:.3g}, {:.3g}]", std::pow(10, *pair.shift->lower),
                                              std::pow(10, *pair.shift->upper)))
                      : Cell{});
    out.rows.push_back(std::move(row));
  }
  out.notes = {
      fmt::format(
          "Wilcoxon's signed rank test of log ERT to {:g}, problem by problem (not reached: infinite; "
          "problems that are alike on both sides are left out), p adjusted by Holm over the {} pairs.",
          kLastGap, pairs.size()),
      "Factor: how many times the evaluations of the first the second needs, Hodges and Lehmann's estimate "
      "over "
      "the problems that both solve, with its 95 % interval (not corrected for the number of pairs; from six "
      "problems on)."};
  return out;
}

}  // namespace

bool enough_trials(const TrialTable& table) {
  return table.solvers.size() >= kFewestSolvers && table.problems.size() >= kFewestProblems;
}

RankScores rank_scores(const TrialTable& table) {
  RankScores ranks;
  for (const ProblemTrials& problem : table.problems) {
    ranks.scores.emplace_back();
    for (const std::vector<Trial>& trials : problem.of) ranks.scores.back().push_back(rank_score(trials));
  }
  ranks.test = friedman_test(ranks.scores);
  ranks.critical_difference = nemenyi_difference(table.solvers.size(), ranks.scores.size(), kAlpha);
  return ranks;
}

std::vector<double> log_ratios(const TrialTable& table, std::size_t a, std::size_t b) {
  std::vector<double> ratios;
  for (const ProblemTrials& problem : table.problems)
    ratios.push_back(std::log10(expected_runtime(problem.of[b], kLastGap).evaluations) -
                     std::log10(expected_runtime(problem.of[a], kLastGap).evaluations));
  return ratios;
}

std::vector<Table> optimiser_tables(const std::vector<RunRecord>& records) {
  const TrialTable table = trial_table(records);
  if (!enough_trials(table)) return {};
  const RankScores ranks = rank_scores(table);
  return {ert_table(table), profile_table(table), rank_table(table, ranks), pair_table(table, ranks)};
}

}  // namespace odobench
