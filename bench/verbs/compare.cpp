#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/records.hpp"
#include "reports/regression/changes.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

constexpr const char* kCompareExamples = R"(Examples:
  bench compare results/old results/new
  bench compare old new --fail-on="J:+0.1%,evaluations:+50%" --format=md > comment.md
  bench compare old new --fail-on=e_sr:+1% --metrics=J,e_sr
  bench compare old new --fail-on=seconds:+20% --gate-foreign-times
Metrics: J, total, total_x, total_y, total_theta, e_sr.TRAJECTORY.x (.y, .theta; e_sr: all of them), evaluations, iterations,
seconds, and the statistics of filter runs and windows by name (statistics: all of them). A limit has the sign of the worse
direction; it fails when the change of the medians passes it and is sure: docs/cli.md says when it is.
Exit codes: 0 no limit passed for sure, 1 a limit passed, 2 wrong usage, 3 wrong data.)";

struct CompareVerbOptions {
  std::string before, after;         // folders with runs.jsonl, or .jsonl files
  std::vector<std::string> metrics;  // comma lists as typed
  std::vector<std::string> fail_on;  // comma lists of METRIC:LIMIT as typed
  double alpha = 0.05;
  bool gate_foreign_times = false;
  std::string format = "console";
};

void add_options(CLI::App& app, CompareVerbOptions& o) {
  app.add_option("old", o.before, "folder with runs.jsonl, or .jsonl file")->required();
  app.add_option("new", o.after, "the same of the runs to judge")->required();
  app.add_option("--fail-on", o.fail_on,
                 "limits such as J:+0.1%,seconds:+20%; exit code 1 when one is passed for sure, or when a "
                 "result of the old side has no partner [none]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--metrics", o.metrics, "what to compare; 'all' for everything [all but e_sr]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_value(
      app, "--alpha", "P", "level of significance, after Holm's correction [0.05]",
      [&o](const std::string& text) {
        o.alpha = finite_number("--alpha", text, true);
        if (o.alpha >= 1)
          throw std::invalid_argument(fmt::format("--alpha={}: expected a number above 0 and below 1", text));
      });
  app.add_flag("--gate-foreign-times", o.gate_foreign_times,
               "apply limits to times although they were taken on different processors");
  app.footer(kCompareExamples);
  add_format(app, o.format);
}

Gate parse_gate(const std::string& text) {
  const auto refuse = [&](const std::string& found) {
    throw std::invalid_argument(fmt::format(
        "--fail-on: '{}': {}, expected METRIC:LIMIT such as J:+0.1% or evaluations:+100", text, found));
  };
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) refuse("no ':'");
  if (colon == 0) refuse("no metric before the ':'");
  Gate gate;
  gate.metric = text.substr(0, colon);
  std::string size = text.substr(colon + 1);
  if (size.empty() || (size[0] != '+' && size[0] != '-')) refuse("a limit without a sign");
  gate.relative = size.back() == '%';
  if (gate.relative) size.pop_back();
  double value = 0;
  try {
    value = finite_number("limit", size.substr(1), false);
  } catch (const std::invalid_argument&) {
    refuse(fmt::format("'{}' is not a number", size.substr(1)));
  }
  if (value < 0) refuse("two signs");
  gate.limit = std::copysign(gate.relative ? value / 100 : value, size[0] == '-' ? -1.0 : 1.0);
  return gate;
}

void require_known(const char* option, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  std::string list;
  for (const std::string& k : known)
    if (k.find('.') == std::string::npos) list += (list.empty() ? "" : ", ") + k;
  throw std::invalid_argument(fmt::format("{}: neither side has a metric '{}'{}; there are {}", option, name,
                                          did_you_mean(name, known), list));
}

// A limit that points to the better side would fail on an improvement.
void require_worse_direction(const Gate& gate, const std::vector<RunRecord>& records) {
  for (const Comparison& group : compare(records))
    for (const ComparisonRow& row : group.rows)
      for (const Metric& metric : metrics_of(row)) {
        if (metric.name != gate.metric && metric.family != gate.metric) continue;
        const bool falls = std::signbit(gate.limit);
        if (gate.metric == "statistics" || metric.better != (falls ? Better::Lower : Better::Higher))
          continue;
        throw std::invalid_argument(
            fmt::format("--fail-on: '{}': {} is better when {}, expected a limit with {}", gate.text(),
                        gate.metric, falls ? "lower" : "higher", falls ? '+' : '-'));
      }
}

// Solvers of other versions that this one does not know may be anything.
bool draws_random_numbers(const RunRecord& record, const Catalogue& catalogue) {
  const auto stochastic = [&catalogue](const std::string& text) {
    for (const SolverSpec& spec : parse_solver_list(text)) {
      if (spec.name == "zero") continue;  // the filter without any search
      if (catalogue.solver(spec.name).stochastic) return true;
    }
    return false;
  };
  try {
    return stochastic(record.solver) || (!record.polish.empty() && stochastic(record.polish));
  } catch (const std::invalid_argument&) {
    return true;
  }
}

// "J:+0.1%,seconds:+20%,evaluations:+50": a sign that says which way is worse, a size, % for relative ones.
// Throws std::invalid_argument that names the part, what was found and what was expected. Names of metrics
// are not checked.
std::vector<Gate> parse_gates(const std::vector<std::string>& lists) {
  std::vector<Gate> gates;
  for (const std::string& text : comma_items(lists)) {
    gates.push_back(parse_gate(text));
    for (std::size_t i = 0; i + 1 < gates.size(); ++i)
      if (gates[i].metric == gates.back().metric)
        throw std::invalid_argument(
            fmt::format("--fail-on: '{}': a second limit for {}, expected one", text, gates[i].metric));
  }
  return gates;
}

ExitCode compare_command(const CompareVerbOptions& a, const Catalogue& catalogue) {
  const Format format = parse_format(a.format);
  CompareOptions options;
  options.gates = parse_gates(a.fail_on);
  options.metrics = comma_items(a.metrics);
  options.alpha = a.alpha;
  options.gate_foreign_times = a.gate_foreign_times;
  options.random = [&catalogue](const RunRecord& record) { return draws_random_numbers(record, catalogue); };
  TerminalWatcher watcher;
  const std::vector<RunRecord> before = read_all_records({a.before}, watcher);
  const std::vector<RunRecord> after = read_all_records({a.after}, watcher);
  const std::vector<std::string> known = metric_names(before, after);
  for (const Gate& gate : options.gates) {
    require_known("--fail-on", gate.metric, known);
    require_worse_direction(gate, before);
  }
  for (const std::string& name : options.metrics)
    if (name != "all") require_known("--metrics", name, known);
  const RunComparison comparison = compare_runs(before, after, options);
  if (format == Format::Markdown)
    print_text(change_summary_markdown(comparison));
  else
    print_tables(change_tables(comparison, format == Format::Json || format == Format::Csv), format);
  const std::string nothing = nothing_to_compare(comparison);
  if (!nothing.empty()) warn(nothing);
  return comparison.failures() > 0 || !nothing.empty() ? ExitCode::CheckFailed : ExitCode::Success;
}

}  // namespace

VerbAction add_compare(CLI::App& app) {
  return verb_action<CompareVerbOptions>(app, add_options, compare_command);
}

}  // namespace odobench
