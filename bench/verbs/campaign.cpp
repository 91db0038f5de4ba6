#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/campaign/campaign.hpp"

namespace odobench {
namespace {

constexpr const char* kCampaignExamples = R"(Examples:
  bench campaign campaigns/smoke.json --dry-run
  bench campaign campaigns/smoke.json --out=smoke.db          the same again goes on where it was ended
  bench campaign mine.json --out=shard_2.db --shard=2/4       then: bench store import mine.db shard_*.db --same-campaign
  bench campaign mine.json --out=mine.db --only='nist:*/pso*/3'
  bench campaign mine.json --out=mine.db --isolate=time=60,memory=2G
  bench report mine.db
docs/campaigns.md describes the file. Exit codes: 0 all cells are there, 1 some failed, 130 interrupted.)";

struct CampaignOptions {
  CampaignStudy study;
  int wait_s = 0;
  bool quiet = false;
  std::string format = "console";
};

void add_options(CLI::App& app, CampaignOptions& o) {
  app.add_option("file", o.study.file, "campaign file (JSON)")->required();
  app.add_option("--out", o.study.store, "store of the results, made where it is not there")
      ->type_name("STORE.DB");
  app.add_flag("--dry-run", o.study.plan_only, "show the plan and what is missing in --out; run nothing");
  app.add_option("--only", o.study.only,
                 "run these cells, also those that are there: a pattern of PROBLEM/LABEL/REPETITION or the "
                 "first digits of a key")
      ->type_name("PATTERN");
  add_value(app, "--shard", "I/N", "every N-th cell from the I-th on, into a store of its own",
            [&o](const std::string& text) { o.study.shard = parse_shard("--shard", text); });
  add_value(app, "--isolate", "[=time=S,memory=SIZE]",
            "cells in child processes: one that crashes, hangs or takes too much memory costs its cell only",
            [&o](const std::string& text) {
              o.study.isolate = parse_isolation("--isolate", text == "true" || text == "{}" ? "" : text);
            })
      ->expected(0, 1);
  add_wait(app, o.wait_s);
  add_threads(app, o.study.threads);
  add_kernel(app, o.study.kernel, kLastBits);
  app.add_flag("--quiet", o.quiet, "no progress and no remarks on standard error");
  app.footer(kCampaignExamples);
  add_format(app, o.format);
}

std::vector<Table> plan_tables(const CampaignSummary& summary, bool machine) {
  const auto number = [](std::size_t n) { return count_cell(static_cast<double>(n)); };
  Table table{
      "campaign",
      fmt::format("Campaign {}: {} cells on {} problems, {} there, {} to run", summary.name, summary.planned,
                  summary.problems, summary.kept, summary.left()),
      {text_column("label"), number_column("cells"), number_column("there"), number_column("missing")},
      {},
      {"Plan " + summary.plan.substr(0, 12) + "."}};
  for (const CampaignRow& row : summary.rows)
    table.rows.push_back(
        {text_cell(row.label), number(row.planned), number(row.kept), number(row.planned - row.kept)});
  if (!machine) return {table};
  Table cells{
      "campaign.cells", "Cells", {text_column("cell"), text_column("key"), text_column("there")}, {}, {}};
  for (const CampaignSummary::Cell& cell : summary.cells)
    cells.rows.push_back({text_cell(cell.name), text_cell(cell.key), text_cell(cell.there ? "yes" : "no")});
  return {table, cells};
}

Table outcome_table(const CampaignSummary& summary) {
  const auto number = [](std::size_t n) { return count_cell(static_cast<double>(n)); };
  Table table{"campaign",
              fmt::format("Campaign {}: {} cells, {} kept, {} run in {:.2f} s, {} failed, {} left",
                          summary.name, summary.planned, summary.kept, summary.run, summary.seconds,
                          summary.failed, summary.left()),
              {text_column("label"), number_column("cells"), number_column("kept"), number_column("run"),
               number_column("failed"), number_column("left")},
              {},
              {}};
  for (const CampaignRow& row : summary.rows)
    table.rows.push_back({text_cell(row.label), number(row.planned), number(row.kept), number(row.run),
                          number(row.failed), number(row.planned - row.kept - row.run)});
  return table;
}

ExitCode campaign_command(const CampaignOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  CampaignStudy study = options.study;
  study.patience = std::chrono::seconds(options.wait_s);
  if (study.store.empty() && !study.plan_only)
    throw std::invalid_argument("--out is missing: expected the file of the store, or --dry-run");
  TerminalWatcher watcher(options.quiet);
  const CampaignSummary summary = run_campaign(study, catalogue, watcher, InterruptGuard::stop());
  if (study.plan_only) {
    print_tables(plan_tables(summary, format == Format::Csv || format == Format::Json), format);
    return ExitCode::Success;
  }
  print_tables({outcome_table(summary)}, format);
  if (summary.interrupted && summary.left() > 0) {
    note(fmt::format("interrupted: {} of {} cells are in {}; the same command goes on",
                     summary.kept + summary.run, summary.planned, study.store));
    return ExitCode::Interrupted;
  }
  return summary.failed > 0 ? ExitCode::CheckFailed : ExitCode::Success;
}

}  // namespace

VerbAction add_campaign(CLI::App& app) {
  return verb_action<CampaignOptions>(app, add_options, campaign_command);
}

}  // namespace odobench
