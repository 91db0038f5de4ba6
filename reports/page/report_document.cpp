#include "reports/page/report_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/kinds/calibration/summary_tables.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/kinds/calibration/track_figures.hpp"
#include "reports/kinds/entropy/entropy_figures.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"
#include "reports/kinds/entropy/window_tables.hpp"
#include "reports/kinds/fusion/fusion_figures.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"
#include "reports/kinds/planning/planning_tables.hpp"
#include "reports/kinds/verification/verification_tables.hpp"

namespace odobench {
namespace {

// Every kind of record has tables and figures of its own.
struct Sorted {
  std::vector<RunRecord> filters, windows, fusions, plans, others;
};

Sorted sorted(const std::vector<RunRecord>& records) {
  Sorted out;
  for (const RunRecord& r : records)
    (r.problem == kFilterProblem     ? out.filters
     : r.problem == kWindowProblem   ? out.windows
     : r.problem == kFusionProblem   ? out.fusions
     : r.problem == kPlanningProblem ? out.plans
                                     : out.others)
        .push_back(r);
  return out;
}

std::vector<FusionRow> fusion_rows(const std::vector<RunRecord>& records) {
  std::vector<FusionRow> rows;
  for (const RunRecord& r : records) rows.push_back(fusion_row(r));
  return rows;
}

void append(std::vector<Table> tables, Section& section) {
  for (Table& table : tables) section.blocks.emplace_back(std::move(table));
}
void append(std::optional<Table> table, Section& section) {
  if (table) section.blocks.emplace_back(std::move(*table));
}

std::string prefix_of(const Comparison& comparison) {
  return comparison.id_prefix.empty() ? "" : vega::slug(comparison.problem + "-" + comparison.dataset) + ".";
}

// "40 runs of lm, ip, ga, pso on vitko2024"
std::string description(const std::vector<RunRecord>& records) {
  std::vector<std::string> labels, sets;
  std::size_t runs = 0;
  const auto add = [](const std::string& name, std::vector<std::string>& list) {
    if (!name.empty() && std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const RunRecord& r : records) {
    if (r.kind == "run") ++runs;
    if (r.label != "nominal") add(r.label, labels);
    // "FILE/ID" of windows: the file is enough here.
    add(r.problem == kWindowProblem ? r.dataset.substr(0, r.dataset.find('/')) : r.dataset, sets);
    if (r.dataset.empty()) add(r.problem, sets);
  }
  const auto list = [](const std::vector<std::string>& names, std::size_t most) {
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + names[i];
    return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
  };
  return fmt::format("{}{} on {}", runs > 0 ? fmt::format("{} run{} of ", runs, runs == 1 ? "" : "s") : "",
                     list(labels, 8), list(sets, 4));
}

std::string made(const std::vector<RunRecord>& records) {
  std::string first;
  for (const RunRecord& r : records)
    if (!r.time_utc.empty()) first = first.empty() ? r.time_utc : std::min(first, r.time_utc);
  const RunContext& c = records.front().context;
  return fmt::format("{}, odobench {} (revision {}), {}", first, c.version, c.git_revision, c.cpu);
}

// "Lowest J: 98.11878 by lm; nominal 1135.332. Its total error is 0.378039, nominal 1.273980 (-70.33 %); 6 of
// 18 mean errors got worse."
std::string headline(const Comparison& comparison) {
  const ComparisonRow* best = nullptr;
  for (const ComparisonRow& row : comparison.rows)
    if (row.label != "nominal" && row.shown->cost &&
        (best == nullptr || *row.shown->cost < *best->shown->cost))
      best = &row;
  if (best == nullptr) return "";
  const ComparisonRow* nominal = comparison.nominal();
  std::string text =
      fmt::format("Lowest J{}: {:.10g} by {}", comparison.title_suffix, *best->shown->cost, best->label);
  if (nominal == nullptr || !nominal->shown->cost) return text + ".";
  text += fmt::format("; nominal {:.10g}.", *nominal->shown->cost);
  if (best->errors.empty() || best->errors.size() != nominal->errors.size()) return text;
  const double total = error_totals(best->errors).total, before = error_totals(nominal->errors).total;
  const WorseMeans worse = worse_means(*best, *nominal);
  return text + fmt::format(
                    " Its total error is {:.6f}, nominal {:.6f} ({:+.2f} %); {} of {} mean errors got worse.",
                    total, before, 100 * (total - before) / before, worse.worse, worse.all);
}

// The table without the columns of these ids.
Table without(Table table, const std::set<std::string>& ids) {
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    if (ids.count(table.columns[c].id) == 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    table.columns.erase(table.columns.begin() + at);
    for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + at);
  }
  return table;
}

class Builder {
 public:
  explicit Builder(const ReportInput& input)
      : input_(input),
        sorted_(sorted(input.records)),
        comparisons_(compare(sorted_.others)),
        filter_tables_(filter_tables(sorted_.filters)),
        window_tables_(window_tables(sorted_.windows, false)) {}

  Document build() {
    document_.title = input_.title.empty() ? description(input_.records) : input_.title;
    document_.subtitle = made(input_.records);
    summary();
    errors();
    trajectories();
    convergence();
    parameters();
    identifiability();
    filter();
    windows();
    fusion();
    planning();
    Section provenance{"provenance", "Provenance", "What the numbers depend on.", {}};
    append(provenance_tables(input_.records), provenance);
    finish(std::move(provenance));
    return std::move(document_);
  }

 private:
  void finish(Section section) {
    if (!section.blocks.empty()) document_.sections.push_back(std::move(section));
  }

  void summary() {
    Section section{"summary", "Summary", description(input_.records) + ".", {}};
    std::vector<Table> overall = summary_tables(input_.records);
    std::reverse(overall.begin(), overall.end());
    append(std::move(overall), section);
    for (const Comparison& c : comparisons_) {
      const bool ran = std::any_of(c.rows.begin(), c.rows.end(),
                                   [](const ComparisonRow& r) { return r.kind != "evaluation"; });
      if (const std::string text = headline(c); !text.empty()) section.blocks.emplace_back(Paragraph{text});
      if (has_costs(c))
        section.blocks.emplace_back(ran ? without(solver_table(c), {"message", "active_bounds"})
                                        : cost_table(c));
      append(totals_table(c), section);
    }
    if (!sorted_.filters.empty()) section.blocks.emplace_back(filter_tables_.front());
    for (const Table& table : window_tables_)
      if (table.id == "methods") section.blocks.emplace_back(table);
    for (const Comparison& c : compare(sorted_.fusions)) append(totals_table(c), section);
    if (!sorted_.fusions.empty() && !sorted_.fusions.front().notes.empty())
      section.blocks.emplace_back(Paragraph{sorted_.fusions.front().notes.front() + "."});
    for (const std::string& sentence : input_.absent) section.blocks.emplace_back(Paragraph{sentence});
    finish(std::move(section));
  }

  void errors() {
    Section section{
        "errors",
        "Errors",
        "Per trajectory and variable: the largest error of the drives, their mean and standard deviation; in "
        "brackets the difference to nominal.",
        {}};
    for (const Comparison& c : comparisons_) {
      append(c.rows.size() == 1 ? std::vector<Table>{} : error_tables(c), section);
      if (c.rows.size() == 1) append(error_overview(c), section);
    }
    append(arrival_tables(sorted_.others), section);
    finish(std::move(section));
  }

  // Of calibrations, or of the fusion.
  void tracks_of(bool fusion, Section& section) {
    const auto wanted = [&](const TrackSet& set) { return (set.problem == kFusionProblem) == fusion; };
    const bool several = std::count_if(input_.tracks.begin(), input_.tracks.end(), wanted) > 1;
    for (std::size_t i = 0; i < input_.tracks.size(); ++i) {
      const TrackSet& set = input_.tracks[i];
      if (!wanted(set)) continue;
      const std::size_t before = section.blocks.size();
      const std::string prefix = input_.tracks.size() > 1 ? fmt::format("{}.", i + 1) : "";
      add_track_figures(set, prefix, section, document_, kTrackRows / input_.tracks.size());
      for (std::size_t b = before; several && b < section.blocks.size(); ++b)
        std::get<Figure>(section.blocks[b]).title += fmt::format(" ({}, {})", i + 1, set.dataset);
    }
  }

  void trajectories() {
    Section section{"trajectories",
                    "Trajectories",
                    "Where the robot was, and where odometry says it was with each result's parameters.",
                    {}};
    tracks_of(false, section);
    finish(std::move(section));
  }

  void convergence() {
    Section section{"convergence", "Convergence", "How fast each method gets how low.", {}};
    for (const Comparison& c : comparisons_) {
      add_convergence_figures(c, prefix_of(c), section, document_);
      add_repeat_figure(c, prefix_of(c), section, document_);
      append(repeats_table(c), section);
    }
    finish(std::move(section));
  }

  void parameters() {
    Section section{"parameters", "Parameters", "What was found, against the bounds.", {}};
    for (const Comparison& c : comparisons_) {
      std::optional<Table> table = parameter_table(c);
      if (!table) continue;
      add_parameter_figure(c, prefix_of(c), section, document_);
      table->notes.insert(table->notes.end(), input_.notes.begin(), input_.notes.end());
      append(std::move(table), section);
    }
    finish(std::move(section));
  }

  void identifiability() {
    Section section{"identifiability",
                    "Identifiability",
                    "Which combinations of parameters these recordings determine, and which they do not.",
                    {}};
    for (const Comparison& c : comparisons_) add_identifiability(c, prefix_of(c), section, document_);
    finish(std::move(section));
  }

  void filter() {
    Section section{"filter", "Relative-entropy filter", "Signals before and after the filter.", {}};
    append(filter_tables_, section);
    for (std::size_t i = 0; i < sorted_.filters.size(); ++i)
      add_filter_figures(sorted_.filters[i],
                         sorted_.filters.size() > 1 ? fmt::format("filter{}.", i + 1) : "", section,
                         document_);
    finish(std::move(section));
  }

  void windows() {
    Section section{
        "windows", "Windows of the relative-entropy filter", "The same windows solved by each method.", {}};
    add_window_figure(sorted_.windows, "", section, document_);
    // The methods before the many windows.
    append(std::vector<Table>(window_tables_.rbegin(), window_tables_.rend()), section);
    finish(std::move(section));
  }

  void fusion() {
    Section section{"fusion", "Sensor fusion", "Odometry fused with a camera and a gyro.", {}};
    if (sorted_.fusions.empty()) return;
    for (const std::string& note : sorted_.fusions.front().notes)
      section.blocks.emplace_back(Paragraph{note});
    const std::vector<FusionRow> rows = fusion_rows(sorted_.fusions);
    append(fusion_tables(nullptr, sorted_.fusions, rows), section);
    add_consistency_figures(rows, "", section, document_);
    tracks_of(true, section);
    finish(std::move(section));
  }

  void planning() {
    Section section{"planning", "Planned drives", "What calibrations on these drives would determine.", {}};
    for (const RunRecord& record : sorted_.plans) append(planning_tables(record), section);
    finish(std::move(section));
  }

  const ReportInput& input_;
  const Sorted sorted_;
  const std::vector<Comparison> comparisons_;
  const std::vector<Table> filter_tables_, window_tables_;
  Document document_;
};

}  // namespace

Document make_report(const ReportInput& input) {
  return Builder(input).build();
}

std::vector<Table> record_tables(const std::vector<RunRecord>& records, const std::vector<std::string>& notes,
                                 bool full_digits) {
  const Sorted kinds = sorted(records);
  std::vector<Table> tables;
  const auto add = [&](std::vector<Table> more) {
    for (Table& table : more) tables.push_back(std::move(table));
  };
  if (!kinds.others.empty()) add(comparison_tables(kinds.others, notes));
  add(arrival_tables(kinds.others));
  for (const RunRecord& plan : kinds.plans) add(planning_tables(plan));
  add(filter_tables(kinds.filters));
  add(window_tables(kinds.windows, full_digits));
  if (!kinds.fusions.empty()) add(fusion_tables(nullptr, kinds.fusions, fusion_rows(kinds.fusions)));
  return tables;
}

}  // namespace odobench
