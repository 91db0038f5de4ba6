#include "reports/kinds/trust/validation_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "reports/kinds/trust/bootstrap_table.hpp"
#include "reports/kinds/trust/validation_record.hpp"
#include "reports/kinds/trust/validation_sentences.hpp"

namespace odobench {
namespace {

struct ValidatedRow {
  const ComparisonRow* row = nullptr;
  const RunRecord* record = nullptr;  // that was validated: the one shown, else the lowest
  std::vector<SchemeFigures> schemes;
};

// What the scheme asks, for headings.
std::string question(const std::string& scheme) {
  if (scheme == kRepetitions) return "same drives again";
  if (scheme == kTrajectories) return "kind never seen";
  return "folds";
}

ValidatedRow validated(const ComparisonRow& row) {
  ValidatedRow out{&row, row.shown, validations_of(*row.shown)};
  for (const RunRecord* run : row.runs) {
    if (!out.schemes.empty()) break;
    out.record = run;
    out.schemes = validations_of(*run);
  }
  return out;
}

std::vector<ValidatedRow> validated_rows(const Comparison& comparison) {
  std::vector<ValidatedRow> rows;
  for (const ComparisonRow& row : comparison.rows)
    if (row.kind == "run") rows.push_back(validated(row));
  return rows;
}

const ValidatedRow* lowest(const std::vector<ValidatedRow>& rows) {
  const ValidatedRow* best = nullptr;
  for (const ValidatedRow& row : rows)
    if (!row.schemes.empty() && row.record->cost &&
        (best == nullptr || *row.record->cost < *best->record->cost))
      best = &row;
  return best;
}

const SchemeFigures* find(const ValidatedRow& row, const char* scheme) {
  for (const SchemeFigures& figures : row.schemes)
    if (figures.scheme == scheme) return &figures;
  return nullptr;
}

bool any(const std::vector<ValidatedRow>& rows, const char* scheme) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const ValidatedRow& row) { return find(row, scheme) != nullptr; });
}

Cell percent_cell(double a, double b) {
  const double change = change_percent(a, b);
  if (!std::isfinite(change)) return {};
  return fixed_cell(change, 1);
}

// Nothing in place of what overflowed: records with finite figures give finite tables.
Cell finite_only(Cell cell) {
  return cell.value && std::isinf(*cell.value) ? Cell{} : cell;
}
Cell total_cell(double value) {
  return finite_only(fixed_cell(value, 6));
}

void add_scheme_cells(const SchemeFigures* figures, std::vector<Cell>& cells) {
  if (figures == nullptr) {
    cells.insert(cells.end(), 4, Cell{});
    return;
  }
  const HeldOut& all = figures->all;
  cells.push_back(total_cell(all.total_held_out));
  cells.push_back(total_cell(all.total_nominal));
  cells.push_back(percent_cell(all.total_held_out, all.total_nominal));
  cells.push_back(percent_cell(all.total_held_out, all.total_full));
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void add_notes(const std::vector<ValidatedRow>& rows, Table& table) {
  const ValidatedRow& best = *lowest(rows);
  for (const std::string& sentence : validation_sentences(*best.record))
    table.notes.push_back(fmt::format("{}: {}", best.row->label, sentence));
  if (const SchemeFigures* repetitions = find(best, kRepetitions);
      repetitions != nullptr && repetitions->cost_predicted)
    table.notes.push_back(fmt::format(
        "J on repetitions left out {:.6g} ({:+.1f} % against fitted); {:.6g} as predicted from the scatter "
        "between recordings, a hint.",
        repetitions->all.cost_held_out,
        change_percent(repetitions->all.cost_held_out, repetitions->all.cost_full),
        *repetitions->cost_predicted));
  std::vector<std::string> others;
  for (const ValidatedRow& row : rows)
    if (row.schemes.empty()) others.push_back(row.row->label);
  if (!others.empty())
    table.notes.push_back(
        fmt::format("Not validated, since J is not that of the fits: {}; --validate=all "
                    "makes fits by each row's own solver.",
                    joined(others)));
  table.notes.push_back(
      "Total errors as in the table of totals, every recording judged by a fit that has not seen it. Same "
      "drives again: one repetition of every kind is left out at a time; kind never seen: one kind of "
      "drive. Rows with one J share the folds of one solver.");
}

Table validation_table(const Comparison& comparison, const std::vector<ValidatedRow>& rows) {
  Table table;
  table.id = comparison.id_prefix + "validation";
  table.title = fmt::format("Validation: recordings that the fit has not seen{}", comparison.title_suffix);
  table.columns = {text_column("parameters"), number_column("total_fitted", "fitted")};
  std::vector<const char*> schemes;
  for (const char* scheme : {kRepetitions, kTrajectories, kKFold}) {
    if (!any(rows, scheme)) continue;
    schemes.push_back(scheme);
    const std::string id = scheme, group = question(scheme);
    table.columns.push_back(number_column(id + "_held_out", group, "", group));
    table.columns.push_back(number_column(id + "_nominal", "nominal", "", group));
    table.columns.push_back(number_column(id + "_to_nominal_percent", "to nominal", "%", group));
    table.columns.push_back(number_column(id + "_to_fitted_percent", "to fitted", "%", group));
  }
  for (const ValidatedRow& row : rows) {
    if (row.record->errors.empty()) continue;
    std::vector<Cell> cells{text_cell(row.row->label),
                            total_cell(error_totals(error_statistics(row.record->errors)).total)};
    for (const char* scheme : schemes) add_scheme_cells(find(row, scheme), cells);
    table.rows.push_back(std::move(cells));
  }
  add_notes(rows, table);
  return table;
}

std::vector<Cell> fold_row(const std::string& label, const SchemeFigures& scheme, const FoldFigures& fold) {
  const HeldOut& h = fold.held_out;
  return {
      text_cell(scheme.scheme == kKFold ? "fold " + fold.name
                                        : (scheme.scheme == kRepetitions ? "repetition " : "") + fold.name),
      text_cell(label),
      count_cell(static_cast<double>(fold.recordings)),
      finite_only(significant_cell(fold.cost_fitted, 10)),
      finite_only(significant_cell(h.cost_held_out, 8)),
      finite_only(significant_cell(h.cost_nominal, 8)),
      total_cell(fold.total_fitted),
      total_cell(h.total_held_out),
      total_cell(h.total_nominal),
      percent_cell(h.total_held_out, h.total_nominal)};
}

bool same_folds(const ValidatedRow& a, const ValidatedRow& b) {
  return a.schemes.size() == b.schemes.size() &&
         std::equal(a.schemes.begin(), a.schemes.end(), b.schemes.begin(),
                    [](const SchemeFigures& x, const SchemeFigures& y) {
                      return x.scheme == y.scheme && x.all.cost_held_out == y.all.cost_held_out &&
                             x.all.total_held_out == y.all.total_held_out;
                    });
}

Table fold_table(const Comparison& comparison, const std::vector<ValidatedRow>& rows) {
  Table table;
  table.id = comparison.id_prefix + "folds";
  table.title = fmt::format("Folds of the validation{}", comparison.title_suffix);
  table.columns = {text_column("left_out"),
                   text_column("parameters"),
                   number_column("recordings"),
                   number_column("cost_fitted", "J fitted", "", "J"),
                   number_column("cost_held_out", "J left out", "", "J"),
                   number_column("cost_nominal", "J nominal", "", "J"),
                   number_column("total_fitted", "total fitted", "", "total error"),
                   number_column("total_held_out", "total left out", "", "total error"),
                   number_column("total_nominal", "total nominal", "", "total error"),
                   number_column("total_to_nominal_percent", "to nominal", "%", "total error")};
  std::vector<const ValidatedRow*> shown;
  for (const ValidatedRow& row : rows) {
    if (row.schemes.empty()) continue;
    const auto same =
        std::find_if(shown.begin(), shown.end(), [&](const ValidatedRow* s) { return same_folds(*s, row); });
    if (same != shown.end()) {
      table.notes.push_back(fmt::format("{}: the same folds as {}.", row.row->label, (*same)->row->label));
      continue;
    }
    shown.push_back(&row);
    for (const SchemeFigures& scheme : row.schemes)
      for (const FoldFigures& fold : scheme.folds)
        table.rows.push_back(fold_row(row.row->label, scheme, fold));
  }
  table.notes.push_back("Left out, nominal: of the recordings that the fold leaves out.");
  return table;
}

}  // namespace

std::vector<Table> validation_tables(const Comparison& comparison) {
  std::vector<Table> tables;
  const std::vector<ValidatedRow> rows = validated_rows(comparison);
  if (lowest(rows) != nullptr) {
    tables.push_back(validation_table(comparison, rows));
    tables.push_back(fold_table(comparison, rows));
  }
  if (std::optional<Table> table = bootstrap_table(comparison)) tables.push_back(std::move(*table));
  return tables;
}

}  // namespace odobench
