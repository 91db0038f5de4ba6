// Two sets of run records side by side: what changed, by how much, and whether that is more than chance.
//
// Rows are matched by problem, data set name, box and label, figures by metric
// (reports/regression/metrics.hpp). Per pair:
//   change = median(new) - median(old) over the repeats, absolute and relative to |median(old)|;
//   Mann-Whitney's two-sided p, A12 and its name, the Hodges-Lehmann shift
//   (reports/statistics/mann_whitney.hpp).
// When is a change sure?
//   no noise      one run on both sides without any randomness: no random solver, the same options, start (a
//   random one: seed)
//                 and data, not ended by a clock. Cost, errors and counts then repeat to the last bit, so
//                 every difference is real: there is nothing to test. This never holds for times.
//   significant   at least two runs on one side, and p, corrected after Holm, is at most alpha.
//   else          it is not: single runs, too few runs for any p to get that low (smallest_p), or p is too
//                 high.
// Holm's correction runs over the gated tests together, and over the other tests together: many figures are
// looked at, and the verdict should have one level, alpha, whatever their number.
//
// Effort (evaluations, iterations, seconds) has no better direction where budgets differ and one of them
// ended a run.
//
// A gate is a metric with a limit, "J may not rise by more than 0.1 %". It fails when the change passes the
// limit AND is sure. Times that were taken on different processors are not gated unless asked for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/regression/metrics.hpp"
#include "reports/render/table.hpp"
#include "reports/statistics/mann_whitney.hpp"

namespace odobench {

struct Gate {
  std::string metric;        // name or family
  double limit = 0;          // signed: +0.001 fails on a rise, -0.2 on a fall beyond it
  bool relative = false;     // a fraction of |median(old)|
  std::string text() const;  // "J:+0.1%"
};

struct CompareOptions {
  std::vector<std::string> metrics;  // names or families, "all"; empty: all but e_sr
  std::vector<Gate> gates;  // of several for one metric the first counts; gated metrics are always compared
  double alpha = 0.05;
  bool gate_foreign_times = false;  // gate times although the processors differ
  // Whether a record's solver draws random numbers; empty: every run does.
  std::function<bool(const RunRecord&)> random;
};

enum class Finding { Equal, Rounding, Better, Worse, Changed, NotSignificant, TooFewRuns, SingleRuns };
std::string to_string(Finding finding);

// Differences of noiseless runs up to this, relative, are another compiler's or processor's rounding.
inline constexpr double kRounding = 1e-9;

struct Change {
  std::string problem, dataset, label;
  Metric before, after;  // the same metric of both sides
  double old_median = 0, new_median = 0;
  double change = 0, relative = 0;  // relative: infinite for a change from zero
  bool noiseless = false;
  std::optional<RankTest> test;  // none for noiseless pairs and single runs
  double p_adjusted = 1;         // of `test`
  double a12 = 0.5;              // probability that a new run is better (lower, where nothing says which)
  std::optional<double> shift;
  Finding finding = Finding::Equal;
  std::optional<Gate> gate;
  bool beyond = false;  // the change passes the gate's limit
  bool fails = false;   // and is sure
};

// Something that only one side has.
struct OneSided {
  std::string problem, dataset, label;
  std::string metric;  // "" for the whole row
  bool in_old = false;
  std::string remark;  // "skipped: why", or ""
};

struct RunComparison {
  std::vector<Change> changes;  // in the order of the old records' tables
  std::vector<OneSided> one_sided;
  std::vector<std::string>
      unlike;  // what makes the sides differ by more than the program: data, options, processor, ..
  std::vector<std::string> remarks;  // what was not gated, and why
  std::size_t tests = 0, gated_tests = 0, gated = 0;
  double alpha = 0.05;
  std::size_t limits = 0;  // gates that were asked for
  std::vector<std::string>
      missing;  // with gates: results of the old side that no limit can judge, for lack of a partner

  std::size_t failures() const;
  std::size_t count(Finding finding) const;
};

// Why gates that were asked for did not judge all they are there for, "" when they did: "nothing to compare:
// no limit of --fail-on meets a pair of results; no partner on the new side for 'lm' of demo".
std::string nothing_to_compare(const RunComparison& comparison);

// Throws std::invalid_argument when a side gives two results one name.
RunComparison compare_runs(const std::vector<RunRecord>& old_records,
                           const std::vector<RunRecord>& new_records, const CompareOptions& options);

// Names and families that either side knows, for messages about a misspelt one.
std::vector<std::string> metric_names(const std::vector<RunRecord>& old_records,
                                      const std::vector<RunRecord>& new_records);

// What makes two rows incomparable or unfair, one line each: "pso: option swarm 40, was 60".
std::vector<std::string> unlike_rows(const ComparisonRow& before, const ComparisonRow& after);

// One line: "Failed: 1 of 12 gated results is worse beyond its limit: pso J (+2.3 %)."
std::string verdict(const RunComparison& comparison);

// `machine`: columns of their own for what people read in one, for csv and json. In this order:
//   verdict    one row of counts; its title is the verdict, its notes say what is unlike and how was tested
//   changed    what is surely better, worse or otherwise changed, and what fails; absent when nothing
//   changes    every pair
//   one_sided  absent when there is nothing
std::vector<Table> change_tables(const RunComparison& comparison, bool machine);

// For a comment on a change: the verdict, the changes in a short table, everything else folded away.
std::string change_summary_markdown(const RunComparison& comparison);

}  // namespace odobench
