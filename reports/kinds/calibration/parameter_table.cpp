#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/kinds/calibration/table_parts.hpp"

namespace odobench {
namespace {

// What the columns are: the parameters of all labels, in order of first appearance, with their box.
std::vector<const ParameterValue*> parameters_of(const Comparison& comparison) {
  std::vector<const ParameterValue*> known;
  for (const ComparisonRow& row : comparison.rows)
    for (const ParameterValue& p : row.shown->parameters)
      if (std::none_of(known.begin(), known.end(),
                       [&](const ParameterValue* k) { return k->name == p.name; }))
        known.push_back(&p);
  return known;
}

const ParameterValue* find(const RunRecord& record, const std::string& name) {
  for (const ParameterValue& p : record.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

Cell value_cell(double value, const std::string& unit) {
  return unit == "m" ? fixed_cell(1000 * value, 3) : significant_cell(value, 6);
}

Column column_of(const ParameterValue& parameter) {
  Column column;
  column.id = column.name = parameter.name;
  column.unit = parameter.unit == "m" ? "mm" : parameter.unit;
  column.mark_name = "bound";
  // a1..a4 stay together when the table is split.
  column.group = parameter.name.substr(0, parameter.name.find_last_not_of("0123456789") + 1);
  return column;
}

bool same_box(const ParameterValue& a, const ParameterValue& b) {
  return a.lower == b.lower && a.upper == b.upper && a.nominal == b.nominal;
}

// The nominal evaluation repeats the nominal row unless somebody gave it other values.
bool repeats_nominal(const ComparisonRow& row) {
  return row.label == "nominal" && row.kind == "evaluation" &&
         std::all_of(row.shown->parameters.begin(), row.shown->parameters.end(),
                     [](const ParameterValue& p) { return p.value == p.nominal; });
}

}  // namespace

std::optional<Table> parameter_table(const Comparison& comparison) {
  const std::vector<const ParameterValue*> parameters = parameters_of(comparison);
  if (comparison.trajectories.empty() || parameters.empty()) return std::nullopt;
  Table table;
  table.id = comparison.id_prefix + "parameters";
  table.title = fmt::format("Parameters{}", comparison.title_suffix);
  Column key;
  key.id = key.name = "parameters";
  key.align = Align::Left;
  table.columns.push_back(key);
  std::vector<Cell> lower{text_cell("lower bound")}, nominal{text_cell("nominal")},
      upper{text_cell("upper bound")};
  for (const ParameterValue* p : parameters) {
    table.columns.push_back(column_of(*p));
    lower.push_back(value_cell(p->lower, p->unit));
    nominal.push_back(value_cell(p->nominal, p->unit));
    upper.push_back(value_cell(p->upper, p->unit));
  }
  table.rows = {lower, nominal, upper};
  bool any_mark = false, boxes_differ = false;
  for (const ComparisonRow& row : comparison.rows) {
    for (const ParameterValue* p : parameters)
      if (const ParameterValue* own = find(*row.shown, p->name)) boxes_differ |= !same_box(*own, *p);
    if (row.shown->parameters.empty() || repeats_nominal(row)) continue;
    std::vector<Cell> cells{text_cell(row.label)};
    for (const ParameterValue* p : parameters) {
      const ParameterValue* own = find(*row.shown, p->name);
      cells.push_back(own == nullptr ? Cell{} : value_cell(own->value, p->unit));
      if (own == nullptr || own->at_bound.empty()) continue;
      cells.back().mark = own->at_bound == "upper" ? "U" : "L";
      any_mark = true;
    }
    table.rows.push_back(std::move(cells));
  }
  if (any_mark) table.notes.push_back("U, L: on its upper, lower bound.");
  if (boxes_differ)
    table.notes.push_back(
        "Nominal values or bounds differ between the records; the first rows show those seen first.");
  if (const std::string median = median_note(comparison); !median.empty()) table.notes.push_back(median);
  return table;
}

std::string active_bounds(const RunRecord& record) {
  std::string upper, lower;
  for (const ParameterValue& p : record.parameters) {
    if (p.at_bound == "upper") upper += " " + p.name;
    if (p.at_bound == "lower") lower += " " + p.name;
  }
  return fmt::format("{}{}{}{}{}", upper.empty() ? "" : "upper", upper,
                     upper.empty() || lower.empty() ? "" : "; ", lower.empty() ? "" : "lower", lower);
}

}  // namespace odobench
