// SQLite's database and statement, closed on every way out. Errors are DataError "FILE: what SQLite says";
// a database or a disc that is locked, full or read-only says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace odobench {

class SqliteStatement;

class SqliteDatabase {
 public:
  enum class Access { Read, Write };

  // An existing file; with Access::Write it may be empty. Nothing is read yet. A file on a medium where
  // readers cannot leave a trace is opened as one that nobody changes.
  SqliteDatabase(std::filesystem::path file, Access access);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  const std::filesystem::path& file() const { return file_; }
  // Any number of statements without results.
  void run(const std::string& sql);
  // The first column of the first row: of a pragma or a count.
  std::int64_t number(const std::string& sql);
  // From here on only statements that read: no other file is attached, nothing written, no pragma set.
  void read_only();
  [[noreturn]] void fail() const;

 private:
  friend class SqliteStatement;
  std::filesystem::path file_;
  sqlite3* handle_ = nullptr;
};

// One statement; parameters count from 1, columns from 0.
class SqliteStatement {
 public:
  enum class Kind { Null, Integer, Real, Text };

  // Throws std::invalid_argument "SQL: ..." where `sql` is none, or is more than one statement.
  SqliteStatement(SqliteDatabase& database, std::string_view sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  // The text is copied.
  SqliteStatement& bind(int parameter, std::string_view text);
  SqliteStatement& bind(int parameter, std::int64_t value);
  SqliteStatement& bind(int parameter, double value);  // what is not finite: NULL
  // The next row, or false at the end; then the statement can be bound and run again.
  bool step();

  int columns() const;
  std::string name(int column) const;
  Kind kind(int column) const;
  // Of the row at hand; a text is valid until the next step.
  std::string_view text(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;

 private:
  SqliteDatabase& database_;
  sqlite3_stmt* handle_ = nullptr;
};

// All or nothing: what is not committed is taken back at the object's end.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDatabase& database);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit();

 private:
  SqliteDatabase& database_;
  bool open_ = true;
};

// Whether the file begins as SQLite's do.
bool is_sqlite_file(const std::filesystem::path& file);

}  // namespace odobench
