#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/files.hpp"
#include "base/names.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/campaign/store_study.hpp"

namespace odobench {
namespace {

constexpr const char* kStoreExamples = R"(Examples:
  bench store info results.db
  bench store query results.db "SELECT label, count(*), min(cost) FROM cells GROUP BY label" --format=csv
  bench store export results.db --out=runs.jsonl
  bench store import results.db shard_1.db shard_2.db --same-campaign
Tables: cells(key, campaign, place, current, problem, dataset, label, solver, polish, repetition, seed, kind, termination, cost,
evaluations, seconds, time_utc, result, check_sum, record) and campaigns(name, plan, cells, shard, definition, time_utc); record is
the JSON line of runs.jsonl, so json_extract(record, '$.iterations') works: docs/campaigns.md.)";

struct StoreOptions {
  std::string what, store;
  std::vector<std::string> rest;  // the statement of query, the sources of import
  std::string out = "-";
  std::string only;  // pattern of cells to export
  bool overwrite = false, all = false, same_campaign = false;
  int wait_s = 0;
  std::string format = "console";
};

void add_options(CLI::App& app, StoreOptions& o) {
  app.add_option("what", o.what, "info, query, export or import (merge)")->required();
  app.add_option("store", o.store, "the store")->required();
  app.add_option("rest", o.rest, "of query: a statement of SQL; of import: stores, .jsonl files and folders");
  app.add_option("--out", o.out, "of export: file of JSON lines [standard output]")->type_name("FILE");
  app.add_flag("--overwrite", o.overwrite, "of export: replace the file");
  app.add_option("--only", o.only, "of export: records whose PROBLEM/LABEL/REPETITION is like this [all]")
      ->type_name("PATTERN");
  app.add_flag("--all", o.all, "of export: also records that their campaign no longer plans");
  app.add_flag("--same-campaign", o.same_campaign,
               "of import: refuse stores of another campaign or plan than that of the store");
  add_wait(app, o.wait_s);
  app.footer(kStoreExamples);
  add_format(app, o.format);
}

void require_rest(const StoreOptions& o, std::size_t least, std::size_t most, const char* what) {
  if (o.rest.size() < least)
    throw std::invalid_argument(fmt::format("bench store {}: {} is missing", o.what, what));
  if (o.rest.size() > most)
    throw std::invalid_argument(
        fmt::format("bench store {}: '{}' is not expected here", o.what, o.rest[most]));
}

void export_records(const StoreOptions& o) {
  const auto say = [&](std::int64_t count) {
    note(fmt::format("{}: {} records of {}", o.out == "-" ? "standard output" : o.out, count, o.store));
  };
  if (o.out == "-") {
    say(export_lines(o.store, o.only, o.all, [](std::string_view line) { print_text(std::string(line)); }));
    return;
  }
  refuse_existing("--out", o.out, o.overwrite);
  RecordStore{o.store};  // a store that is none leaves nothing behind
  InterruptGuard::remember();
  FileTransaction transaction(existing_files(o.overwrite));
  transaction.add(o.out, "");
  const std::int64_t count = export_lines(o.store, o.only, o.all, [&](std::string_view line) {
    InterruptGuard::stop().check();
    transaction.append(line);
  });
  transaction.commit();
  say(count);
}

void import_sources(const StoreOptions& o, Format format) {
  TerminalWatcher watcher;
  Table table{
      "import",
      "Records brought into " + o.store,
      {text_column("source"), number_column("taken"), number_column("known", "there already"),
       number_column("differing", "with another result"), number_column("interrupted", "not complete")},
      {},
      {}};
  for (const StoreImport& one :
       import_records(o.store, o.rest, o.same_campaign, std::chrono::seconds(o.wait_s), watcher,
                      InterruptGuard::stop())) {
    const ImportCount& c = one.count;
    std::vector<Cell> row{text_cell(one.source)};
    for (const std::int64_t value : {c.taken, c.known, c.differing, c.interrupted})
      row.push_back(count_cell(static_cast<double>(value)));
    table.rows.push_back(std::move(row));
  }
  print_tables({table}, format);
}

ExitCode store_command(const StoreOptions& o) {
  const Format format = parse_format(o.format);
  const std::vector<std::string> known{"info", "query", "export", "import", "merge"};
  if (std::find(known.begin(), known.end(), o.what) == known.end())
    throw std::invalid_argument(fmt::format("bench store '{}'{}: expected info, query, export or import",
                                            o.what, did_you_mean(o.what, known)));
  constexpr std::size_t any = 1'000'000;
  if (o.what == "info") {
    require_rest(o, 0, 0, "");
    print_tables(store_tables(o.store), format);
  } else if (o.what == "query") {
    require_rest(o, 1, 1, "a statement of SQL");
    print_tables({query_table(o.store, o.rest.front())}, format);
  } else if (o.what == "export") {
    require_rest(o, 0, 0, "");
    export_records(o);
  } else {
    require_rest(o, 1, any, "a store, .jsonl file or folder to bring in");
    import_sources(o, format);
  }
  return ExitCode::Success;
}

}  // namespace

VerbAction add_store(CLI::App& app) {
  return verb_action<StoreOptions>(app, add_options, store_command);
}

}  // namespace odobench
