#include "reports/kinds/planning/planning_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "reports/kinds/planning/rival_tables.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

constexpr std::size_t kShownComponents = 4;

Cell percent(double relative) {
  return std::isfinite(relative) ? significant_cell(100 * relative, 3) : text_cell("not at all");
}

// What stands behind `prefix` in the notes that begin with it.
std::vector<std::string> noted(const RunRecord& record, const std::string& prefix) {
  std::vector<std::string> list;
  for (const std::string& note : record.notes)
    if (note.rfind(prefix, 0) == 0) list.push_back(note.substr(prefix.size()));
  return list;
}

double wanted_of(const RunRecord& record) {
  return record.measures.value("wanted").value_or(0);
}

// What a thousandth of the unit is called.
const char* thousandth(const std::string& unit) {
  return unit == "m" ? "mm" : unit == "rad" ? "mrad" : "1e-3";
}

// What relative deviations are relative to.
double absolute_scale(const ParameterValue& p) {
  return p.nominal != 0 ? std::abs(p.nominal) : (p.upper - p.lower) / 2;
}

Table parameters_table(const RunRecord& record) {
  Table t{"plan.parameters",
          "What these drives tell about each parameter",
          {text_column("parameter"), number_column("deviation", "deviation", "%"),
           number_column("absolute_deviation", "absolute deviation", "mm"), text_column("determined")},
          {},
          {}};
  const auto metres = [](const ParameterValue& p) { return p.unit == "m"; };
  const auto zero = [](const ParameterValue& p) { return p.nominal == 0; };
  const bool lengths = std::all_of(record.parameters.begin(), record.parameters.end(), metres);
  if (!lengths) {
    t.columns[2] = number_column("absolute_deviation", "absolute deviation");
    t.columns.insert(t.columns.begin() + 3, text_column("unit"));
  }
  const double wanted = wanted_of(record);
  const std::vector<double>* deviations = series_of(record, "standard_deviations", record.parameters.size());
  const std::size_t stated = deviations == nullptr ? 0 : deviations->size();
  int count = 0;
  for (std::size_t i = 0; i < stated; ++i) {
    const double sd = (*deviations)[i];
    const bool determined = sd <= wanted;
    count += determined;
    t.rows.push_back(
        {text_cell(record.parameters[i].name), percent(sd),
         std::isfinite(sd) ? significant_cell(1000 * sd * absolute_scale(record.parameters[i]), 3) : Cell{},
         text_cell(determined ? "yes" : "no")});
    if (!lengths)
      t.rows.back().insert(t.rows.back().begin() + 3, text_cell(thousandth(record.parameters[i].unit)));
  }
  t.notes.push_back(
      fmt::format("Standard deviation of a calibration by least squares, from simulated noise; determined: "
                  "at most {:g} %; {} of {}.",
                  100 * wanted, count, stated));
  if (std::any_of(record.parameters.begin(), record.parameters.end(), zero))
    t.notes.push_back("Deviations of parameters whose nominal value is 0 are in % of half their box.");
  for (const std::string& note : record.notes)
    if (note.rfind(kUndeterminedNote, 0) != 0 && note.rfind(kProposedNote, 0) != 0)
      t.notes.push_back(note + ".");
  return t;
}

Table directions_table(const RunRecord& record) {
  Table t{"plan.directions",
          "Combinations from best to worst determined",
          {text_column("rank"), number_column("singular_value"), number_column("deviation", "deviation", "%"),
           text_column("direction")},
          {},
          {"Singular values of the noise-weighted Jacobian in relative parameters; direction: its largest "
           "parts."}};
  const std::size_t n = record.parameters.size();
  const std::vector<double>* values = series_of(record, "singular_values", n);
  const std::vector<double>* directions = series_of(record, "directions", n * n);
  const std::vector<double>* deviations = series_of(record, "direction_deviations", n);
  if (values == nullptr || directions == nullptr || deviations == nullptr) return t;
  for (std::size_t k = 0; k < n; ++k) {
    const double* const vector = directions->data() + k * n;
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return std::abs(vector[x]) > std::abs(vector[y]); });
    std::string text;
    for (std::size_t i = 0; i < std::min(kShownComponents, n); ++i)
      text +=
          fmt::format("{}{:+.2f} {}", i > 0 ? " " : "", vector[order[i]], record.parameters[order[i]].name);
    // Without any scatter along it the value is infinite, which a record has no number for.
    const double deviation = (*deviations)[k], stored = (*values)[k];
    const double value = std::isnan(stored) ? 1 / deviation : stored;
    t.rows.push_back({text_cell(fmt::format("{}", k + 1)), significant_cell(value, 4), percent(deviation),
                      text_cell(text)});
  }
  return t;
}

Table undetermined_table(const RunRecord& record) {
  Table t{"plan.undetermined",
          "What stays undetermined",
          {text_column("number"), text_column("combination")},
          {},
          {fmt::format(
              "Changing these parameters together, those after 'against' the other way, changes nothing that "
              "{:g} % precision would show.",
              100 * wanted_of(record))}};
  for (const std::string& words : noted(record, kUndeterminedNote))
    t.rows.push_back({text_cell(fmt::format("{}", t.rows.size() + 1)), text_cell(words)});
  return t;
}

Table proposals_table(const RunRecord& record) {
  Table t{"plan.proposals",
          "Drives to add, best first",
          {text_column("number"), text_column("drive"),
           number_column("largest_deviation", "largest deviation", "%")},
          {},
          {}};
  const double wanted = wanted_of(record);
  const std::vector<std::string> drives = noted(record, kProposedNote);
  const std::vector<double>* deviations = series_of(record, "proposed", drives.size());
  if (deviations != nullptr)
    for (std::size_t k = 0; k < drives.size(); ++k)
      t.rows.push_back(
          {text_cell(fmt::format("{}", k + 1)), text_cell(drives[k]), percent((*deviations)[k])});
  const bool met = deviations != nullptr && !deviations->empty() && deviations->back() <= wanted;
  if (!noted(record, kNoCandidateNote).empty())
    t.notes.push_back("Nothing is proposed, since no candidate tells everything.");
  else if (t.rows.empty())
    t.notes.push_back(fmt::format("Nothing to add: {:g} % is met.", 100 * wanted));
  else
    t.notes.push_back(met ? fmt::format("With these every parameter is known to {:g} %.", 100 * wanted)
                          : fmt::format("{} drives do not reach {:g} %; the candidates lack something.",
                                        t.rows.size(), 100 * wanted));
  return t;
}

}  // namespace

std::vector<Table> planning_tables(const RunRecord& record, bool proposals) {
  if (has_rivals(record)) return rival_tables(record);
  std::vector<Table> tables{parameters_table(record), directions_table(record)};
  if (Table undetermined = undetermined_table(record); !undetermined.rows.empty())
    tables.push_back(std::move(undetermined));
  if (Table list = proposals_table(record);
      proposals || !list.rows.empty() || !noted(record, kNoCandidateNote).empty())
    tables.push_back(std::move(list));
  return tables;
}

}  // namespace odobench
