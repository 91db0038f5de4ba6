// What is in a store of records, and how records get in and out: the study behind `bench store`.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/watcher.hpp"
#include "reports/records/record_store.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Tables "campaigns" (name, plan, shard, cells, current records, when) and "store" (problem, label, records,
// failed, lowest J, evaluations, seconds).
std::vector<Table> store_tables(const std::string& store);

// One statement of SQL that only reads, over the tables of reports/records/record_store.hpp; columns are
// called as the statement calls them. Throws std::invalid_argument "SQL: ..." on any other.
Table query_table(const std::string& store, const std::string& sql);

// The lines of a store as in runs.jsonl, each with its line break. `pattern`: of PROBLEM/LABEL/REPETITION; ""
// is every one. `all`: those that their campaign no longer plans, too. Returns how many.
std::int64_t export_lines(const std::string& store, const std::string& pattern, bool all,
                          const std::function<void(std::string_view)>& take);

struct StoreImport {
  std::string source;
  ImportCount count;
};

// Stores, .jsonl files and folders with runs.jsonl into `store`, which is made where it is not there; one
// that was brought in already changes nothing. Of a source all or nothing; a warning where a run of one key
// had another result. Throws as RecordStore::import(), open_to_write() and read_records() do.
std::vector<StoreImport> import_records(const std::string& store, const std::vector<std::string>& sources,
                                        bool same_campaign, std::chrono::milliseconds patience,
                                        Watcher& watcher, const Stop& stop);

}  // namespace odobench
