// Sources and fields that somebody asks a log for and that it does not have.
#pragma once

#include <string>
#include <vector>

#include "datasets/logs/log_file.hpp"

namespace odobench {

// Throws std::invalid_argument "no field 'lefft' in ticks.csv, did you mean 'left'? it has left, right".
// `kind`: "field" or "source".
[[noreturn]] void refuse_unknown(const std::string& kind, const std::string& name, const std::string& place,
                                 const std::vector<std::string>& known);

// Counts rows and stamps of a source as they come.
class RowTimes {
 public:
  void add(std::int64_t stamp_ns);
  // Writes first_ns, last_ns and largest_gap_ns.
  void give(LogSource& source) const;
  bool any() const { return any_; }

 private:
  bool any_ = false;
  std::int64_t first_ = 0, last_ = 0, gap_ = 0;
};

// "1 row", "1,200 rows".
std::string counted(std::int64_t count, const std::string& what);

// Most values kept of one file, over all requests.
inline constexpr std::int64_t kMostValues = 100'000'000;
// Most fields of one table, and of all sources of a file together.
inline constexpr std::size_t kMostColumns = 10'000, kMostFields = 65'536;
// DataError "FILE: more than 100,000,000 values asked for".
[[noreturn]] void refuse_too_many_values(const std::string& file);

}  // namespace odobench
