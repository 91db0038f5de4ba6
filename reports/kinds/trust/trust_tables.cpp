#include "reports/kinds/trust/trust_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "reports/kinds/trust/profile_record.hpp"

namespace odobench {
namespace {

constexpr int kPlainDigits = 4;  // of a number without an interval

struct TrustRow {
  std::string label;
  const TrustRecord* trust;
};

// The best run by J of each label that says something.
std::vector<TrustRow> rows_of(const Comparison& comparison) {
  std::vector<TrustRow> rows;
  for (const ComparisonRow& row : comparison.rows) {
    const RunRecord* best = nullptr;
    for (const RunRecord* run : row.runs)
      if (run->trust && run->cost && (best == nullptr || *run->cost < *best->cost)) best = run;
    if (best != nullptr) rows.push_back({row.label, &*best->trust});
  }
  return rows;
}

Cell value_cell(double value, int digits) {
  return std::isfinite(value) ? fixed_cell(value, digits) : Cell{};
}

Cell df_cell(double df) {
  return std::isfinite(df) ? fixed_cell(df, 1) : Cell{};
}

// A half width; where there is none, nothing: the reason has a column of its own.
void add_interval(const IntervalRecord& interval, double factor, int digits, std::vector<Cell>& row) {
  row.push_back(value_cell(factor * interval.half_width, digits));
  row.push_back(value_cell(factor * interval.same_half_width, digits));
  row.push_back(interval.refused == "none" ? df_cell(interval.df) : Cell{});
  row.push_back(text_cell(interval.reason));
}

std::vector<Column> interval_columns() {
  return {number_column("half_width", "+- (new kinds)"), number_column("same_half_width", "+- (same drives)"),
          number_column("df", "degrees of freedom"), text_column("reason", "why no interval")};
}

// Columns of what is empty in all rows are left out for people and machines alike.
void drop_empty(Table& table, const std::string& id) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].id == id) {
      if (empty_column(table, c)) erase_column(table, c);
      return;
    }
}

Table table_of(const char* id, const char* title, const Comparison& comparison, std::vector<Column> columns) {
  Table table;
  table.id = comparison.id_prefix + id;
  table.title = title + comparison.title_suffix;
  table.columns = {text_column("label", "result")};
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  const std::vector<Column> rest = interval_columns();
  table.columns.insert(table.columns.end(), rest.begin(), rest.end());
  return table;
}

void finish_into(Table table, std::vector<Table>& tables) {
  if (table.rows.empty()) return;
  for (const char* id : {"same_half_width", "reason"}) drop_empty(table, id);
  tables.push_back(std::move(table));
}

// Sentences of all rows, each once.
void add_sentences(const std::vector<TrustRow>& rows, Table& table) {
  const auto add = [&](const std::string& text) {
    if (std::find(table.notes.begin(), table.notes.end(), text) == table.notes.end())
      table.notes.push_back(text);
  };
  for (const TrustRow& row : rows)
    for (const std::string& remark : row.trust->remarks) add(remark);
  std::string last;
  for (const TrustRow& row : rows) {
    for (const std::string& sentence : row.trust->sentences) {
      if (&sentence == &row.trust->sentences.back())
        last = last.empty() ? sentence : last;
      else
        add(rows.size() > 1 ? row.label + ": " + sentence : sentence);
    }
  }
  if (!last.empty()) add(last);
}

Table determined_table(const Comparison& comparison, const std::vector<TrustRow>& rows) {
  Table table = table_of("determined", "What the drives determine, +- 95 %", comparison,
                         {text_column("name"), text_column("words", "what it is"), text_column("unit"),
                          number_column("nominal"), number_column("estimate")});
  for (const TrustRow& row : rows)
    for (const DeterminedRecord& d : row.trust->determined) {
      const ReadUnit unit = read_unit(d.unit);
      const int digits = digits_of_half_width(unit.factor * d.interval.half_width, kPlainDigits);
      std::vector<Cell> cells = {
          text_cell(row.label),
          text_cell(d.name),
          text_cell(d.words),
          text_cell(unit.name),
          value_cell(unit.factor * d.nominal, std::abs(d.nominal) < 1e-12 ? 0 : digits),
          value_cell(unit.factor * d.value, digits)};
      add_interval(d.interval, unit.factor, digits, cells);
      table.rows.push_back(std::move(cells));
    }
  add_sentences(rows, table);
  return table;
}

Table parameter_intervals(const Comparison& comparison, const std::vector<TrustRow>& rows) {
  Table table = table_of("intervals", "Single parameters, +- 95 %", comparison,
                         {text_column("parameter"), text_column("unit"), number_column("value")});
  for (const TrustRow& row : rows)
    for (const ParameterIntervalRecord& p : row.trust->parameters) {
      const ReadUnit unit = read_unit(p.unit);
      const int digits = std::max(3, digits_of_half_width(unit.factor * p.interval.half_width, kPlainDigits));
      std::vector<Cell> cells = {text_cell(row.label), text_cell(p.name), text_cell(unit.name),
                                 value_cell(unit.factor * p.value, digits)};
      add_interval(p.interval, unit.factor, digits, cells);
      table.rows.push_back(std::move(cells));
    }
  return table;
}

Table combinations_table(const Comparison& comparison, const std::vector<TrustRow>& rows) {
  Table table = table_of("combinations", "Numbers asked for, +- 95 %", comparison,
                         {text_column("name"), text_column("formula"), text_column("unit"),
                          number_column("nominal"), number_column("estimate")});
  table.key = true;
  bool of_the_map = false, others = false;
  for (const TrustRow& row : rows)
    for (const CombinationRecord& c : row.trust->combinations) {
      const ReadUnit unit = read_unit(c.unit);
      const int digits = digits_of_half_width(unit.factor * c.interval.half_width, kPlainDigits);
      std::vector<Cell> cells = {text_cell(row.label),
                                 text_cell(c.name),
                                 text_cell(c.formula),
                                 text_cell(unit.name),
                                 value_cell(unit.factor * c.nominal, digits),
                                 value_cell(unit.factor * c.value, digits)};
      add_interval(c.interval, unit.factor, digits, cells);
      table.rows.push_back(std::move(cells));
      (c.of_the_map ? of_the_map : others) = true;
    }
  if (of_the_map)
    table.notes.emplace_back("What is made of the numbers that the drives determine has their intervals.");
  if (others)
    table.notes.emplace_back(
        "What is not made of the numbers that the drives determine alone has the intervals of single "
        "parameters: "
        "none while any lies on a bound.");
  return table;
}

Table drive_errors_table(const Comparison& comparison, const std::vector<TrustRow>& rows) {
  Table table = table_of("new_drives", "How far off a new drive can be, +- 95 %", comparison,
                         {text_column("drive"), text_column("what", "error"), text_column("unit"),
                          number_column("scatter", "rms so far")});
  for (const TrustRow& row : rows)
    for (const DriveErrorRecord& d : row.trust->drives) {
      const ReadUnit unit = read_unit(d.unit);
      const int digits = digits_of_half_width(unit.factor * d.interval.half_width, kPlainDigits);
      std::vector<Cell> cells = {text_cell(row.label), text_cell(d.drive), text_cell(d.what),
                                 text_cell(unit.name),
                                 d.scatter > 0 ? value_cell(unit.factor * d.scatter, digits) : Cell{}};
      add_interval(d.interval, unit.factor, digits, cells);
      table.rows.push_back(std::move(cells));
    }
  if (!table.rows.empty())
    table.notes.emplace_back(
        "10 m and turns: what the numbers above leave, without the scatter of single drives; kinds of the "
        "set: "
        "their end pose, with it.");
  return table;
}

}  // namespace

int digits_of_half_width(double half_width, int otherwise) {
  if (!(half_width > 0) || !std::isfinite(half_width)) return otherwise;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(half_width))), 0, 9);
}

ReadUnit read_unit(const std::string& unit) {
  if (unit == "rad/m") return {"deg/m", 1 / kDegree};
  if (unit == "m/rad") return {"mm/turn", 2000 * kPi};
  if (unit == "m/m") return {"mm/m", 1000};
  if (unit == "rad") return {"deg", 1 / kDegree};
  if (unit == "m") return {"mm", 1000};
  return {unit, 1};
}

std::vector<Table> trust_tables(const Comparison& comparison) {
  std::vector<Table> tables;
  const std::vector<TrustRow> rows = rows_of(comparison);
  finish_into(determined_table(comparison, rows), tables);
  finish_into(parameter_intervals(comparison, rows), tables);
  finish_into(combinations_table(comparison, rows), tables);
  if (std::optional<Table> profile = profile_table(comparison)) finish_into(std::move(*profile), tables);
  finish_into(drive_errors_table(comparison, rows), tables);
  return tables;
}

}  // namespace odobench
