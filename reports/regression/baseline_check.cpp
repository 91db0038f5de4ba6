#include <fmt/format.h>

#include <cmath>

#include "reports/regression/baseline.hpp"
#include "reports/regression/metrics.hpp"
#include "reports/statistics/mann_whitney.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {
namespace {

// Empty where a difference of finite numbers overflows.
Cell finite_cell(double value, int digits) {
  return std::isfinite(value) ? significant_cell(value, digits) : Cell{};
}

class Check {
 public:
  Check() {
    report_.passed = true;
    Table& table = report_.table;
    table.id = "baseline";
    table.title = "Differences from the baseline";
    for (const char* id : {"finding", "problem", "label", "cell"}) {
      Column column;
      column.id = column.name = id;
      column.align = Align::Left;
      table.columns.push_back(column);
    }
    for (const char* id : {"expected", "found", "difference", "tolerance"}) {
      Column column;
      column.id = column.name = id;
      column.group = "values";
      table.columns.push_back(column);
    }
  }

  void enter(const std::string& problem, const std::string& dataset, const std::string& label) {
    problem_ = dataset.empty() ? problem : fmt::format("{}, {}", problem, dataset);
    label_ = label;
  }

  void entry(const BaselineEntry& expected, const ComparisonRow& found) {
    if (expected.kind != found.kind) {
      add("moved", "kind", text_cell(expected.kind), text_cell(found.kind), true);
    }
    ++compared_;
    const Tolerances& t = expected.tolerances;
    if (!expected.samples.empty() && found.runs.size() > 1) return samples(expected, found);
    optional_number("J", expected.cost, found.shown->cost,
                    t.cost_relative * std::abs(expected.cost.value_or(0)));
    if (expected.evaluations && t.evaluations_factor && found.kind == "run")
      effort(*expected.evaluations, found.shown->evaluations, *t.evaluations_factor);
    if (expected.totals && !found.errors.empty())
      totals(*expected.totals, error_totals(found.errors), t.total);
    for (const TrajectoryErrors& errors : expected.errors) trajectory(errors, found.errors, t);
    for (const TrajectoryErrors& errors : found.errors)
      if (!expected.errors.empty() && find_trajectory(expected.errors, errors.trajectory) == nullptr)
        add("additional", errors.trajectory, Cell{}, Cell{}, true);
  }

  void missing_label() { add("missing", "label", Cell{}, Cell{}, true); }
  void additional_label() { add("additional", "label", Cell{}, Cell{}, false); }

  BaselineReport finish(const std::string& source) {
    judge_samples();
    if (compared_ == 0) report_.passed = false;  // a gate that looks at nothing holds nothing
    report_.compared = compared_;
    const std::size_t rows = report_.table.rows.size();
    report_.table.notes.push_back(fmt::format("{} values compared{}: {}.", compared_,
                                              source.empty() ? "" : fmt::format(" with {}", source),
                                              compared_ == 0   ? "nothing to compare, which fails"
                                              : rows == 0      ? "all within tolerance"
                                              : report_.passed ? "passed"
                                                               : "failed"));
    return std::move(report_);
  }

 private:
  void add(const char* finding, const std::string& cell, Cell expected, Cell found, bool fails) {
    report_.table.rows.push_back({text_cell(finding), text_cell(problem_), text_cell(label_), text_cell(cell),
                                  std::move(expected), std::move(found), Cell{}, Cell{}});
    if (fails) report_.passed = false;
  }

  void number(const std::string& cell, double expected, double found, double tolerance) {
    ++compared_;
    const bool both = std::isfinite(expected) && std::isfinite(found);
    if (both ? std::abs(found - expected) <= tolerance : std::isfinite(expected) == std::isfinite(found))
      return;
    add("moved", cell, significant_cell(expected, 10), significant_cell(found, 10), true);
    if (both) report_.table.rows.back()[6] = finite_cell(found - expected, 3);
    report_.table.rows.back()[7] = finite_cell(tolerance, 3);
  }

  // null in the file is a run without a result.
  void optional_number(const std::string& cell, std::optional<double> expected, std::optional<double> found,
                       double tolerance) {
    if (expected && found) return number(cell, *expected, *found, tolerance);
    ++compared_;
    const auto finite = [](const std::optional<double>& v) { return v && std::isfinite(*v); };
    if (!finite(expected) && !finite(found)) return;
    const auto value = [](const std::optional<double>& v) {
      return v ? significant_cell(*v, 10) : text_cell("none");
    };
    add("moved", cell, value(expected), value(found), true);
  }

  void effort(std::int64_t expected, std::int64_t found, double factor) {
    ++compared_;
    const double limit = factor * static_cast<double>(expected);
    if (static_cast<double>(found) <= limit) return;
    add("moved", "evaluations", count_cell(static_cast<double>(expected)),
        count_cell(static_cast<double>(found)), true);
    report_.table.rows.back()[6] = count_cell(static_cast<double>(found - expected));
    report_.table.rows.back()[7] = significant_cell(limit - static_cast<double>(expected), 6);
  }

  // What several runs of one label gave; judged together, at the end.
  struct Sample {
    std::string problem, label, cell;
    double expected, found;  // medians
    double tolerance;
    RankTest test;
  };

  void samples(const BaselineEntry& expected, const ComparisonRow& found) {
    const std::vector<Metric> metrics = metrics_of(found);
    const auto add_sample = [&](const char* key, const char* metric, const char* shown,
                                const auto& tolerance) {
      const auto before = expected.samples.find(key);
      if (before == expected.samples.end()) return;
      const Metric* after = find_metric(metrics, metric);
      if (after == nullptr) return add("missing", shown, Cell{}, Cell{}, true);
      const double old_median = spread(before->second).median, new_median = spread(after->values).median;
      samples_.push_back({problem_, label_, shown, old_median, new_median, tolerance(old_median),
                          rank_test(before->second, after->values)});
    };
    const Tolerances& t = expected.tolerances;
    add_sample("cost", "J", "J", [&](double median) { return t.cost_relative * std::abs(median); });
    add_sample("total", "total", "totals total", [&](double) { return t.total; });
    if (t.evaluations_factor)
      add_sample("evaluations", "evaluations", "evaluations",
                 [&](double median) { return (*t.evaluations_factor - 1) * median; });
  }

  void judge_samples() {
    std::vector<double> p_values;
    for (const Sample& s : samples_) p_values.push_back(s.test.p);
    const std::vector<double> adjusted = holm(p_values);
    std::size_t unsure = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& s = samples_[i];
      ++compared_;
      const bool both = std::isfinite(s.expected) && std::isfinite(s.found);
      const double moved = s.cell == "evaluations" ? s.found - s.expected : std::abs(s.found - s.expected);
      if (both ? moved <= s.tolerance : std::isfinite(s.expected) == std::isfinite(s.found)) continue;
      if (adjusted[i] > kSampleAlpha) {
        ++unsure;
        continue;
      }
      problem_ = s.problem;
      label_ = s.label;
      add("moved", fmt::format("{}, median (p = {:.2g})", s.cell, adjusted[i]),
          significant_cell(s.expected, 10), significant_cell(s.found, 10), true);
      if (both) report_.table.rows.back()[6] = finite_cell(s.found - s.expected, 3);
      report_.table.rows.back()[7] = significant_cell(s.tolerance, 3);
    }
    if (samples_.empty()) return;
    report_.table.notes.push_back(
        fmt::format("{} medians over several runs were judged by rank tests too (p <= {:g} after Holm's "
                    "correction); outside their tolerance without being significant: {}.",
                    samples_.size(), kSampleAlpha, unsure));
  }

  void totals(const Totals& expected, const Totals& found, double tolerance) {
    for (std::size_t v = 0; v < 3; ++v)
      number(fmt::format("totals {}", kPoseVariables[v]), expected.sums[v], found.sums[v], tolerance);
    number("totals total", expected.total, found.total, tolerance);
  }

  void trajectory(const TrajectoryErrors& expected, const std::vector<TrajectoryErrors>& all,
                  const Tolerances& t) {
    const TrajectoryErrors* found = find_trajectory(all, expected.trajectory);
    if (found == nullptr) return add("missing", expected.trajectory, Cell{}, Cell{}, true);
    for (std::size_t v = 0; v < 3; ++v) {
      const ErrorStatistics &e = expected.variables[v], &f = found->variables[v];
      const double tolerance = v == 2 ? t.error_rad : t.error_m;
      const std::string place = fmt::format("{} {}", expected.trajectory, kPoseVariables[v]);
      number(place + " e_max", e.max, f.max, tolerance);
      number(place + " e_sr", e.mean, f.mean, tolerance);
      number(place + " sigma", e.sigma, f.sigma, tolerance);
    }
  }

  BaselineReport report_;
  std::string problem_, label_;
  std::vector<Sample> samples_;
  std::size_t compared_ = 0;
};

bool names(const BaselineEntry& entry, const Comparison& group, const ComparisonRow& row) {
  return group.problem == entry.problem && group.dataset == entry.dataset &&
         same_problem_box(group.box, entry.box) && row.label == entry.label;
}

const ComparisonRow* find_row(const std::vector<Comparison>& groups, const BaselineEntry& entry) {
  for (const Comparison& group : groups)
    for (const ComparisonRow& row : group.rows)
      if (names(entry, group, row)) return &row;
  return nullptr;
}

bool covered(const Baseline& baseline, const Comparison& group, const ComparisonRow& row) {
  for (const BaselineEntry& entry : baseline.entries)
    if (names(entry, group, row)) return true;
  return false;
}

}  // namespace

BaselineReport check_baseline(const Baseline& baseline, const std::vector<RunRecord>& records) {
  const std::vector<Comparison> groups = compare(records);
  require_unique(groups);
  Check check;
  for (const BaselineEntry& entry : baseline.entries) {
    check.enter(entry.problem, entry.dataset, entry.label);
    if (const ComparisonRow* row = find_row(groups, entry))
      check.entry(entry, *row);
    else
      check.missing_label();
  }
  for (const Comparison& group : groups)
    for (const ComparisonRow& row : group.rows) {
      check.enter(group.problem, group.dataset, row.label);
      if (!covered(baseline, group, row)) check.additional_label();
    }
  return check.finish(baseline.source);
}

}  // namespace odobench
