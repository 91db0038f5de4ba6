#include "reports/regression/changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/range.hpp"

namespace odobench {
namespace {

constexpr const char* kOtherBox = "another dimension or box";

double median_of(const std::vector<double>& values) {
  return spread(values).median;
}

bool same_values(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

bool has_nan(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
}

std::vector<double> as_costs(const Metric& metric) {
  std::vector<double> values = metric.values;
  if (metric.better == Better::Higher)
    for (double& value : values) value = -value;
  return values;
}

// One run each that any repetition would give again, to the last bit.
bool noiseless(const ComparisonRow& before, const ComparisonRow& after, const CompareOptions& options) {
  if (before.runs.size() != 1 || after.runs.size() != 1) return false;
  const RunRecord &a = *before.runs[0], &b = *after.runs[0];
  if (a.dataset_sha256 != b.dataset_sha256 || a.kind != b.kind) return false;
  if (a.kind == "evaluation") return true;
  if (!options.random || options.random(a) || options.random(b)) return false;
  for (const RunRecord* r : {&a, &b})
    if (r->termination == "time_limit" || r->termination == "interrupted") return false;
  // A seed that nothing draws from but a random start does not matter.
  return a.options == b.options && a.polish == b.polish && a.start == b.start &&
         (a.start == "nominal" || a.seed == b.seed);
}

void measure(Change& c) {
  if (has_nan(c.before.values) || has_nan(c.after.values)) {
    c.old_median = c.new_median = c.change = c.relative = kNotANumber;
    return;
  }
  c.old_median = median_of(c.before.values);
  c.new_median = median_of(c.after.values);
  // Two failed runs are equal, although infinity - infinity is not zero.
  c.change = c.old_median == c.new_median ? 0 : c.new_median - c.old_median;
  c.relative = c.change == 0                               ? 0
               : c.old_median == 0 || std::isinf(c.change) ? std::copysign(kInfinity, c.change)
                                                           : c.change / std::abs(c.old_median);
  const std::vector<double> before = as_costs(c.before), after = as_costs(c.after);
  c.a12 = probability_lower(before, after);
  c.shift = median_shift(c.before.values, c.after.values);
  if (!c.noiseless && before.size() + after.size() > 2) c.test = rank_test(before, after);
}

bool passes_limit(const Change& c, const Gate& gate) {
  const double size = gate.relative ? c.relative : c.change;
  return gate.limit < 0 || std::signbit(gate.limit) ? size < gate.limit : size > gate.limit;
}

Finding direction(const Change& c) {
  if (c.before.better == Better::None) return Finding::Changed;
  if (c.noiseless)
    return (c.change < 0) == (c.before.better == Better::Lower) ? Finding::Better : Finding::Worse;
  return c.a12 > 0.5 ? Finding::Better : Finding::Worse;
}

Finding finding_of(const Change& c, double alpha) {
  if (same_values(c.before.values, c.after.values)) return Finding::Equal;
  if (c.noiseless) return std::abs(c.relative) <= kRounding ? Finding::Rounding : direction(c);
  if (!c.test) return Finding::SingleRuns;
  if (c.p_adjusted <= alpha) return direction(c);
  return smallest_p(c.before.values.size(), c.after.values.size()) > alpha ? Finding::TooFewRuns
                                                                           : Finding::NotSignificant;
}

// The sign of the limit says which way is bad; a significant test must point there as well as the median.
bool is_sure(const Change& c, const Gate& gate, double alpha) {
  if (c.noiseless) return true;
  if (!c.test || c.p_adjusted > alpha) return false;
  const bool rose = c.before.better == Better::Higher ? c.a12 > 0.5 : c.a12 < 0.5;
  return rose == !std::signbit(gate.limit);
}

// A run that its budget ended says nothing about effort when the other side had another budget: less of it is
// not better.
bool stopped_by_other_budget(const ComparisonRow& before, const ComparisonRow& after) {
  if (before.shown->budget == after.shown->budget) return false;
  const auto stopped = [](const RunRecord* run) {
    return run->termination == "max_evaluations" || run->termination == "time_limit" ||
           run->termination == "target_reached" || run->termination == "interrupted";
  };
  return std::any_of(before.runs.begin(), before.runs.end(), stopped) ||
         std::any_of(after.runs.begin(), after.runs.end(), stopped);
}

class Comparer {
 public:
  Comparer(const std::vector<RunRecord>& old_records, const std::vector<RunRecord>& new_records,
           const CompareOptions& options)
      : options_(options), old_(compare(old_records)), new_(compare(new_records)) {
    require_unique(old_);
    require_unique(new_);
    result_.alpha = options.alpha;
  }

  RunComparison run() {
    for (const Comparison& group : old_)
      for (const ComparisonRow& row : group.rows) {
        if (const ComparisonRow* other = find(new_, group, row.label))
          pair(group, row, *other);
        else
          result_.one_sided.push_back(
              {group.problem, group.dataset, row.label, "", true, why_alone(new_, group, row)});
      }
    for (const Comparison& group : new_)
      for (const ComparisonRow& row : group.rows)
        if (find(old_, group, row.label) == nullptr)
          result_.one_sided.push_back(
              {group.problem, group.dataset, row.label, "", false, why_alone(old_, group, row)});
    judge();
    return std::move(result_);
  }

 private:
  // Another dimension or another box is another problem.
  static const ComparisonRow* find(const std::vector<Comparison>& groups, const Comparison& like,
                                   const std::string& label, bool any_box = false) {
    for (const Comparison& group : groups)
      for (const ComparisonRow& row : group.rows)
        if (group.problem == like.problem && group.dataset == like.dataset && row.label == label &&
            (any_box || same_problem_box(group.box, like.box)))
          return &row;
    return nullptr;
  }

  static std::string why_alone(const std::vector<Comparison>& others, const Comparison& group,
                               const ComparisonRow& row) {
    if (row.kind == "skipped") return skipped(row);
    return find(others, group, row.label, true) != nullptr ? kOtherBox : "";
  }

  static std::string skipped(const ComparisonRow& row) {
    return row.kind == "skipped" ? "skipped: " + row.shown->message : "";
  }

  static bool listed(const Metric& metric, const std::string& name) {
    return name == "all" || name == metric.name || name == metric.family;
  }

  const Gate* gate_of(const Metric& metric) const {
    for (const Gate& gate : options_.gates)
      if (listed(metric, gate.metric)) return &gate;
    return nullptr;
  }

  bool wanted(const Metric& metric) const {
    if (gate_of(metric) != nullptr) return true;
    if (options_.metrics.empty()) return metric.family != "e_sr";
    return std::any_of(options_.metrics.begin(), options_.metrics.end(),
                       [&](const std::string& name) { return listed(metric, name); });
  }

  void pair(const Comparison& group, const ComparisonRow& before, const ComparisonRow& after) {
    for (std::string& line : unlike_rows(before, after))
      if (std::find(result_.unlike.begin(), result_.unlike.end(), line) == result_.unlike.end())
        result_.unlike.push_back(std::move(line));
    const std::vector<Metric> old_metrics = metrics_of(before), new_metrics = metrics_of(after);
    const auto one_sided = [&](const std::vector<Metric>& metrics, const std::vector<Metric>& others,
                               bool in_old) {
      const std::string remark = skipped(in_old ? after : before);
      if (others.empty() && !metrics.empty()) {
        result_.one_sided.push_back({group.problem, group.dataset, before.label, "", in_old, remark});
        return;
      }
      for (const Metric& metric : metrics)
        if (wanted(metric) && find_metric(others, metric.name) == nullptr)
          result_.one_sided.push_back(
              {group.problem, group.dataset, before.label, metric.name, in_old, remark});
    };
    const bool same = noiseless(before, after, options_);
    const bool unfair = stopped_by_other_budget(before, after);
    const bool foreign = before.shown->context.cpu != after.shown->context.cpu;
    for (const Metric& metric : old_metrics) {
      const Metric* other = find_metric(new_metrics, metric.name);
      if (other == nullptr || !wanted(metric)) continue;
      Change c;
      c.problem = group.problem;
      c.dataset = group.dataset;
      c.label = before.label;
      c.before = metric;
      c.after = *other;
      if (unfair && metric.effort) c.before.better = c.after.better = Better::None;
      c.noiseless = same && !metric.timing;
      measure(c);
      const Gate* gate = gate_of(metric);
      if (gate != nullptr && metric.timing && foreign && !options_.gate_foreign_times)
        foreign_times_ = true;
      else if (gate != nullptr)
        c.gate = *gate;
      result_.changes.push_back(std::move(c));
    }
    one_sided(old_metrics, new_metrics, true);
    one_sided(new_metrics, old_metrics, false);
  }

  void correct(bool gated) {
    std::vector<double> p_values;
    for (const Change& c : result_.changes)
      if (c.test && c.gate.has_value() == gated) p_values.push_back(c.test->p);
    const std::vector<double> adjusted = holm(p_values);
    (gated ? result_.gated_tests : result_.tests) = p_values.size();
    std::size_t next = 0;
    for (Change& c : result_.changes)
      if (c.test && c.gate.has_value() == gated) c.p_adjusted = adjusted[next++];
  }

  void judge() {
    correct(true);
    correct(false);
    std::size_t unsure = 0;
    for (Change& c : result_.changes) {
      c.finding = finding_of(c, options_.alpha);
      if (!c.gate) continue;
      ++result_.gated;
      c.beyond = passes_limit(c, *c.gate);
      c.fails = c.beyond && is_sure(c, *c.gate, options_.alpha);
      if (c.beyond && !c.fails) ++unsure;
    }
    if (unsure > 0)
      result_.remarks.push_back(fmt::format(
          "{} gated result{} passed {} limit without being sure: 'limit' marks {} with ?.", unsure,
          unsure == 1 ? "" : "s", unsure == 1 ? "its" : "their", unsure == 1 ? "it" : "them"));
    if (foreign_times_)
      result_.remarks.push_back(
          "Times were taken on different processors and are not gated; --gate-foreign-times does so.");
  }

  const CompareOptions& options_;
  const std::vector<Comparison> old_, new_;
  RunComparison result_;
  bool foreign_times_ = false;
};

bool same_box(const RunRecord& a, const RunRecord& b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end(),
                    [](const ParameterValue& p, const ParameterValue& q) {
                      return p.name == q.name && p.lower == q.lower && p.upper == q.upper;
                    });
}

// Results of the old side that no limit can judge: their label is gone for their problem and data set, or
// what is there has another dimension or box. Named once each.
std::vector<std::string> without_partner(const RunComparison& comparison,
                                         const std::vector<RunRecord>& before,
                                         const std::vector<RunRecord>& after) {
  const auto name = [](const auto& of) {
    return fmt::format("'{}' of {}", of.label, of.dataset.empty() ? of.problem : of.dataset);
  };
  std::vector<std::string> list;
  for (const OneSided& o : comparison.one_sided)
    if (o.in_old && o.metric.empty() && o.remark.empty()) list.push_back(name(o));
  using Row = std::tuple<std::string, std::string, std::string>;
  std::map<Row, std::vector<const RunRecord*>> boxes;  // of the new side, one record per box
  const auto there = [](const std::vector<const RunRecord*>& seen, const RunRecord& r) {
    return std::any_of(seen.begin(), seen.end(), [&](const RunRecord* s) { return same_box(*s, r); });
  };
  for (const RunRecord& r : after) {
    std::vector<const RunRecord*>& seen = boxes[{r.problem, r.dataset, r.label}];
    if (r.cost && !there(seen, r)) seen.push_back(&r);
  }
  std::set<std::string> other;
  for (const RunRecord& old : before) {
    const auto seen = boxes.find({old.problem, old.dataset, old.label});
    if (!old.cost || seen == boxes.end() || seen->second.empty() || there(seen->second, old)) continue;
    if (other.insert(name(old)).second) list.push_back(fmt::format("{} ({})", name(old), kOtherBox));
  }
  return list;
}

void add_options(std::vector<std::string>& lines, const std::string& label,
                 const std::map<std::string, std::string>& before,
                 const std::map<std::string, std::string>& after) {
  std::set<std::string> names;
  for (const auto* options : {&before, &after})
    for (const auto& [name, value] : *options) names.insert(name);
  const auto value = [](const std::map<std::string, std::string>& options, const std::string& name) {
    const auto found = options.find(name);
    return found == options.end() ? std::string("absent") : found->second;
  };
  for (const std::string& name : names)
    if (value(before, name) != value(after, name))
      lines.push_back(
          fmt::format("{}: option {} {}, was {}", label, name, value(after, name), value(before, name)));
}

void add_box(std::vector<std::string>& lines, const std::string& label, const RunRecord& a,
             const RunRecord& b) {
  for (const ParameterValue& p : a.parameters)
    for (const ParameterValue& q : b.parameters)
      if (p.name == q.name && (p.lower != q.lower || p.upper != q.upper || p.nominal != q.nominal)) {
        lines.push_back(fmt::format("{}: nominal value or bounds of parameter {} differ", label, p.name));
        return;
      }
}

void add_parameters(std::vector<std::string>& lines, const std::string& label, const RunRecord& a,
                    const RunRecord& b) {
  if (a.kind != "evaluation" || b.kind != "evaluation") return;
  for (const ParameterValue& p : a.parameters)
    for (const ParameterValue& q : b.parameters)
      if (p.name == q.name && p.value != q.value) {
        lines.push_back(fmt::format("{}: other parameters were evaluated, {} {:.9g}, was {:.9g}", label,
                                    p.name, q.value, p.value));
        return;
      }
}

void add_field(std::vector<std::string>& lines, const std::string& what, const std::string& before,
               const std::string& after) {
  if (before != after && !before.empty() && !after.empty())
    lines.push_back(fmt::format("{} {}, was {}", what, after, before));
}

}  // namespace

std::string Gate::text() const {
  return relative ? fmt::format("{}:{:+.12g}%", metric, 100 * limit)
                  : fmt::format("{}:{:+.12g}", metric, limit);
}

std::string to_string(Finding finding) {
  switch (finding) {
    case Finding::Equal:
      return "equal";
    case Finding::Rounding:
      return "rounding";
    case Finding::Better:
      return "better";
    case Finding::Worse:
      return "worse";
    case Finding::Changed:
      return "changed";
    case Finding::NotSignificant:
      return "not significant";
    case Finding::TooFewRuns:
      return "too few runs";
    case Finding::SingleRuns:
      return "single runs";
  }
  return {};
}

std::size_t RunComparison::failures() const {
  return static_cast<std::size_t>(
      std::count_if(changes.begin(), changes.end(), [](const Change& c) { return c.fails; }));
}

std::size_t RunComparison::count(Finding finding) const {
  return static_cast<std::size_t>(std::count_if(changes.begin(), changes.end(),
                                                [finding](const Change& c) { return c.finding == finding; }));
}

std::vector<std::string> unlike_rows(const ComparisonRow& before, const ComparisonRow& after) {
  const RunRecord &a = *before.shown, &b = *after.shown;
  const std::string& label = before.label;
  std::vector<std::string> lines;
  if (a.dataset_sha256 != b.dataset_sha256)
    lines.push_back(fmt::format("data set {}: other content (SHA-256 {}.., was {}..)", a.dataset,
                                b.dataset_sha256.substr(0, 8), a.dataset_sha256.substr(0, 8)));
  add_options(lines, label, a.options, b.options);
  add_field(lines, label + ": solver", a.solver, b.solver);
  if (a.polish != b.polish)
    lines.push_back(fmt::format("{}: polish '{}', was '{}'", label, b.polish, a.polish));
  add_field(lines, label + ": start", a.start, b.start);
  if (a.kind == "run" && b.kind == "run" && a.base_seed != b.base_seed)
    lines.push_back(fmt::format("base seed {}, was {}", b.base_seed, a.base_seed));
  for (const auto& [name, value] : a.budget) {
    const auto found = b.budget.find(name);
    if (found != b.budget.end() && found->second != value)
      lines.push_back(fmt::format("budget {} {:.10g}, was {:.10g}", name, found->second, value));
  }
  add_box(lines, label, a, b);
  add_parameters(lines, label, a, b);
  add_field(lines, "processor", a.context.cpu, b.context.cpu);
  add_field(lines, "kernel", a.context.kernel, b.context.kernel);
  add_field(lines, "compiler", a.context.compiler, b.context.compiler);
  add_field(lines, "build", a.context.build_type, b.context.build_type);
  if (a.context.threads != b.context.threads)
    lines.push_back(fmt::format("threads {}, was {}: runs side by side slow each other down",
                                b.context.threads, a.context.threads));
  return lines;
}

RunComparison compare_runs(const std::vector<RunRecord>& old_records,
                           const std::vector<RunRecord>& new_records, const CompareOptions& options) {
  RunComparison result = Comparer(old_records, new_records, options).run();
  result.limits = options.gates.size();
  if (result.limits > 0) result.missing = without_partner(result, old_records, new_records);
  return result;
}

std::string nothing_to_compare(const RunComparison& comparison) {
  if (comparison.limits == 0 || (comparison.gated > 0 && comparison.missing.empty())) return "";
  std::string text = "nothing to compare: ";
  if (comparison.gated == 0) text += "no limit of --fail-on meets a pair of results";
  if (!comparison.missing.empty())
    text += fmt::format("{}no partner on the new side for {}", comparison.gated == 0 ? "; " : "",
                        fmt::join(comparison.missing, ", "));
  return text;
}

std::vector<std::string> metric_names(const std::vector<RunRecord>& old_records,
                                      const std::vector<RunRecord>& new_records) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto* records : {&old_records, &new_records})
    for (const Comparison& group : compare(*records))
      for (const ComparisonRow& row : group.rows)
        for (const Metric& metric : metrics_of(row)) {
          add(metric.name);
          add(metric.family);
        }
  return names;
}

}  // namespace odobench
