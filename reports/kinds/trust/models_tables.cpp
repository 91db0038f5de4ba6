#include "reports/kinds/trust/models_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace odobench {
namespace {

const char* of_reading(const RunRecord& record) {
  for (const std::string& note : record.notes)
    if (note.rfind(kReadingNote, 0) == 0) return note.c_str() + std::char_traits<char>::length(kReadingNote);
  return "";
}

Cell total_cell(const RunRecord& record, const char* name) {
  const std::optional<double> value = record.measures.value(name);
  return value ? fixed_cell(*value, 4) : Cell{};
}

// By the first question that could be asked, nominal first.
std::vector<const RunRecord*> in_order(const std::vector<RunRecord>& records) {
  std::vector<const RunRecord*> list;
  for (const RunRecord& r : records) list.push_back(&r);
  const auto key = [](const RunRecord* r) {
    for (const char* name : {"held_total", "new_kind_total", "total"})
      if (const std::optional<double> value = r->measures.value(name)) return *value;
    return HUGE_VAL;
  };
  std::stable_sort(list.begin(), list.end(), [&](const RunRecord* a, const RunRecord* b) {
    const bool a_nominal = a->label == "nominal", b_nominal = b->label == "nominal";
    if (a_nominal != b_nominal) return a_nominal;
    return key(a) < key(b);
  });
  return list;
}

Table ranking(const std::vector<RunRecord>& records) {
  Table t{
      "models",
      "Models of the robot, by what they say about recordings that they were not fitted to",
      {text_column("model"), number_column("free"), number_column("on_bounds", "on bounds"),
       number_column("cost", "J", "", "fitted"), number_column("total", "total", "m + rad", "fitted"),
       best_if(Better::Lower, number_column("held_total", "another repetition", "m + rad", "held out")),
       best_if(Better::Lower, number_column("new_kind_total", "a new kind of drive", "m + rad", "held out")),
       number_column("held_cost", "J held out", "", "held out"), number_column("bic", "BIC"),
       text_column("reading", "what it is"), text_column("recommended")},
      {},
      {}};
  for (const RunRecord* r : in_order(records)) {
    const auto count = [&](const char* name) {
      const std::optional<double> value = r->measures.value(name);
      return value ? count_cell(*value) : Cell{};
    };
    if (r->label == "nominal") t.references.push_back(t.rows.size());
    t.rows.push_back(
        {text_cell(r->label), count("free"), count("on_bounds"),
         r->cost ? significant_cell(*r->cost, 6) : Cell{}, total_cell(*r, "total"),
         total_cell(*r, "held_total"), total_cell(*r, "new_kind_total"),
         r->measures.value("held_cost") ? significant_cell(*r->measures.value("held_cost"), 5) : Cell{},
         r->measures.value("bic") ? fixed_cell(*r->measures.value("bic"), 1) : Cell{},
         text_cell(of_reading(*r)),
         text_cell(r->measures.value("recommended").value_or(0) > 0 ? "yes" : "")});
  }
  t.notes.push_back(
      "Another repetition: each recording by the fit without its repetition. A new kind of drive: by the fit "
      "without its trajectory.");
  for (const RunRecord& r : records)
    for (const std::string& note : r.notes)
      if (note.rfind(kReadingNote, 0) != 0)
        t.notes.push_back(r.label == "nominal" ? note + "." : fmt::format("{}: {}.", r.label, note));
  return t;
}

// Parameters that the plain model does not have, with their range over the folds.
Table extras(const std::vector<RunRecord>& records) {
  Table t{"models.extras",
          "What the models have beyond the robot's own parameters",
          {text_column("model"), text_column("parameter"), number_column("value"),
           number_column("least", "least in folds"), number_column("most", "most in folds"),
           text_column("unit"), text_column("on_bound", "on a bound")},
          {},
          {}};
  for (const RunRecord* r : in_order(records))
    for (const ParameterValue& p : r->parameters) {
      const auto found = r->series.find("offsets." + p.name);
      if (found == r->series.end()) continue;
      Cell least, most;
      if (!found->second.empty()) {
        const auto [a, b] = std::minmax_element(found->second.begin(), found->second.end());
        least = significant_cell(*a, 4);
        most = significant_cell(*b, 4);
      }
      t.rows.push_back({text_cell(r->label), text_cell(p.name), significant_cell(p.value, 5), least, most,
                        text_cell(p.unit), text_cell(p.at_bound)});
    }
  return t;
}

std::vector<Table> tables_of(const KindInput& input) {
  return models_tables(input.records);
}

void add_page(const KindInput& input, Section&, Document& document) {
  Section section{"models", "Models of the robot", "Which parameters help on recordings not fitted to.", {}};
  append(tables_of(input), section);
  finish(std::move(section), document);
}

}  // namespace

std::vector<Table> models_tables(const std::vector<RunRecord>& records) {
  std::vector<Table> tables{ranking(records)};
  Table more = extras(records);
  if (!more.rows.empty()) tables.push_back(std::move(more));
  return tables;
}

RecordKind models_kind() {
  return {"models",
          "models of a robot compared: fitted, held out by repetition and by trajectory",
          [](std::string_view problem) { return problem == kModelsProblem; },
          nullptr,
          tables_of,
          add_page,
          nullptr};
}

}  // namespace odobench
