#include "bench/studies/campaign/store_study.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/text.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

Cell whole_cell(std::int64_t value) {
  constexpr std::int64_t exact = std::int64_t{1} << 53;
  return std::abs(value) < exact ? count_cell(static_cast<double>(value)) : text_cell(std::to_string(value));
}

Cell cell_of(const SqliteStatement& row, int column) {
  constexpr int digits = 10;
  switch (row.kind(column)) {
    case SqliteStatement::Kind::Null:
      return {};
    case SqliteStatement::Kind::Integer:
      return whole_cell(row.integer(column));
    case SqliteStatement::Kind::Real:
      return significant_cell(row.real(column), digits);
    default:
      return text_cell(std::string(row.text(column)));
  }
}

std::string name_of(const RunRecord& r) {
  return fmt::format("{}{}/{}/{}", r.problem, r.dataset.empty() ? "" : "@" + r.dataset, r.label,
                     r.repetition);
}

bool is_same_file(const std::string& one, const std::string& other) {
  std::error_code e;
  return fs::equivalent(one, other, e);
}

}  // namespace

std::vector<Table> store_tables(const std::string& store) {
  RecordStore records(store);
  Table campaigns{"campaigns",
                  fmt::format("Campaigns in {} (schema {})", store, kStoreSchemaVersion),
                  {text_column("campaign"), text_column("plan"), text_column("shard"), number_column("cells"),
                   number_column("records"), number_column("former", "of former plans"),
                   text_column("time_utc", "begun or continued")},
                  {},
                  {}};
  SqliteStatement count(records.database(),
                        "SELECT count(*),total(current=0) FROM cells WHERE campaign IS ?1");
  for (const StoredCampaign& c : records.campaigns()) {
    count.bind(1, c.name).step();
    campaigns.rows.push_back({text_cell(c.name), text_cell(c.plan.substr(0, 12)), text_cell(c.shard),
                              whole_cell(c.cells), whole_cell(count.integer(0) - count.integer(1)),
                              whole_cell(count.integer(1)), text_cell(c.time_utc)});
    count.step();
  }
  if (const std::int64_t others = records.count("campaign IS NULL"); others > 0)
    campaigns.notes.push_back(fmt::format("{} records of no campaign", others));
  Table table{"store",
              "Current records",
              {text_column("problem"), text_column("label"), number_column("records"),
               number_column("failed"), number_column("lowest", "lowest J"),
               number_column("evaluations", "mean evaluations"), number_column("seconds", "seconds", "s")},
              {},
              {}};
  SqliteStatement groups(
      records.database(),
      "SELECT problem||iif(dataset='','','@'||dataset) AS name,label,count(*),sum(termination='failed'),"
      "min(cost),avg(evaluations),total(seconds) FROM cells WHERE current=1 GROUP BY name,label "
      "ORDER BY min(place)");
  while (groups.step()) {
    std::vector<Cell> row;
    for (int c = 0; c < groups.columns(); ++c) row.push_back(cell_of(groups, c));
    table.rows.push_back(std::move(row));
  }
  return {campaigns, table};
}

Table query_table(const std::string& store, const std::string& sql) {
  RecordStore records(store);
  records.database().read_only();
  SqliteStatement statement(records.database(), sql);
  Table table{"query", "Query", {}, {}, {}};
  for (int c = 0; c < statement.columns(); ++c) table.columns.push_back(text_column(statement.name(c)));
  while (statement.step()) {
    std::vector<Cell> row;
    for (int c = 0; c < statement.columns(); ++c) {
      row.push_back(cell_of(statement, c));
      if (row.back().value) table.columns[static_cast<std::size_t>(c)].align = Align::Right;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::int64_t export_lines(const std::string& store, const std::string& pattern, bool all,
                          const std::function<void(std::string_view)>& take) {
  RecordStore records(store);
  std::int64_t count = 0;
  records.for_each(all, [&](const StoredRecord& stored) {
    if (!pattern.empty()) {
      const std::string name = name_of(record_from(JsonNode::parse_line(stored.line, store, 1)));
      if (name != pattern && ::fnmatch(pattern.c_str(), name.c_str(), 0) != 0) return true;
    }
    ++count;
    take(stored.line + "\n");
    return true;
  });
  return count;
}

std::vector<StoreImport> import_records(const std::string& store, const std::vector<std::string>& sources,
                                        bool same_campaign, std::chrono::milliseconds patience,
                                        Watcher& watcher, const Stop& stop) {
  for (const std::string& source : sources) {
    if (!fs::exists(source)) throw DataError(fmt::format("{}: there is no such file", shown_path(source)));
    if (is_same_file(store, source))
      throw std::invalid_argument(fmt::format("{}: found the store itself, expected others", shown(source)));
  }
  watcher.results_begin();
  const std::unique_ptr<RecordStore> opened = open_to_write(store, patience, stop);
  RecordStore& target = *opened;
  std::vector<StoreImport> imports;
  for (const std::string& source : sources) {
    stop.check();
    const fs::path file = fs::is_directory(source) ? fs::path(source) / "runs.jsonl" : fs::path(source);
    if (is_record_store(file)) {
      RecordStore from(file);
      imports.push_back({source, target.import(from, same_campaign)});
    } else {
      imports.push_back({source, target.import(read_records(file.string()))});
    }
    const ImportCount& count = imports.back().count;
    if (count.differing > 0)
      watcher.warn(
          fmt::format("{}: {} runs are in {} with another result, which stays (a limit of time, another "
                      "processor, or a program changed without a commit)",
                      shown(source), count.differing, shown(store)));
  }
  return imports;
}

}  // namespace odobench
