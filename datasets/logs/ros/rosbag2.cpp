// rosbag2's SQLite files (.db3), also compressed as a whole (.db3.zstd) or message by message. Opened so that
// nothing is written beside them, and with the limits that SQLite has for files of strangers.
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdlib>
#include <unordered_map>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/ros/containers.hpp"
#include "datasets/logs/ros/decompress.hpp"
#include "datasets/logs/ros/log_input.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr int kStepsBetweenLooks = 10000;  // of SQLite's machine, until it asks whether to stop

// A database and a statement that are closed on every way out.
struct CloseDatabase {
  void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
};
struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

// "file:PATH?mode=ro&immutable=1": no locks, no -wal, no -shm, no journal rolled back.
std::string immutable_uri(const fs::path& file) {
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    if (c == '?' || c == '#' || c == '%')
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return uri + "?mode=ro&immutable=1";
}

int stop_requested(void* stop) {
  return static_cast<const Stop*>(stop)->requested() ? 1 : 0;
}

// A file of the temporary folder whose name goes with this object.
class ScratchFile {
 public:
  ScratchFile() : path_((fs::temp_directory_path() / "odobench-log-XXXXXX").string()) {
    descriptor_ = ::mkstemp(path_.data());
    if (descriptor_ < 0) fail();
  }
  ~ScratchFile() {
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail();
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  fs::path path() const { return path_; }

 private:
  [[noreturn]] void fail() const {
    throw DataError(fmt::format("{}: cannot be written: {}", shown_path(path_),
                                std::error_code(errno, std::generic_category()).message()));
  }
  std::string path_;
  int descriptor_ = -1;
};

class Rosbag2Walk {
 public:
  Rosbag2Walk(const fs::path& file, const LogOptions& options, RosSink& sink, const Stop& stop)
      : file_(file), options_(options), sink_(sink), stop_(stop), decompressed_(file, options.max_bytes) {}

  void run() {
    open();
    warn_of_wal();
    read_definitions();
    read_topics();
    read_messages();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(fmt::format("{}: {}", shown_path(file_), what));
  }
  [[noreturn]] void fail_sqlite() {
    stop_.check();
    fail(fmt::format("SQLite: {}", shown(sqlite3_errmsg(db_.get()))));
  }
  void open();
  void connect(const fs::path& file);
  void warn_of_wal();
  bool has_table(const char* name);  // refuses views
  Statement prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail_sqlite();
    return Statement(statement);
  }
  bool step(const Statement& statement) {
    const int result = sqlite3_step(statement.get());
    if (result == SQLITE_ROW) return true;
    if (result != SQLITE_DONE) fail_sqlite();
    return false;
  }
  static std::string_view blob(const Statement& statement, int column) {
    const void* bytes = sqlite3_column_blob(statement.get(), column);
    const int size = sqlite3_column_bytes(statement.get(), column);
    return {static_cast<const char*>(bytes), bytes == nullptr ? 0 : static_cast<std::size_t>(size)};
  }
  void read_definitions();
  void read_topics();
  void read_messages();
  std::string_view decompress(std::string_view data, std::int64_t row);

  const fs::path& file_;
  const LogOptions& options_;
  RosSink& sink_;
  const Stop& stop_;
  DecompressedBytes decompressed_;
  Decompressor decompressor_;
  Database db_;
  struct Definition {
    std::string encoding;
    std::shared_ptr<const std::string> text;
  };
  std::unordered_map<std::string, Definition> definitions_;  // by type
  std::unordered_map<std::int64_t, int> channels_;           // by topic_id
};

void Rosbag2Walk::open() {
  LogInput input(file_);
  if (is_sqlite(input.take_some(kSqliteMagic.size()))) return connect(file_);
  ScratchFile scratch;
  input.seek(0);
  try {
    decompressor_.zstd_stream(
        [&] {
          stop_.check();
          return input.take_some(kLargestLogRecord);
        },
        [&](std::string_view bytes) {
          decompressed_.add(bytes.size());
          scratch.write(bytes);
        });
  } catch (const BadCompression& e) {
    fail_at(file_, input.position(), e.what());
  }
  connect(scratch.path());
}

void Rosbag2Walk::connect(const fs::path& file) {
  sqlite3* db = nullptr;
  const int opened =
      sqlite3_open_v2(immutable_uri(file).c_str(), &db, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  db_.reset(db);
  if (opened != SQLITE_OK) fail_sqlite();
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestLogRecord));
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_progress_handler(db, kStepsBetweenLooks, stop_requested, const_cast<Stop*>(&stop_));
}

void Rosbag2Walk::warn_of_wal() {
  fs::path wal = file_;
  wal += "-wal";
  std::error_code error;
  const auto size = fs::file_size(wal, error);
  if (!error && size > 0)
    sink_.notes.push_back(
        fmt::format("{}: its messages are missing here: open the recording once with the "
                    "recorder's program (ros2 bag info) to bring them in",
                    shown_path(wal)));
}

bool Rosbag2Walk::has_table(const char* name) {
  const Statement look = prepare(
      "SELECT CASE WHEN sql LIKE 'CREATE VIRTUAL%' THEN 'virtual table' ELSE type END FROM sqlite_schema "
      "WHERE name = ?1");
  sqlite3_bind_text(look.get(), 1, name, -1, SQLITE_STATIC);
  if (!step(look)) return false;
  if (blob(look, 0) != "table")
    fail(fmt::format("'{}' is a {}, expected a table", name, shown(blob(look, 0))));
  return true;
}

void Rosbag2Walk::read_definitions() {
  if (!has_table("message_definitions")) return;
  const Statement rows =
      prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (step(rows)) {
    if (definitions_.size() >= kMostLogChannels)
      fail(fmt::format("more than {} definitions", kMostLogChannels));
    definitions_[std::string(blob(rows, 0))] = {std::string(blob(rows, 1)), definition_text(blob(rows, 2))};
  }
}

void Rosbag2Walk::read_topics() {
  if (!has_table("topics") || !has_table("messages"))
    fail("found other tables, expected rosbag2's topics and messages");
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  while (step(rows)) {
    if (channels_.size() >= kMostLogChannels) fail(fmt::format("more than {} topics", kMostLogChannels));
    RosChannel channel;
    channel.topic = blob(rows, 1);
    channel.type = blob(rows, 2);
    if (blob(rows, 3) != "cdr")
      channel.unreadable = fmt::format("messages are serialised as '{}', expected cdr: `ros2 bag convert`",
                                       shown(blob(rows, 3)));
    const auto found = definitions_.find(channel.type);
    if (found != definitions_.end() && found->second.encoding == "ros2msg" && !found->second.text->empty())
      channel.definition = found->second.text;
    else if (found != definitions_.end() && found->second.encoding != "ros2msg")
      channel.unreadable =
          fmt::format("its definition is written in '{}', expected ros2msg", shown(found->second.encoding));
    channels_[sqlite3_column_int64(rows.get(), 0)] = sink_.channel(channel);
  }
}

void Rosbag2Walk::read_messages() {
  // The filter stands in the statement so that SQLite leaves the data of other topics unread.
  std::string wanted;
  bool all = true;
  for (const auto& [id, channel] : channels_) {
    if (channel >= 0)
      wanted += fmt::format("{}{}", wanted.empty() ? "" : ",", id);
    else
      all = false;
  }
  if (wanted.empty()) return;
  const std::string where = all ? "" : fmt::format(" WHERE topic_id IN ({})", wanted);
  const Statement rows =
      prepare("SELECT id, topic_id, timestamp, data FROM messages" + where + " ORDER BY id");
  for (;;) {
    const int result = sqlite3_step(rows.get());
    if (result == SQLITE_DONE) return;
    stop_.check();
    if (result != SQLITE_ROW && options_.keep_cut && result == SQLITE_CORRUPT) {
      sink_.notes.push_back(
          fmt::format("{}: damaged behind {} messages, which are kept", shown_path(file_), sink_.seen));
      return;
    }
    if (result != SQLITE_ROW)
      fail(fmt::format("SQLite: {} (behind {} messages; --keep-cut imports these)",
                       shown(sqlite3_errmsg(db_.get())), sink_.seen));
    ++sink_.seen;
    const auto channel = channels_.find(sqlite3_column_int64(rows.get(), 1));
    if (channel == channels_.end() || channel->second < 0) continue;
    const std::int64_t row = sqlite3_column_int64(rows.get(), 0);
    std::string_view data = blob(rows, 3);
    if (is_zstd(data)) data = decompress(data, row);
    sink_.message(channel->second, sqlite3_column_int64(rows.get(), 2), data,
                  {&file_, static_cast<std::uint64_t>(row), true});
  }
}

std::string_view Rosbag2Walk::decompress(std::string_view data, std::int64_t row) {
  try {
    decompressor_.begin(LogCompression::Zstd, zstd_size(data));
    decompressor_.put(data);
    const std::string_view message = decompressor_.end();
    decompressed_.add(message.size());
    return message;
  } catch (const BadCompression& e) {
    fail(fmt::format("message {}: {}", row, e.what()));
  }
}

class Rosbag2 : public RosContainer {
 public:
  Rosbag2(const fs::path& file, const LogOptions& options) : file_(file), options_(options) {}
  const char* format() const override { return "rosbag2 (sqlite3)"; }
  const fs::path& file() const override { return file_; }
  void walk(RosSink& sink, const Stop& stop) const override {
    Rosbag2Walk(file_, options_, sink, stop).run();
  }

 private:
  fs::path file_;
  LogOptions options_;
};

}  // namespace

bool is_sqlite(std::string_view head) {
  return head.substr(0, kSqliteMagic.size()) == kSqliteMagic;
}

std::unique_ptr<RosContainer> open_rosbag2(const fs::path& file, const LogOptions& options) {
  return std::make_unique<Rosbag2>(file, options);
}

}  // namespace odobench
