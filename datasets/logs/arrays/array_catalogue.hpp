// What arrays a file has, which belong together, and which of them tell time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/logs/arrays/array_log.hpp"
#include "datasets/logs/log_names.hpp"

namespace odobench {

struct ArrayInfo {
  ArrayHead head;
  std::string source, field;         // "ticks", "count"
  std::vector<std::string> first;    // the first row
  std::vector<std::string> samples;  // of a vector: its first numbers
  // Of a vector: first, last and largest step of its numbers, as they are.
  bool whole = false;
  std::int64_t first_whole = 0, last_whole = 0, largest_whole = 0;
  double first_real = 0, last_real = 0, largest_real = 0;
};

// "count[1]", "t"; an array without a name has "#2".
std::string field_path(const ArrayInfo& array, std::size_t column);

class ArrayCatalogue : public ArrayVisitor {
 public:
  // `file`: its name, in messages.
  explicit ArrayCatalogue(std::string file) : file_(std::move(file)) {}

  bool begin(const ArrayHead& head) override;
  void numbers(const std::int64_t* whole, const double* real, std::size_t count) override;

  void skip(const std::string& name, const std::string& reason) override;

  // After the walk: sources and fields of all arrays. DataError with the reason where none can be read.
  void group(ArrayGrouping grouping);
  const std::vector<ArrayInfo>& arrays() const { return arrays_; }
  const std::vector<std::pair<std::string, std::string>>& skipped() const { return skipped_; }
  std::vector<std::string> sources() const;
  std::vector<std::string> fields(const std::string& source) const;
  // The array that tells this source's time, and its unit.
  std::optional<std::size_t> time(const std::string& source, std::string& unit) const;
  LogSource describe(const std::string& source) const;

 private:
  std::string file_;
  std::vector<ArrayInfo> arrays_;
  std::vector<std::pair<std::string, std::string>> skipped_;  // name, reason
  std::size_t taken_ = 0;                                     // numbers of the last array
  std::size_t fields_ = 0;
};

}  // namespace odobench
