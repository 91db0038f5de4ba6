#include "reports/records/record_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "reports/records/record_key.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kApplication = 0x4f444f42;  // "ODOB", in the header of the file

constexpr const char* kSchema = R"(
CREATE TABLE campaigns(name TEXT PRIMARY KEY, plan TEXT NOT NULL, cells INTEGER NOT NULL, shard TEXT NOT NULL,
  definition TEXT NOT NULL, time_utc TEXT NOT NULL);
CREATE TABLE cells(key TEXT PRIMARY KEY, campaign TEXT, place INTEGER NOT NULL, current INTEGER NOT NULL,
  problem TEXT NOT NULL, dataset TEXT NOT NULL, label TEXT NOT NULL, solver TEXT NOT NULL, polish TEXT NOT NULL,
  repetition INTEGER NOT NULL, seed TEXT NOT NULL, kind TEXT NOT NULL, termination TEXT NOT NULL, cost REAL,
  evaluations INTEGER NOT NULL, seconds REAL, time_utc TEXT NOT NULL, result TEXT NOT NULL,
  check_sum TEXT NOT NULL, record TEXT NOT NULL);
CREATE INDEX in_order ON cells(campaign,place,key);
)";

constexpr const char* kInsert =
    "INSERT OR REPLACE INTO cells VALUES(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,?15,?16,?17,?18,?19,"
    "?20)";

bool is_interrupted(const RunRecord& record) {
  return record.termination == "interrupted";
}

std::string brief(const std::string& check_sum) {
  return check_sum.substr(0, 12);
}

}  // namespace

RecordStore::RecordStore(const fs::path& file, Access access) : file_(file) {
  try {
    if (access == Access::Write)
      lock();
    else if (!is_record_store(file_))
      throw DataError(fmt::format("{}: found no store of records, expected the SQLite file of a campaign",
                                  shown_path(file_)));
    open_schema(access);
  } catch (...) {
    database_.reset();
    if (made_) ::unlink(file_.c_str());
    if (lock_ >= 0) ::close(lock_);
    throw;
  }
}

RecordStore::~RecordStore() {
  insert_.reset();
  result_.reset();
  if (lock_ >= 0) try {  // one file again: readers of a log would leave an empty one beside it
      database_->run("PRAGMA busy_timeout=0");
      database_->run("PRAGMA journal_mode=DELETE");
    } catch (const DataError&) {  // somebody reads, or the disc is full: the log stays, and is whole
    }
  database_.reset();
  if (log_ >= 0) ::close(log_);
  if (lock_ >= 0) ::close(lock_);  // after SQLite, whose own locks on the file end when any descriptor closes
}

void RecordStore::lock() {
  require_replaceable(file_);
  constexpr int mode = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  lock_ = ::open(file_.c_str(), mode);
  if (lock_ < 0 && errno == ENOENT) {
    std::error_code e;
    if (file_.has_parent_path()) fs::create_directories(file_.parent_path(), e);
    lock_ = ::open(file_.c_str(), mode | O_CREAT | O_EXCL, 0666);
    made_ = lock_ >= 0;
    if (lock_ < 0 && errno == EEXIST) lock_ = ::open(file_.c_str(), mode);  // another process was quicker
  }
  if (lock_ < 0)
    throw std::invalid_argument(fmt::format("{}: cannot be written: {}", shown_path(file_),
                                            std::error_code(errno, std::generic_category()).message()));
  try {
    lock_place(lock_, file_, std::chrono::milliseconds(0));
  } catch (const std::invalid_argument& e) {
    throw StoreIsBusy(e.what());
  }
  if (::lseek(lock_, 0, SEEK_END) > 0) made_ = false;  // by the one that it waited for
}

void RecordStore::open_schema(Access access) {
  const bool writes = access == Access::Write;
  char first = 0;
  if (writes && ::pread(lock_, &first, 1, 0) == 1 && first != 'S')
    throw std::invalid_argument(
        fmt::format("{}: it exists and is no store of records; choose another name", shown_path(file_)));
  database_ = std::make_unique<SqliteDatabase>(
      file_, writes ? SqliteDatabase::Access::Write : SqliteDatabase::Access::Read);
  const std::int64_t application = database_->number("PRAGMA application_id");
  const std::int64_t version = database_->number("PRAGMA user_version");
  const bool empty = database_->number("SELECT count(*) FROM sqlite_schema") == 0;
  if (!writes && empty)
    throw DataError(fmt::format("{}: found an empty store, expected records: it was ended before they came",
                                shown_path(file_)));
  if (!empty && application != kApplication)
    throw DataError(fmt::format("{}: found an SQLite file of another program, expected a store of records",
                                shown_path(file_)));
  if (version > kStoreSchemaVersion)
    throw DataError(
        fmt::format("{}: found a store of schema {}, expected at most {}: it was written by a newer version "
                    "of this program",
                    shown_path(file_), version, kStoreSchemaVersion));
  if (!writes) return;
  if (empty) {
    database_->run("PRAGMA journal_mode=WAL");
    database_->run(fmt::format("BEGIN IMMEDIATE;{}PRAGMA application_id={};PRAGMA user_version={};COMMIT",
                               kSchema, kApplication, kStoreSchemaVersion));
  }
  database_->run("PRAGMA journal_mode=WAL");
  database_->run("PRAGMA synchronous=NORMAL");  // the log is synced by sync(), many records at a time
  insert_ = std::make_unique<SqliteStatement>(*database_, kInsert);
  result_ =
      std::make_unique<SqliteStatement>(*database_, "SELECT result,termination FROM cells WHERE key=?1");
}

std::vector<StoredCampaign> RecordStore::campaigns() {
  std::vector<StoredCampaign> list;
  SqliteStatement select(
      *database_, "SELECT name,plan,shard,definition,cells,time_utc FROM campaigns ORDER BY time_utc,name");
  while (select.step())
    list.push_back({std::string(select.text(0)), std::string(select.text(1)), std::string(select.text(2)),
                    std::string(select.text(3)), select.integer(4), std::string(select.text(5))});
  return list;
}

std::unordered_set<std::string> RecordStore::keys() {
  std::unordered_set<std::string> keys;
  SqliteStatement select(*database_, "SELECT key FROM cells");
  while (select.step()) keys.emplace(select.text(0));
  return keys;
}

std::int64_t RecordStore::count(const std::string& condition) {
  return database_->number("SELECT count(*) FROM cells WHERE " + condition);
}

void RecordStore::for_each(bool all, const std::function<bool(const StoredRecord&)>& take) {
  SqliteStatement select(*database_,
                         fmt::format("SELECT key,campaign,place,current,check_sum,record FROM cells {} "
                                     "ORDER BY campaign,place,key",
                                     all ? "" : "WHERE current=1"));
  while (select.step()) {
    StoredRecord stored{std::string(select.text(0)), std::string(select.text(1)), select.integer(2),
                        select.integer(3) != 0, std::string(select.text(5))};
    if (sha256(stored.line) != select.text(4))
      throw DataError(
          fmt::format("{}: found a record of the cell {} that is not what its check sum says, "
                      "expected it as it was written",
                      shown_path(file_), brief(stored.key)));
    if (!take(stored)) return;
  }
}

void RecordStore::begin_campaign(const StoredCampaign& campaign, const std::vector<std::string>& keys) {
  for (const StoredCampaign& there : campaigns()) {
    const auto called = [](const StoredCampaign& c) {
      return fmt::format("{}campaign '{}'", c.shard.empty() ? "" : "shard " + c.shard + " of ",
                         shown(c.name));
    };
    if (there.name != campaign.name || (!there.shard.empty() && there.shard != campaign.shard))
      throw std::invalid_argument(fmt::format("{}: found {}, expected {}: a store of its own for each",
                                              shown_path(file_), called(there), called(campaign)));
  }
  const std::lock_guard lock(mutex_);
  SqliteTransaction transaction(*database_);
  // A shard in a store of the whole campaign leaves it that.
  SqliteStatement(*database_,
                  "INSERT INTO campaigns VALUES(?1,?2,?3,?4,?5,?6) ON CONFLICT(name) DO UPDATE SET "
                  "plan=?2,cells=?3,definition=?5,time_utc=?6")
      .bind(1, campaign.name)
      .bind(2, campaign.plan)
      .bind(3, campaign.cells)
      .bind(4, campaign.shard)
      .bind(5, campaign.definition)
      .bind(6, campaign.time_utc)
      .step();
  SqliteStatement(*database_, "UPDATE cells SET current=0 WHERE campaign=?1").bind(1, campaign.name).step();
  SqliteStatement place(*database_, "UPDATE cells SET current=1,campaign=?1,place=?2 WHERE key=?3");
  for (std::size_t i = 0; i < keys.size(); ++i)
    place.bind(1, campaign.name).bind(2, static_cast<std::int64_t>(i)).bind(3, keys[i]).step();
  transaction.commit();
}

void RecordStore::put(const std::string& key, const std::string& campaign, std::int64_t place, bool current,
                      const RunRecord& r, const std::string& line) {
  SqliteStatement& s = *insert_;
  s.bind(1, key).bind(3, place).bind(4, std::int64_t{current});
  if (campaign.empty())
    s.bind(2, std::numeric_limits<double>::quiet_NaN());
  else
    s.bind(2, campaign);
  s.bind(5, r.problem).bind(6, r.dataset).bind(7, r.label).bind(8, r.solver).bind(9, r.polish);
  s.bind(10, std::int64_t{r.repetition}).bind(11, std::to_string(r.seed)).bind(12, r.kind);
  s.bind(13, r.termination).bind(14, r.cost.value_or(std::numeric_limits<double>::quiet_NaN()));
  s.bind(15, r.evaluations).bind(16, r.seconds).bind(17, r.time_utc).bind(18, result_check_sum(r));
  s.bind(19, sha256(line)).bind(20, line);
  s.step();
}

void RecordStore::append(const std::string& key, const std::string& campaign, std::int64_t place,
                         const RunRecord& record) {
  const std::string line = to_json_line(record);
  const std::lock_guard lock(mutex_);
  put(key, campaign, place, true, record, line);
}

void RecordStore::sync() {
  {
    const std::lock_guard lock(mutex_);
    if (log_ < 0) log_ = ::open((file_.string() + "-wal").c_str(), O_RDONLY | O_CLOEXEC);
  }
  if (log_ >= 0 && ::fdatasync(log_) != 0)
    throw DataError(fmt::format("{}: cannot be written: {}", shown_path(file_),
                                std::error_code(errno, std::generic_category()).message()));
}

void RecordStore::take(const StoredRecord& stored, const RunRecord& record, ImportCount& count) {
  if (is_interrupted(record)) {
    ++count.interrupted;
    return;
  }
  result_->bind(1, stored.key);
  if (result_->step()) {
    const bool same = result_->text(0) == result_check_sum(record);
    const bool mended = result_->text(1) == "failed" && record.termination != "failed";
    while (result_->step()) {
    }
    if (!mended) {
      ++count.known;
      count.differing += same ? 0 : 1;
      return;
    }
  }
  put(stored.key, stored.campaign, stored.place, stored.current, record, stored.line);
  ++count.taken;
}

ImportCount RecordStore::import(const std::vector<RunRecord>& records) {
  const std::lock_guard lock(mutex_);
  ImportCount count;
  SqliteTransaction transaction(*database_);
  std::int64_t place = database_->number("SELECT coalesce(max(place),0) FROM cells WHERE campaign IS NULL");
  for (const RunRecord& record : records)
    take({record_key(record), "", ++place, true, to_json_line(record)}, record, count);
  transaction.commit();
  return count;
}

ImportCount RecordStore::import(RecordStore& source, bool same_campaign) {
  const std::lock_guard lock(mutex_);
  std::vector<StoredCampaign> mine = campaigns();
  SqliteTransaction transaction(*database_);
  for (StoredCampaign& other : source.campaigns()) {
    const auto is = [&](const StoredCampaign& c) { return c.name == other.name && c.plan == other.plan; };
    const bool known = std::any_of(mine.begin(), mine.end(), is);
    if (same_campaign && !known && !mine.empty())
      throw std::invalid_argument(
          fmt::format("{}: found campaign '{}' of plan {}, expected '{}' of plan {} (other cells, options, "
                      "data, program or kernel make another plan)",
                      shown_path(source.file()), shown(other.name), brief(other.plan),
                      shown(mine.front().name), brief(mine.front().plan)));
    if (same_campaign && mine.empty()) mine.push_back(other);
    SqliteStatement(*database_, "INSERT OR IGNORE INTO campaigns VALUES(?1,?2,?3,'',?4,?5)")
        .bind(1, other.name)
        .bind(2, other.plan)
        .bind(3, other.cells)
        .bind(4, other.definition)
        .bind(5, other.time_utc)
        .step();
  }
  ImportCount count;
  source.for_each(true, [&](const StoredRecord& stored) {
    const RunRecord record = record_from(JsonNode::parse_line(stored.line, source.file(), 1));
    if (record_key(record) != stored.key)
      throw DataError(fmt::format("{}: found a record under the key {}, expected it under its own, {}",
                                  shown_path(source.file()), brief(stored.key), brief(record_key(record))));
    if (same_campaign && !stored.current) return true;
    take(stored, record, count);
    return true;
  });
  transaction.commit();
  return count;
}

std::unique_ptr<RecordStore> open_to_write(const fs::path& file, std::chrono::milliseconds patience,
                                           const Stop& stop) {
  constexpr std::chrono::milliseconds pause{20};
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;; std::this_thread::sleep_for(pause)) {
    stop.check();
    try {
      return std::make_unique<RecordStore>(file, RecordStore::Access::Write);
    } catch (const StoreIsBusy&) {
      if (std::chrono::steady_clock::now() >= end) throw;
    }
  }
}

bool is_record_store(const fs::path& file) {
  return is_sqlite_file(file);
}

std::vector<RunRecord> read_store(const fs::path& file) {
  RecordStore store(file);
  std::vector<RunRecord> records;
  std::size_t number = 0;
  store.for_each(false, [&](const StoredRecord& stored) {
    records.push_back(record_from(JsonNode::parse_line(stored.line, file, ++number)));
    return true;
  });
  return records;
}

}  // namespace odobench
