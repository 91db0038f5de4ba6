#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reports/regression/changes.hpp"

namespace odobench {
namespace {

constexpr int kValueDigits = 8;
constexpr int kChangeDigits = 3;

bool several_groups(const RunComparison& comparison) {
  return std::any_of(comparison.changes.begin(), comparison.changes.end(), [&](const Change& c) {
    return c.problem != comparison.changes.front().problem || c.dataset != comparison.changes.front().dataset;
  });
}

std::string result_name(const Change& c, bool with_group) {
  const std::string name = c.label + " " + c.before.name;
  if (!with_group) return name;
  return fmt::format("{} ({}{}{})", name, c.problem, c.dataset.empty() ? "" : ", ", c.dataset);
}

Cell number(double value, int digits) {
  return std::isfinite(value) ? significant_cell(value, digits) : Cell{};
}

bool listed_as_changed(const Change& c) {
  return c.fails || c.finding == Finding::Better || c.finding == Finding::Worse ||
         c.finding == Finding::Changed;
}

std::string basis(const Change& c) {
  return c.noiseless ? "no noise" : !c.test ? "" : c.test->exact ? "exact" : "normal";
}

Cell limit_cell(const Change& c) {
  if (!c.gate) return {};
  Cell cell = text_cell(c.gate->text().substr(c.gate->metric.size() + 1));
  cell.mark = c.fails ? "FAILED" : c.beyond ? "?" : "";
  return cell;
}

std::vector<Column> name_columns(bool machine) {
  if (!machine) return {text_column("result")};
  return {text_column("problem"), text_column("dataset", "data set"), text_column("label"),
          text_column("metric"), text_column("unit")};
}

std::vector<Cell> name_cells(const Change& c, bool machine, bool with_group) {
  if (!machine) return {text_cell(result_name(c, with_group))};
  return {text_cell(c.problem), text_cell(c.dataset), text_cell(c.label), text_cell(c.before.name),
          text_cell(c.before.unit)};
}

void append_change_columns(std::vector<Column>& columns) {
  columns.push_back(number_column("old", "old", "", "median"));
  columns.push_back(number_column("new", "new", "", "median"));
  columns.push_back(number_column("change", "change", "", "median"));
  columns.push_back(number_column("change_percent", "change", "%", "median"));
}

void append_change(std::vector<Cell>& cells, const Change& c) {
  cells.push_back(number(c.old_median, kValueDigits));
  cells.push_back(number(c.new_median, kValueDigits));
  cells.push_back(number(c.change, kChangeDigits));
  cells.push_back(number(100 * c.relative, kChangeDigits));
}

Table changed_table(const RunComparison& comparison, bool machine, bool with_group) {
  Table table{"changed", "What changed", name_columns(machine), {}, {}};
  append_change_columns(table.columns);
  table.columns.push_back(number_column("p_holm", "p (Holm)", "", "test"));
  table.columns.push_back(text_column("effect"));
  table.columns.push_back(text_column("finding"));
  table.columns.push_back(text_column("limit"));
  table.columns.back().mark_name = "outcome";
  for (const Change& c : comparison.changes) {
    if (!listed_as_changed(c)) continue;
    std::vector<Cell> cells = name_cells(c, machine, with_group);
    append_change(cells, c);
    cells.push_back(c.test ? significant_cell(c.p_adjusted, 2) : Cell{});
    cells.push_back(text_cell(c.noiseless ? "no noise" : effect_size_name(c.a12)));
    cells.push_back(text_cell(to_string(c.finding)));
    cells.push_back(limit_cell(c));
    table.rows.push_back(std::move(cells));
  }
  // What fails first, then what is worse, each as before.
  const auto urgency = [&](const std::vector<Cell>& row) {
    const std::string& finding = row[row.size() - 2].text;
    return row.back().mark == "FAILED" ? 0 : finding == "worse" ? 1 : finding == "changed" ? 2 : 3;
  };
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [&](const auto& a, const auto& b) { return urgency(a) < urgency(b); });
  return table;
}

Table all_table(const RunComparison& comparison, bool machine, bool with_group) {
  Table table{"changes", "All results, old and new", name_columns(machine), {}, {}};
  table.columns.push_back(number_column("runs_old", "old runs", "", "runs"));
  table.columns.push_back(number_column("runs_new", "new runs", "", "runs"));
  append_change_columns(table.columns);
  table.columns.push_back(number_column("shift", "shift", "", "test"));
  table.columns.push_back(number_column("a12", "A12", "", "test"));
  table.columns.push_back(number_column("p", "p", "", "test"));
  table.columns.push_back(number_column("p_holm", "p (Holm)", "", "test"));
  table.columns.push_back(text_column("effect"));
  table.columns.push_back(text_column("basis", "test"));
  table.columns.push_back(text_column("finding"));
  table.columns.push_back(text_column("limit"));
  table.columns.back().mark_name = "outcome";
  for (const Change& c : comparison.changes) {
    std::vector<Cell> cells = name_cells(c, machine, with_group);
    cells.push_back(count_cell(static_cast<double>(c.before.values.size())));
    cells.push_back(count_cell(static_cast<double>(c.after.values.size())));
    append_change(cells, c);
    cells.push_back(c.test && c.shift ? number(*c.shift, kChangeDigits) : Cell{});
    cells.push_back(c.test ? fixed_cell(c.a12, 3) : Cell{});
    cells.push_back(c.test ? significant_cell(c.test->p, 2) : Cell{});
    cells.push_back(c.test ? significant_cell(c.p_adjusted, 2) : Cell{});
    cells.push_back(text_cell(c.test ? effect_size_name(c.a12) : ""));
    cells.push_back(text_cell(basis(c)));
    cells.push_back(text_cell(to_string(c.finding)));
    cells.push_back(limit_cell(c));
    table.rows.push_back(std::move(cells));
  }
  table.notes = {
      "Old, new: medians over the runs; shift: median of all differences new - old (Hodges-Lehmann); A12: "
      "probability that a new run is better than an old one, 0.5 for no difference, with its usual name as "
      "effect.",
      "Test: exact or normal (approximation) distribution of Mann-Whitney's U, two-sided; no noise: one run "
      "each "
      "that repeats to the last bit, nothing to test. A failed run counts as worst."};
  return table;
}

Table one_sided_table(const RunComparison& comparison) {
  Table table{"one_sided",
              "On one side only",
              {text_column("label"), text_column("problem"), text_column("dataset", "data set"),
               text_column("metric"), text_column("side", "only in"), text_column("remark", "other side")},
              {},
              {}};
  for (const OneSided& o : comparison.one_sided)
    table.rows.push_back({text_cell(o.label), text_cell(o.problem), text_cell(o.dataset),
                          text_cell(o.metric.empty() ? "all" : o.metric), text_cell(o.in_old ? "old" : "new"),
                          text_cell(o.remark)});
  return table;
}

Table verdict_table(const RunComparison& comparison) {
  Table table{"verdict",
              verdict(comparison),
              {text_column("verdict"), number_column("compared"), number_column("better"),
               number_column("worse"), number_column("changed"), number_column("gated"),
               number_column("failed"), number_column("one_sided", "on one side")},
              {},
              {}};
  const auto count = [&](Finding f) { return count_cell(static_cast<double>(comparison.count(f))); };
  const std::size_t failures = comparison.failures();
  table.rows.push_back({text_cell(failures > 0 || !nothing_to_compare(comparison).empty() ? "failed"
                                  : comparison.gated > 0                                  ? "passed"
                                                                                          : "no limits"),
                        count_cell(static_cast<double>(comparison.changes.size())), count(Finding::Better),
                        count(Finding::Worse), count(Finding::Changed),
                        count_cell(static_cast<double>(comparison.gated)),
                        count_cell(static_cast<double>(failures)),
                        count_cell(static_cast<double>(comparison.one_sided.size()))});
  for (const std::string& line : comparison.unlike) table.notes.push_back("Not alike: " + line + ".");
  table.notes.insert(table.notes.end(), comparison.remarks.begin(), comparison.remarks.end());
  if (comparison.gated_tests + comparison.tests > 0)
    table.notes.push_back(
        fmt::format("Significant: p <= {:g} after Holm's correction over {}{} tests.", comparison.alpha,
                    comparison.gated_tests > 0
                        ? fmt::format("{} gated tests, and over the other ", comparison.gated_tests)
                        : "",
                    comparison.tests));
  return table;
}

std::string percent(const Change& c) {
  if (std::isinf(c.relative) || std::isnan(c.relative)) return fmt::format("{:+.3g}", c.change);
  return fmt::format("{:+.3g} %", 100 * c.relative);
}

}  // namespace

std::string verdict(const RunComparison& comparison) {
  const std::string rest =
      fmt::format("{} better, {} worse, {} otherwise changed of {} compared",
                  comparison.count(Finding::Better), comparison.count(Finding::Worse),
                  comparison.count(Finding::Changed), comparison.changes.size()) +
      (comparison.one_sided.empty() ? "" : fmt::format(", {} on one side only", comparison.one_sided.size()));
  const std::size_t failures = comparison.failures();
  const std::string nothing = nothing_to_compare(comparison);
  if (failures == 0 && !nothing.empty()) return fmt::format("Failed: {}; {}.", nothing, rest);
  if (comparison.gated == 0) return fmt::format("No limits in force: {}.", rest);
  if (failures == 0)
    return fmt::format("Passed: none of {} gated results is worse beyond its limit; {}.", comparison.gated,
                       rest);
  constexpr std::size_t kNamed = 3;
  std::string list;
  std::size_t named = 0;
  for (const Change& c : comparison.changes)
    if (c.fails && named++ < kNamed)
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", result_name(c, several_groups(comparison)),
                          percent(c));
  if (named > kNamed) list += ", ...";
  return fmt::format("Failed: {} of {} gated results {} worse beyond {} limit: {}.", failures,
                     comparison.gated, failures == 1 ? "is" : "are", failures == 1 ? "its" : "their", list);
}

std::vector<Table> change_tables(const RunComparison& comparison, bool machine) {
  const bool with_group = several_groups(comparison);
  std::vector<Table> tables{verdict_table(comparison)};
  Table changed = changed_table(comparison, machine, with_group);
  if (!changed.rows.empty()) tables.push_back(std::move(changed));
  if (!comparison.changes.empty()) tables.push_back(all_table(comparison, machine, with_group));
  if (!comparison.one_sided.empty()) tables.push_back(one_sided_table(comparison));
  return tables;
}

std::string change_summary_markdown(const RunComparison& comparison) {
  std::vector<Table> tables = change_tables(comparison, false);
  const std::vector<std::string> notes = tables.front().notes;
  std::string out = fmt::format("**{}**\n", verdict(comparison));
  std::vector<Table> folded;
  for (Table& table : tables) {
    if (table.id == "changed") out += "\n" + render({table}, Format::Markdown);
    if (table.id == "changes" || table.id == "one_sided") folded.push_back(std::move(table));
  }
  if (!notes.empty()) out += "\n";
  for (const std::string& note : notes) out += markdown_note(note);
  if (!folded.empty())
    out += fmt::format("\n<details>\n<summary>All {} results</summary>\n\n{}\n</details>\n",
                       comparison.changes.size(), render(folded, Format::Markdown));
  return out;
}

}  // namespace odobench
