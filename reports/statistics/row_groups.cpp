#include "reports/statistics/row_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

namespace odobench {
namespace {

double cost_or_infinity(const RunRecord& record) {
  return record.cost && !std::isnan(*record.cost) ? *record.cost : std::numeric_limits<double>::infinity();
}

bool is_evaluation(const RunRecord& record) {
  return record.kind == "evaluation";
}

// The lower median, so that it is always a run that took place.
const RunRecord* median_run(std::vector<const RunRecord*> runs) {
  std::stable_sort(runs.begin(), runs.end(), [](const RunRecord* a, const RunRecord* b) {
    return std::make_tuple(cost_or_infinity(*a), a->repetition) <
           std::make_tuple(cost_or_infinity(*b), b->repetition);
  });
  return runs[(runs.size() - 1) / 2];
}

int rank(const ComparisonRow& row) {
  if (!is_evaluation(*row.runs.front())) return 2;
  return row.label == "nominal" ? 0 : 1;
}

void finish_row(ComparisonRow& row) {
  std::vector<const RunRecord*> done;
  for (const RunRecord* run : row.runs)
    if (run->kind != "skipped") done.push_back(run);
  if (!done.empty()) row.runs = done;
  row.shown = median_run(row.runs);
  row.kind = row.shown->kind;
  row.errors = error_statistics(row.shown->errors);
}

void finish(Comparison& comparison) {
  for (ComparisonRow& row : comparison.rows) finish_row(row);
  std::stable_sort(comparison.rows.begin(), comparison.rows.end(),
                   [](const ComparisonRow& a, const ComparisonRow& b) { return rank(a) < rank(b); });
  if (rank(comparison.rows.front()) == 0) comparison.reference = 0;
  std::set<std::string> seen;
  for (const ComparisonRow& row : comparison.rows)
    for (const TrajectoryErrors& trajectory : row.errors)
      if (seen.insert(trajectory.trajectory).second) comparison.trajectories.push_back(trajectory.trajectory);
}

void add(Comparison& comparison, const RunRecord& record) {
  for (ComparisonRow& row : comparison.rows)
    if (row.label == record.label && is_evaluation(*row.runs.front()) == is_evaluation(record)) {
      row.runs.push_back(&record);
      return;
    }
  comparison.rows.emplace_back();
  comparison.rows.back().label = record.label;
  comparison.rows.back().runs.push_back(&record);
}

// " (cauchy=2.385,scale=0.0036:0.0133)" where a problem's name has a robust loss: its J is no sum of squares.
std::string loss_suffix(const std::string& problem) {
  for (const char* loss : {"huber=", "cauchy=", "tukey="}) {
    const std::size_t at = problem.find(loss);
    if (at == std::string::npos || at == 0 || (problem[at - 1] != ',' && problem[at - 1] != '[')) continue;
    std::size_t end = problem.find("scale=", at);
    if (end == std::string::npos) end = at;
    end = problem.find_first_of(",]", end);
    return fmt::format(" ({})", problem.substr(at, end - at));
  }
  return "";
}

// Tells several groups apart; the check sum only where the names do not: of the data, or of the box where
// those are the same.
void name_groups(std::vector<Comparison>& groups, const std::vector<std::string>& check_sums) {
  if (groups.size() == 1) groups.front().title_suffix = loss_suffix(groups.front().problem);
  if (groups.size() < 2) return;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Comparison& group = groups[i];
    const bool ambiguous = std::count_if(groups.begin(), groups.end(), [&](const Comparison& other) {
                             return other.problem == group.problem && other.dataset == group.dataset;
                           }) > 1;
    const bool other_data = std::any_of(check_sums.begin(), check_sums.end(),
                                        [&](const std::string& sum) { return sum != check_sums[i]; });
    const std::string sum = ambiguous ? "@" + (other_data ? check_sums[i] : group.box).substr(0, 8) : "";
    const std::string dataset = group.dataset + sum;
    group.id_prefix = dataset.empty() ? group.problem + "." : fmt::format("{}.{}.", group.problem, dataset);
    group.title_suffix = dataset.empty() ? fmt::format(" ({})", group.problem)
                                         : fmt::format(" ({}, {})", group.problem, dataset);
  }
}

}  // namespace

bool same_problem_box(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() || a == b;
}

std::optional<double> Comparison::best_cost() const {
  double best = std::numeric_limits<double>::infinity();
  for (const ComparisonRow& row : rows)
    for (const RunRecord* run : row.runs) best = std::min(best, cost_or_infinity(*run));
  return std::isfinite(best) ? std::optional<double>(best) : std::nullopt;
}

std::vector<Comparison> compare(const std::vector<RunRecord>& records) {
  std::vector<Comparison> groups;
  std::vector<std::string> check_sums;
  for (const RunRecord& record : records) {
    std::size_t at = 0;
    const auto other = [&](std::size_t i) {
      return std::tie(groups[i].problem, groups[i].dataset, check_sums[i]) !=
                 std::tie(record.problem, record.dataset, record.dataset_sha256) ||
             !same_problem_box(groups[i].box, record.box);
    };
    while (at < groups.size() && other(at)) ++at;
    if (at == groups.size()) {
      groups.emplace_back();
      groups.back().problem = record.problem;
      groups.back().dataset = record.dataset;
      check_sums.push_back(record.dataset_sha256);
    }
    if (groups[at].box.empty()) groups[at].box = record.box;
    add(groups[at], record);
  }
  for (Comparison& group : groups) finish(group);
  name_groups(groups, check_sums);
  return groups;
}

void require_unique(const std::vector<Comparison>& groups) {
  std::set<std::tuple<std::string, std::string, std::string>> seen;
  for (const Comparison& group : groups)
    for (const ComparisonRow& row : group.rows)
      if (!seen.emplace(group.problem, group.dataset, row.label).second)
        throw std::invalid_argument(fmt::format(
            "two different results are called '{}' on problem '{}', data set '{}': the records mix data "
            "sets of one name or an evaluation and a run of one label",
            row.label, group.problem, group.dataset));
}

std::optional<double> noise_over_runs(const ComparisonRow& row,
                                      const std::function<std::optional<double>(const RunRecord&)>& figure) {
  if (row.runs.size() > 1) {
    std::vector<double> values;
    for (const RunRecord* run : row.runs)
      if (const auto value = figure(*run); value && std::isfinite(*value)) values.push_back(*value);
    if (values.size() > 1) return spread(values).interquartile_range();
  }
  const RunRecord& one = *row.shown;
  const bool repeats =
      one.kind == "evaluation" || (!one.random.value_or(true) && one.start != "random" &&
                                   one.termination != "time_limit" && one.termination != "interrupted");
  return repeats ? std::nullopt : std::optional<double>(std::numeric_limits<double>::infinity());
}

std::optional<double> timing_noise(const ComparisonRow& row) {
  if (row.runs.size() < 2) return std::numeric_limits<double>::infinity();
  return noise_over_runs(row, [](const RunRecord& run) { return std::optional<double>(run.seconds); });
}

std::string median_note(const Comparison& comparison) {
  std::string list;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.runs.size() < 2 || row.kind != "run") continue;
    list += fmt::format("{}{} run {} (of {})", list.empty() ? "" : ", ", row.label, row.shown->repetition,
                        row.runs.size());
  }
  return list.empty() ? "" : fmt::format("Of several runs of one label the median by J is shown: {}.", list);
}

const TrajectoryErrors* find_trajectory(const std::vector<TrajectoryErrors>& errors,
                                        const std::string& name) {
  for (const TrajectoryErrors& entry : errors)
    if (entry.trajectory == name) return &entry;
  return nullptr;
}

}  // namespace odobench
