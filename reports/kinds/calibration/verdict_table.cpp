#include "reports/kinds/calibration/verdict_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/range.hpp"
#include "reports/kinds/calibration/overview_tables.hpp"
#include "reports/kinds/trust/next_steps_tables.hpp"
#include "reports/kinds/trust/trust_tables.hpp"
#include "reports/kinds/trust/validation_record.hpp"
#include "reports/kinds/trust/validation_sentences.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

struct Clause {
  std::string about, sentence;
  double value = kNotANumber, half_width = kNotANumber, against = kNotANumber;
  std::string unit;
};

std::string count_words(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::size_t free_count(const RunRecord& record) {
  return static_cast<std::size_t>(std::count_if(record.parameters.begin(), record.parameters.end(),
                                                [](const ParameterValue& p) { return p.lower < p.upper; }));
}

double total_of(const RunRecord& record) {
  return error_totals(error_statistics(record.errors)).total;
}

// Whether the result is to be used, by what is known of it: worse on the same drives again is worse at all.
Clause use_clause(const BestRun& best, double nominal, double total) {
  const RunRecord& record = *best.record;
  const double change = change_percent(total, nominal);
  Clause clause{"use", "", change, kNotANumber, kNotANumber, "%"};
  std::string held;
  bool usable = total <= nominal;
  if (const auto again = validation_of(record, kRepetitions)) {
    clause.against = change_percent(again->all.total_held_out, again->all.total_nominal);
    held = fmt::format(" (on repetitions left out {:+.1f} %)", clause.against);
    usable = usable && against_nominal(again->all) != AgainstNominal::Worse;
  }
  const std::size_t parameters = free_count(record);
  if (usable)
    clause.sentence =
        fmt::format("{} of {}: total error {:+.1f} % against nominal{}.",
                    parameters == 1 ? "Use the parameter" : fmt::format("Use these {} as a set", parameters),
                    best.row->label, change, held);
  else
    clause.sentence = fmt::format("Do not use the parameters of {}: total error {:+.1f} % against nominal{}.",
                                  best.row->label, change, held);
  return clause;
}

void add_unseen_kinds(const RunRecord& record, std::vector<Clause>& clauses) {
  const auto unseen = validation_of(record, kTrajectories);
  if (!unseen) return;
  std::string text = worse_on_new_kinds(*unseen);
  if (text.empty())
    text = better_on_every_kind(*unseen);
  else if (const std::string needed = kinds_that_are_needed(*unseen); !needed.empty())
    text += " " + needed;
  if (text.empty()) return;
  clauses.push_back(
      {"unseen_kinds", text, unseen->all.total_held_out, kNotANumber, unseen->all.total_nominal, "m + rad"});
}

// "turn +1.06 +- 0.36 %" of factors, "turn per metre along x +1.10 +- 0.19 deg/m" of others.
std::string number_words(const DeterminedRecord& d) {
  double factor = 1, shift = 0;
  std::string unit = d.unit, name = d.words;
  if (d.unit.empty()) {
    factor = 100;
    shift = d.nominal;
    unit = "%";
    if (const std::size_t at = name.rfind(" factor"); at != std::string::npos) name.resize(at);
  } else {
    const ReadUnit read = read_unit(d.unit);
    factor = read.factor;
    unit = read.name;
  }
  const double half = factor * d.interval.half_width;
  const int digits = digits_of_half_width(half, 2);
  return fmt::format("{} {:+.{}f} +- {:.{}f} {}", name, factor * (d.value - shift), digits, half, digits,
                     unit);
}

void add_determined(const RunRecord& record, std::vector<Clause>& clauses) {
  if (!record.trust) return;
  std::string told, refused;
  for (const DeterminedRecord& d : record.trust->determined) {
    if (std::isfinite(d.interval.half_width))
      told += (told.empty() ? "" : ", ") + number_words(d);
    else
      refused = d.interval.reason;
  }
  if (!told.empty())
    clauses.push_back({"determined", fmt::format("The drives determine: {}.", told), kNotANumber, kNotANumber,
                       kNotANumber, ""});
  else if (!refused.empty())
    clauses.push_back({"determined", fmt::format("What the drives determine has no interval: {}.", refused),
                       kNotANumber, kNotANumber, kNotANumber, ""});
  if (record.trust->systematic)
    clauses.push_back({"kinds",
                       "Errors repeat within each kind of drive: the model lacks something "
                       "('bench models' looks for it); +- says how well the result repeats.",
                       record.trust->kind_f, kNotANumber, record.trust->kind_p, ""});
}

// Of headings without positions.
void add_ratios(const RunRecord& record, std::vector<Clause>& clauses) {
  if (!record.trust || !record.trust->ratios_only) return;
  std::string held;
  for (const ParameterValue& p : record.parameters)
    if (!(p.lower < p.upper) && p.unit == "m") held += (held.empty() ? "" : ", ") + p.name;
  clauses.push_back(
      {"ratios",
       fmt::format(
           "Ratios only: headings tell no length. {} the measure of all others; a straight line of known "
           "length gives the factor on all of them.",
           held.empty() ? "The nominal sizes are" : held + ", held at its nominal value, is"),
       kNotANumber, kNotANumber, kNotANumber, ""});
}

void add_bounds(const RunRecord& record, std::vector<Clause>& clauses) {
  std::string names;
  std::size_t active = 0;
  for (const ParameterValue& p : record.parameters) {
    if (p.at_bound.empty() || p.lower >= p.upper) continue;
    names += (active++ == 0 ? "" : ", ") + p.name;
  }
  if (active == 0) return;
  const std::size_t all = free_count(record);
  clauses.push_back({"bounds",
                     fmt::format("{} of {} on bounds ({}): no single parameter is a measurement.", active,
                                 count_words(all, "parameter"), names),
                     static_cast<double>(active), kNotANumber, static_cast<double>(all), ""});
}

void add_open(const char* about, const OpenClause& open, std::vector<Clause>& clauses) {
  if (!open.sentence.empty())
    clauses.push_back({about, open.sentence, open.value, kNotANumber, open.against, open.unit});
}

void add_set_aside(const RunRecord& record, std::vector<Clause>& clauses) {
  std::string names;
  std::size_t count = 0;
  for (const Measure& m : record.measures) {
    constexpr std::string_view kBegin = "set_aside.", kEnd = ".z";
    if (m.name.size() <= kBegin.size() + kEnd.size() || m.name.compare(0, kBegin.size(), kBegin) != 0 ||
        m.name.compare(m.name.size() - kEnd.size(), kEnd.size(), kEnd) != 0)
      continue;
    names += (count++ == 0 ? "" : ", ") + m.of;
  }
  if (count == 0) return;
  const std::size_t all = record.errors.size() + count;
  clauses.push_back({"set_aside",
                     fmt::format("{} left out, unlike {} repetitions: {}.", count_words(count, "drive"),
                                 count == 1 ? "its" : "their", names),
                     static_cast<double>(count), kNotANumber, static_cast<double>(all), ""});
}

}  // namespace

std::optional<Table> verdict_table(const Comparison& comparison) {
  const BestRun best = best_run(comparison);
  if (best.record == nullptr || comparison.nominal() == nullptr || best.record->errors.empty())
    return std::nullopt;
  const double nominal = error_totals(comparison.nominal()->errors).total, total = total_of(*best.record);
  if (!std::isfinite(change_percent(total, nominal)))
    return std::nullopt;  // overflowed, or nothing to compare
  std::vector<Clause> clauses{use_clause(best, nominal, total)};
  add_unseen_kinds(*best.record, clauses);
  add_ratios(*best.record, clauses);
  add_determined(*best.record, clauses);
  add_open("explains", explanation_clause(*best.record), clauses);
  add_bounds(*best.record, clauses);
  add_open("twice_box", twice_box_clause(*best.record), clauses);
  add_open("single", single_parameters_clause(*best.record), clauses);
  add_set_aside(*best.record, clauses);
  add_open("next", next_drives_clause(*best.record), clauses);

  Table table;
  table.id = comparison.id_prefix + "verdict";
  table.title = "Verdict" + comparison.title_suffix;
  table.columns = {text_column("about"),     text_column("sentence"),
                   number_column("value"),   number_column("half_width", "+-"),
                   number_column("against"), text_column("unit")};
  table.sentences = "sentence";
  table.key = true;
  const auto cell = [](double value) { return std::isfinite(value) ? significant_cell(value, 4) : Cell{}; };
  for (const Clause& c : clauses)
    table.rows.push_back({text_cell(c.about), text_cell(c.sentence), cell(c.value), cell(c.half_width),
                          cell(c.against), text_cell(c.unit)});
  return table;
}

}  // namespace odobench
