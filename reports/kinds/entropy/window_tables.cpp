#include "reports/kinds/entropy/window_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "reports/kinds/entropy/entropy_tables.hpp"

namespace odobench {
namespace {

// "csharp-3" of "entropy_windows/csharp-3".
std::string window_id(const RunRecord& record) {
  const auto slash = record.dataset.find('/');
  return slash == std::string::npos ? record.dataset : record.dataset.substr(slash + 1);
}

std::string t_text(const RunRecord& record, bool full_digits) {
  std::string text;
  for (const ParameterValue& p : record.parameters) {
    if (!text.empty()) text += ' ';
    text += full_digits ? fmt::format("{}", p.value + 0.0) : fmt::format("{:.3g}", p.value + 0.0);
  }
  return text;
}

std::vector<Column> window_columns() {
  return {{"window", "window", "", "", "", Align::Left},
          {"group", "group", "", "", "", Align::Left},
          {"samples", "N", "", "$N$", ""},
          {"method", "method", "", "", "", Align::Left},
          {"hamiltonian", "H", "", "$H$", "hamiltonian"},
          {"gap_exact", "below the optimum", "", "", "hamiltonian"},
          {"r1", "r1", "m", "", "state"},
          {"sx1", "sx1", "m", "", "state"},
          {"sy1", "sy1", "m", "", "state"},
          {"ax12", "ax12", "m/s^2", "", "state"},
          {"ay12", "ay12", "m/s^2", "", "state"},
          {"iterations", "iterations", "", "", "effort"},
          {"evaluations", "evaluations", "", "", "effort"},
          {"stop", "stop", "", "", "effort", Align::Left},
          {"t", "t", "", "$t$", "", Align::Left}};
}

Table results_table(const std::vector<RunRecord>& records, bool full_digits) {
  Table table{"windows", "Windows of the relative-entropy filter", window_columns(), {}, {}};
  for (const RunRecord& r : records) {
    std::vector<Cell> cells{text_cell(window_id(r)), text_cell(r.group), Cell{}, text_cell(r.label)};
    const auto cell = [&](const char* name, int digits) {
      const std::optional<double> value = r.measures.value(name);
      return value ? significant_cell(*value, digits) : Cell{};
    };
    if (const auto samples = r.measures.value("samples")) cells[2] = count_cell(*samples);
    cells.push_back(cell("hamiltonian", 12));
    const auto exact = r.measures.value("hamiltonian_exact"), found = r.measures.value("hamiltonian");
    cells.push_back(exact && found ? significant_cell(*exact - *found, 4) : Cell{});
    for (const char* name : {"r1", "sx1", "sy1", "ax12", "ay12"}) cells.push_back(cell(name, 8));
    const bool ran = r.kind != "skipped";
    cells.push_back(ran ? count_cell(static_cast<double>(r.iterations)) : Cell{});
    cells.push_back(ran ? count_cell(static_cast<double>(r.evaluations)) : Cell{});
    cells.push_back(text_cell(r.termination));
    cells.push_back(text_cell(ran ? t_text(r, full_digits) : r.message));
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(
      "Below the optimum: H of the best t in {-1, 0, 1} minus H; negative where t leaves the lattice.");
  return table;
}

// Mean and maximum of what comes by.
struct Series {
  double sum = 0, max = 0;
  std::size_t count = 0;
  void add(double value) {
    max = count == 0 ? value : std::max(max, value);
    sum += value;
    ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
};

struct Method {
  std::string label;
  Series gap, relaxed_gap, iterations, evaluations, seconds;
  std::size_t at_optimum = 0, skipped = 0;
  std::string why_skipped;
};

void add(Method& method, const RunRecord& r) {
  const auto found = r.measures.value("hamiltonian"), rounded = r.measures.value("hamiltonian_rounded"),
             exact = r.measures.value("hamiltonian_exact"), relaxed = r.measures.value("hamiltonian_relaxed");
  if (!found || !rounded || !exact || !relaxed) {
    ++method.skipped;
    method.why_skipped = r.message;
    return;
  }
  const double gap = *exact - *rounded;
  method.gap.add(gap);
  method.at_optimum += gap <= kSameOptimum * std::abs(*exact) ? 1 : 0;
  method.relaxed_gap.add(*relaxed - *found);
  method.iterations.add(static_cast<double>(r.iterations));
  method.evaluations.add(static_cast<double>(r.evaluations));
  method.seconds.add(r.seconds);
}

std::vector<Cell> method_row(const Method& m) {
  std::vector<Cell> cells{text_cell(m.label), count_cell(static_cast<double>(m.gap.count))};
  if (m.gap.count == 0) {
    cells.insert(cells.end(), 9, Cell{});
    return cells;
  }
  cells.push_back(significant_cell(m.gap.mean(), 4));
  cells.push_back(significant_cell(m.gap.max, 4));
  cells.push_back(fixed_cell(100 * static_cast<double>(m.at_optimum) / static_cast<double>(m.gap.count), 1));
  cells.push_back(significant_cell(m.relaxed_gap.mean(), 4));
  cells.push_back(significant_cell(m.relaxed_gap.max, 4));
  cells.push_back(significant_cell(m.iterations.mean(), 4));
  cells.push_back(count_cell(m.iterations.max));
  cells.push_back(significant_cell(m.evaluations.mean(), 6));
  cells.push_back(significant_cell(1e6 * m.seconds.mean(), 4));
  return cells;
}

Table methods_table(const std::vector<RunRecord>& records) {
  std::vector<Method> methods;
  std::map<std::string, std::size_t> places;
  for (const RunRecord& r : records) {
    const auto [place, is_new] = places.emplace(r.label, methods.size());
    if (is_new) methods.push_back({r.label, {}, {}, {}, {}, {}, 0, 0, ""});
    add(methods[place->second], r);
  }
  Table table{"methods", "Methods over all windows", {}, {}, {}};
  table.columns = {
      {"method", "method", "", "", "", Align::Left},
      {"runs", "runs", "", "", ""},
      best_if(Better::Lower, {"gap_mean", "below the optimum, mean", "", "", "gap"}),
      best_if(Better::Lower, {"gap_max", "max", "", "", "gap"}),
      best_if(Better::Higher, {"at_optimum", "at it", "%", "", "gap"}),
      best_if(Better::Lower, {"gap_relaxed_mean", "below the relaxation, mean", "", "", "relaxed"}),
      best_if(Better::Lower, {"gap_relaxed_max", "max", "", "", "relaxed"}),
      {"iterations_mean", "iterations, mean", "", "", "effort"},
      {"iterations_max", "max", "", "", "effort"},
      best_if(Better::Lower, {"evaluations_mean", "evaluations, mean", "", "", "effort"}),
      {"time", "time per window", "us", "", "effort"}};
  table.notes = {
      fmt::format("Below the optimum: H of the best t in {{-1, 0, 1}} minus H at t rounded to it; at it: not "
                  "more than {:g} |H|.",
                  kSameOptimum),
      "Below the relaxation: H of the best t in [-1, 1] minus H at t as found."};
  for (const Method& m : methods) {
    table.rows.push_back(method_row(m));
    if (m.skipped > 0)
      table.notes.push_back(
          fmt::format("{}: no result for {} windows: {}", m.label, m.skipped, m.why_skipped));
  }
  return table;
}

}  // namespace

std::vector<Table> window_tables(const std::vector<RunRecord>& records, bool full_digits) {
  if (records.empty()) return {};
  return {results_table(records, full_digits), methods_table(records)};
}

}  // namespace odobench
