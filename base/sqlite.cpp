#include "base/sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

constexpr int kPatience_ms = 30'000;  // for a reader in the middle of a checkpoint

// "file:PATH?immutable=1": no locks, no -wal, no -shm.
std::string immutable_uri(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    if (c == '?' || c == '#' || c == '%')
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return uri + "?immutable=1";
}

int allow_reading(void*, int action, const char*, const char* value, const char*, const char*) {
  if (action == SQLITE_SELECT || action == SQLITE_READ || action == SQLITE_FUNCTION ||
      action == SQLITE_RECURSIVE)
    return SQLITE_OK;
  return action == SQLITE_PRAGMA && value == nullptr ? SQLITE_OK : SQLITE_DENY;
}

}  // namespace

SqliteDatabase::SqliteDatabase(std::filesystem::path file, Access access) : file_(std::move(file)) {
  const int mode = (access == Access::Read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE) |
                   SQLITE_OPEN_FULLMUTEX | SQLITE_OPEN_EXRESCODE;
  const auto look = [this] {  // needs what readers of the log beside the file need
    return sqlite3_exec(handle_, "PRAGMA schema_version", nullptr, nullptr, nullptr);
  };
  int result = sqlite3_open_v2(file_.c_str(), &handle_, mode, nullptr);
  if (result == SQLITE_OK) {
    sqlite3_busy_timeout(handle_, kPatience_ms);
    result = look();
  }
  if (access == Access::Read && ((result & 0xff) == SQLITE_CANTOPEN || (result & 0xff) == SQLITE_READONLY)) {
    sqlite3_close_v2(std::exchange(handle_, nullptr));
    result = sqlite3_open_v2(immutable_uri(file_).c_str(), &handle_, mode | SQLITE_OPEN_URI, nullptr);
    if (result == SQLITE_OK) result = look();
  }
  if (result == SQLITE_OK) return;
  const std::string reason = handle_ == nullptr ? "no memory is left" : sqlite3_errmsg(handle_);
  sqlite3_close_v2(handle_);
  throw DataError(fmt::format("{}: {}", shown_path(file_), shown(reason)));
}

SqliteDatabase::~SqliteDatabase() {
  sqlite3_close_v2(handle_);
}

void SqliteDatabase::fail() const {
  throw DataError(fmt::format("{}: {}", shown_path(file_), shown(sqlite3_errmsg(handle_))));
}

void SqliteDatabase::run(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t SqliteDatabase::number(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

void SqliteDatabase::read_only() {
  sqlite3_set_authorizer(handle_, allow_reading, nullptr);
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, std::string_view sql) : database_(database) {
  const char* rest = nullptr;
  const int result =
      sqlite3_prepare_v2(database.handle_, sql.data(), static_cast<int>(sql.size()), &handle_, &rest);
  const auto refuse = [&](const std::string& what) {
    sqlite3_finalize(handle_);
    throw std::invalid_argument(fmt::format("SQL: {}", shown(what)));
  };
  if ((result & 0xff) == SQLITE_AUTH)
    refuse(fmt::format("{}: expected a statement that only reads", sqlite3_errmsg(database.handle_)));
  if ((result & 0xff) == SQLITE_ERROR) refuse(sqlite3_errmsg(database.handle_));
  if (result != SQLITE_OK) {
    sqlite3_finalize(handle_);
    database.fail();
  }
  if (handle_ == nullptr) refuse("found no statement, expected one");
  const std::string_view left(rest, static_cast<std::size_t>(sql.data() + sql.size() - rest));
  if (left.find_first_not_of(" \t\r\n;") != std::string_view::npos)
    refuse(fmt::format("found '{}' behind the statement, expected one statement", left));
}

SqliteStatement::~SqliteStatement() {
  sqlite3_finalize(handle_);
}

SqliteStatement& SqliteStatement::bind(int parameter, std::string_view text) {
  if (sqlite3_bind_text64(handle_, parameter, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8) !=
      SQLITE_OK)
    database_.fail();
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::int64_t value) {
  if (sqlite3_bind_int64(handle_, parameter, value) != SQLITE_OK) database_.fail();
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, double value) {
  const int result = std::isfinite(value) ? sqlite3_bind_double(handle_, parameter, value)
                                          : sqlite3_bind_null(handle_, parameter);
  if (result != SQLITE_OK) database_.fail();
  return *this;
}

bool SqliteStatement::step() {
  const int result = sqlite3_step(handle_);
  if (result == SQLITE_ROW) return true;
  if (result != SQLITE_DONE) {
    const std::string reason = sqlite3_errmsg(database_.handle_);
    sqlite3_reset(handle_);
    throw DataError(fmt::format("{}: {}", shown_path(database_.file()), shown(reason)));
  }
  sqlite3_reset(handle_);
  return false;
}

int SqliteStatement::columns() const {
  return sqlite3_column_count(handle_);
}

std::string SqliteStatement::name(int column) const {
  return sqlite3_column_name(handle_, column);
}

SqliteStatement::Kind SqliteStatement::kind(int column) const {
  switch (sqlite3_column_type(handle_, column)) {
    case SQLITE_NULL:
      return Kind::Null;
    case SQLITE_INTEGER:
      return Kind::Integer;
    case SQLITE_FLOAT:
      return Kind::Real;
    default:
      return Kind::Text;
  }
}

std::string_view SqliteStatement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return {bytes == nullptr ? "" : bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(handle_, column);
}

double SqliteStatement::real(int column) const {
  return sqlite3_column_double(handle_, column);
}

SqliteTransaction::SqliteTransaction(SqliteDatabase& database) : database_(database) {
  database_.run("BEGIN IMMEDIATE");
}

SqliteTransaction::~SqliteTransaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const DataError&) {  // a full disc has ended it already
  }
}

void SqliteTransaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

bool is_sqlite_file(const std::filesystem::path& file) {
  constexpr std::string_view magic("SQLite format 3\0", 16);
  std::error_code e;
  if (!std::filesystem::is_regular_file(file, e)) return false;
  char begin[16] = {};
  std::ifstream in(file, std::ios::binary);
  return in.read(begin, sizeof begin) && std::string_view(begin, sizeof begin) == magic;
}

}  // namespace odobench
