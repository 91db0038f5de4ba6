// Which column of a file holds what: canonical names with units ("enc1_m"), or the names a mapping gives
// instead.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/csv/csv_row.hpp"

namespace odobench {

// Canonical name -> name in the file; "none": the column is not to be used although it is there.
using ColumnMapping = std::map<std::string, std::string>;
inline constexpr const char* kNoColumn = "none";

class ColumnFinder {
 public:
  // `known`: every canonical name, so that a column of one is not suggested for another. All outlive the
  // finder.
  ColumnFinder(const CsvRow& row, const ColumnMapping& mapping, const std::vector<std::string>& known)
      : row_(row), mapping_(mapping), known_(known) {}

  // The column of this canonical name; nothing when the file has none. DataError when it has two, and when
  // the mapping names a column that is not there.
  std::optional<std::size_t> find(const std::string& name) const;
  // The first of several spellings that is there.
  std::optional<std::size_t> find_any(const std::vector<std::string>& names) const;
  // DataError naming the (first) name and the column nearest to it.
  std::size_t require(const std::string& name) const;
  std::size_t require_any(const std::vector<std::string>& names) const;

 private:
  [[noreturn]] void missing(const std::string& name, const std::string& purpose) const;

  const CsvRow& row_;
  const ColumnMapping& mapping_;
  const std::vector<std::string>& known_;
};

}  // namespace odobench
