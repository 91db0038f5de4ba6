#include "reports/kinds/calibration/calibration_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "reports/kinds/calibration/card_figure.hpp"
#include "reports/kinds/calibration/drive_tables.hpp"
#include "reports/kinds/calibration/fit_table.hpp"
#include "reports/kinds/calibration/overview_tables.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/kinds/calibration/track_figures.hpp"
#include "reports/kinds/calibration/verdict_table.hpp"
#include "reports/kinds/optimisers/optimiser_tables.hpp"
#include "reports/kinds/trust/loss_tables.hpp"
#include "reports/kinds/trust/next_steps_tables.hpp"
#include "reports/kinds/trust/noise_tables.hpp"
#include "reports/kinds/trust/profile_record.hpp"
#include "reports/kinds/trust/trust_tables.hpp"
#include "reports/kinds/trust/validation_tables.hpp"

namespace odobench {
namespace {

std::string prefix_of(const Comparison& comparison) {
  return comparison.id_prefix.empty() ? "" : vega::slug(comparison.problem + "-" + comparison.dataset) + ".";
}

// The table without the columns of these ids.
Table without(Table table, const std::set<std::string>& ids) {
  for (std::size_t c = table.columns.size(); c-- > 0;)
    if (ids.count(table.columns[c].id) != 0) erase_column(table, c);
  return table;
}

void append_if(std::optional<Table> table, Section& section) {
  if (table) section.blocks.emplace_back(std::move(*table));
}

// The answer first: what it comes to, before and after, a row per method.
void summarise(const std::vector<Comparison>& comparisons, const std::vector<PlacedTracks>& tracks,
               Section& summary, Document& document) {
  for (const Comparison& c : comparisons) {
    const bool ran = std::any_of(c.rows.begin(), c.rows.end(),
                                 [](const ComparisonRow& r) { return r.kind != "evaluation"; });
    if (const std::optional<Table> verdict = verdict_table(c))
      for (const std::string& sentence : sentences_of(*verdict))
        summary.blocks.emplace_back(Paragraph{sentence + c.title_suffix});
    add_card_figure(c, tracks, prefix_of(c), summary, document);
    if (ran && has_overview(c))
      append_if(overview_table(c), summary);
    else if (has_costs(c))
      summary.blocks.emplace_back(ran ? without(solver_table(c), {"message", "active_bounds"})
                                      : cost_table(c));
    if (const std::optional<Table> found = found_table(c))
      for (const std::string& sentence : sentences_of(*found))
        summary.blocks.emplace_back(Paragraph{found->title + ": " + sentence});
    if (!ran) append_if(totals_table(c), summary);
  }
}

Section errors(const std::vector<Comparison>& comparisons, Document& document) {
  Section section{
      "errors",
      "Errors",
      "Per trajectory and variable: the largest error of the drives, their mean and standard deviation; in "
      "brackets the difference to nominal.",
      {}};
  for (const Comparison& c : comparisons) {
    if (c.rows.size() == 1)
      append_if(error_overview(c), section);
    else
      append(error_tables(c), section);
    append(drive_tables(c), section);
    if (best_run(c).row != nullptr) append_if(totals_table(c), section);
    append_if(fit_table(c), section);
    append(noise_tables(c), section);
    append_if(weighted_down_table(c), section);
    append_if(set_aside_table(c), section);
    add_end_figure(c, prefix_of(c), section, document);
  }
  return section;
}

Section validation(const std::vector<Comparison>& comparisons) {
  Section section{
      "validation", "Validation", "How large the errors are on recordings that the fit has not seen.", {}};
  for (const Comparison& c : comparisons) append(validation_tables(c), section);
  return section;
}

Section convergence(const std::vector<Comparison>& comparisons, Document& document) {
  Section section{"convergence", "Convergence", "How fast each method gets how low.", {}};
  for (const Comparison& c : comparisons) {
    add_convergence_figures(c, prefix_of(c), section, document);
    add_repeat_figure(c, prefix_of(c), section, document);
    append_if(repeats_table(c), section);
    if (has_overview(c) && best_run(c).row != nullptr)
      section.blocks.emplace_back(without(solver_table(c), {"message", "active_bounds"}));
  }
  return section;
}

Section parameters(const std::vector<Comparison>& comparisons, const std::vector<std::string>& notes,
                   Document& document) {
  Section section{"parameters", "Parameters", "What was found, against the bounds.", {}};
  for (const Comparison& c : comparisons) {
    std::optional<Table> table = parameter_table(c);
    if (!table) continue;
    add_parameter_figure(c, prefix_of(c), section, document);
    table->notes.insert(table->notes.end(), notes.begin(), notes.end());
    append_if(std::move(table), section);
    append_if(found_table(c), section);
    append(trust_tables(c), section);
    append(next_steps_tables(c), section);
    add_profile_figures(c, prefix_of(c), section, document);
  }
  return section;
}

void add_calibration_page(const KindInput& input, Section& summary, Document& document) {
  const std::vector<Comparison> comparisons = compare(input.records);
  summarise(comparisons, input.tracks, summary, document);
  finish(errors(comparisons, document), document);
  finish(validation(comparisons), document);
  Section trajectories{"trajectories",
                       "Trajectories",
                       "Where the robot was, and where odometry says it was with each result's parameters.",
                       {}};
  for (const PlacedTracks& tracks : input.tracks) add_track_figures(tracks, trajectories, document);
  finish(std::move(trajectories), document);
  finish(convergence(comparisons, document), document);
  add_optimiser_sections(input.records, document);
  finish(parameters(comparisons, input.notes, document), document);
  Section identifiability{
      "identifiability",
      "Identifiability",
      "Which combinations of parameters these recordings determine, and which they do not.",
      {}};
  for (const Comparison& c : comparisons) add_identifiability(c, prefix_of(c), identifiability, document);
  finish(std::move(identifiability), document);
}

std::vector<Table> calibration_tables(const KindInput& input) {
  std::vector<Table> tables = comparison_tables(input.records, input.notes);
  for (Table& table : optimiser_tables(input.records)) tables.push_back(std::move(table));
  return tables;
}

}  // namespace

RecordKind calibration_kind() {
  return {"calibration",
          "parameters found by a solver, or given ones: cost, errors, effort",
          nullptr,
          nullptr,
          calibration_tables,
          add_calibration_page,
          nullptr};
}

}  // namespace odobench
