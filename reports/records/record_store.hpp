// Records of runs in one SQLite file: a line of JSON each, as in runs.jsonl, found by what decides the run.
//
// Table cells: key (record_key), campaign (name, or NULL of records that were brought in from elsewhere),
// place (in the plan of its campaign), current (0: its campaign no longer plans it), problem, dataset, label,
// solver, polish, repetition, seed, kind, termination, cost, evaluations, seconds, time_utc, result
// (result_check_sum), check_sum (SHA-256 of record), record (the line). Table campaigns: name, plan (SHA-256
// of the keys of all its cells), cells, shard ("2/4", or ""), definition (the campaign file), time_utc.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "base/sqlite.hpp"
#include "base/stop.hpp"
#include "reports/records/record.hpp"

namespace odobench {

inline constexpr int kStoreSchemaVersion = 1;

struct StoredCampaign {
  std::string name;
  std::string plan;
  std::string shard;
  std::string definition;
  std::int64_t cells = 0;
  std::string time_utc;  // when it was begun or continued last
};

// A record with what the store keeps about it.
struct StoredRecord {
  std::string key, campaign;
  std::int64_t place = 0;
  bool current = true;
  std::string line;
};

// How far a source of records fits.
struct ImportCount {
  std::int64_t taken = 0, known = 0;  // known: of a key that is there already
  std::int64_t differing = 0;         // of those, with another result
  std::int64_t interrupted = 0;       // left out: of runs that did not end
};

// "FILE: process 123 is writing there".
class StoreIsBusy : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

class RecordStore {
 public:
  enum class Access { Read, Write };

  // Read: while another process writes, the state of its last finished record. Write: made where it is not
  // there; the only writer until the object's end, other processes included. Throws StoreIsBusy while
  // another process writes to it, std::invalid_argument when it cannot be written, DataError when it is no
  // such store, or one of a newer schema.
  explicit RecordStore(const std::filesystem::path& file, Access access = Access::Read);
  ~RecordStore();

  const std::filesystem::path& file() const { return file_; }
  SqliteDatabase& database() { return *database_; }

  std::vector<StoredCampaign> campaigns();
  std::unordered_set<std::string> keys();
  std::int64_t count(const std::string& condition = "1");
  // Records of no campaign first, then by campaign and place, then by key. `take` returns whether to go on.
  // All: also those that their campaign no longer plans. Throws DataError on a line that is not what its
  // check sum says.
  void for_each(bool all, const std::function<bool(const StoredRecord&)>& take);

  // The campaign goes on here with these keys, in the order of its cells: its records that are not among them
  // are no longer current. Throws std::invalid_argument when the store belongs to another campaign or shard.
  void begin_campaign(const StoredCampaign& campaign, const std::vector<std::string>& keys);

  // In the place of one of the same key. When it returns no end of the process loses it; after the next
  // sync() no end of the machine does. From any thread. Throws DataError when the disc is full or the like;
  // the store is then as it was before.
  void append(const std::string& key, const std::string& campaign, std::int64_t place,
              const RunRecord& record);
  // Waits until the disc has everything that was appended before. From any thread, beside append().
  void sync();

  // All of a source, or nothing. Of two records of one key the one that is here stays, unless its run failed
  // and the other's did not.
  ImportCount import(const std::vector<RunRecord>& records);
  // Throws DataError on a record whose key or check sum is wrong, and std::invalid_argument, with
  // `same_campaign`, on one of another campaign or plan than this store's.
  ImportCount import(RecordStore& source, bool same_campaign);

 private:
  void lock();
  void open_schema(Access access);
  void put(const std::string& key, const std::string& campaign, std::int64_t place, bool current,
           const RunRecord& record, const std::string& line);
  void take(const StoredRecord& stored, const RunRecord& record, ImportCount& count);

  const std::filesystem::path file_;
  int lock_ = -1;
  int log_ = -1;  // the log of writes beside the file, SQLite's own descriptor apart
  bool made_ = false;
  std::mutex mutex_;
  std::unique_ptr<SqliteDatabase> database_;
  std::unique_ptr<SqliteStatement> insert_, result_;
};

// A store to write to; while another process does, waits for up to `patience`. Throws what the constructor
// does, Interruption when it is to stop.
std::unique_ptr<RecordStore> open_to_write(const std::filesystem::path& file,
                                           std::chrono::milliseconds patience, const Stop& stop);

// Whether a file is a store of records, by its first bytes.
bool is_record_store(const std::filesystem::path& file);

// The current records of a store.
std::vector<RunRecord> read_store(const std::filesystem::path& file);

}  // namespace odobench
