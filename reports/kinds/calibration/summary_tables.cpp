#include "reports/kinds/calibration/summary_tables.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

std::string family_of(const std::string& problem) {
  const auto colon = problem.find(':');
  return colon == std::string::npos ? "classic" : problem.substr(0, colon);
}

struct Group {
  std::string family, label;
  std::vector<const RunRecord*> runs;
};

std::vector<Group> groups_of(const std::vector<const RunRecord*>& runs) {
  std::vector<Group> groups;
  for (const RunRecord* run : runs) {
    const std::string family = family_of(run->problem);
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.family == family && g.label == run->label;
    });
    if (found != groups.end())
      found->runs.push_back(run);
    else
      groups.push_back({family, run->label, {run}});
  }
  return groups;
}

double count_if(const Group& group, bool (*holds)(const RunRecord&)) {
  return static_cast<double>(
      std::count_if(group.runs.begin(), group.runs.end(), [&](const RunRecord* r) { return holds(*r); }));
}

void append_median_and(std::vector<Cell>& cells, const std::vector<double>& values, double Spread::*other,
                       int digits) {
  if (values.empty()) {
    cells.insert(cells.end(), 2, Cell{});
    return;
  }
  const Spread s = spread(values);
  cells.push_back(significant_cell(s.median, digits));
  cells.push_back(significant_cell(s.*other, digits));
}

std::vector<Cell> summary_row(const Group& group) {
  std::set<std::string> problems;
  std::vector<double> digits, evaluations;
  double total = 0, seconds = 0;
  for (const RunRecord* r : group.runs) {
    problems.insert(r->problem);
    if (r->known->digits) digits.push_back(*r->known->digits);
    if (r->known->solved) evaluations.push_back(static_cast<double>(r->evaluations));
    total += static_cast<double>(r->evaluations);
    seconds += r->seconds;
  }
  std::vector<Cell> cells{
      text_cell(group.label),
      text_cell(group.family),
      count_cell(static_cast<double>(problems.size())),
      count_cell(static_cast<double>(group.runs.size())),
      count_cell(count_if(group, [](const RunRecord& r) { return r.known->solved; })),
      count_cell(count_if(
          group, [](const RunRecord& r) { return !r.known->solved && r.termination == "converged"; })),
      count_cell(count_if(group, false_verdict))};
  append_median_and(cells, digits, &Spread::min, 3);
  append_median_and(cells, evaluations, &Spread::max, 9);
  cells.push_back(count_cell(total));
  cells.push_back(fixed_cell(seconds, 3));
  return cells;
}

Table summary_table(const std::vector<Group>& groups) {
  Table table{
      "problems_summary",
      "All problems with a known answer",
      {text_column("solver"), text_column("family"), number_column("problems", "problems", "", "success"),
       number_column("runs", "runs", "", "success"),
       best_if(Better::Higher, number_column("solved", "solved", "", "success")),
       number_column("converged_elsewhere", "converged elsewhere", "", "verdicts"),
       number_column("false_verdicts", "false verdicts", "", "verdicts"),
       best_if(Better::Higher, number_column("digits_median", "digits median", "", "digits")),
       number_column("digits_min", "min", "", "digits"),
       number_column("evaluations_median", "evaluations median", "", "evaluations"),
       number_column("evaluations_max", "max", "", "evaluations"),
       number_column("evaluations_total", "total", "", "evaluations"),
       number_column("seconds_total", "time total", "s", "time")},
      {},
      {"Solved: parameters to 6 digits (nist), J within 1e-6 of the lowest known (others; 1e-12 where that "
       "is "
       "0). Converged elsewhere: the verdict holds at a point that is not the known answer, such as another "
       "minimum.",
       "False verdicts: converged, though a bounded Gauss-Newton step by differences of residuals gains more "
       "than "
       "1e-6 of J and ten times what the verdict allows.",
       "Digits: of the worst parameter (log relative error, at most 11). Evaluations, median and max: of the "
       "runs "
       "that solved."}};
  for (const Group& group : groups) table.rows.push_back(summary_row(group));
  return table;
}

Table unsolved_table(const std::vector<const RunRecord*>& runs) {
  Table table{
      "problems_unsolved",
      "Runs that did not reach the known answer",
      {text_column("solver"), text_column("problem"), number_column("cost", "J", "", "cost"),
       number_column("known", "lowest known J", "", "cost"), number_column("digits", "digits", "", "cost"),
       number_column("evaluations", "evaluations", "", "effort"), text_column("termination", "stop", "stop"),
       text_column("message", "reason", "stop")},
      {},
      {}};
  for (const RunRecord* r : runs) {
    if (r->known->solved) continue;
    table.rows.push_back(
        {text_cell(r->label), text_cell(r->problem), r->cost ? significant_cell(*r->cost, 8) : Cell{},
         significant_cell(r->known->cost, 8), r->known->digits ? fixed_cell(*r->known->digits, 1) : Cell{},
         count_cell(static_cast<double>(r->evaluations)), text_cell(r->termination), text_cell(r->message)});
  }
  return table;
}

}  // namespace

std::vector<Table> summary_tables(const std::vector<RunRecord>& records) {
  std::vector<const RunRecord*> runs;
  std::set<std::string> problems;
  for (const RunRecord& r : records)
    if (r.kind == "run" && r.known) {
      runs.push_back(&r);
      problems.insert(r.problem);
    }
  if (problems.size() < 2) return {};
  std::vector<Table> tables{summary_table(groups_of(runs))};
  if (Table unsolved = unsolved_table(runs); !unsolved.rows.empty())
    tables.insert(tables.begin(), std::move(unsolved));
  for (Table& table : tables) table.key = true;
  return tables;
}

}  // namespace odobench
