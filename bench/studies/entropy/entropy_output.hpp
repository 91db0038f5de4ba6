// The CSV file that `bench filter` writes: the columns of the thesis' program (T. Stirblys, Kaunas 2015,
// Appendix 3), then what it keeps to itself, a row per window. docs/entropy_filter.md lists them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/files.hpp"
#include "problems/entropy/sliding_filter.hpp"

namespace odobench {

// Where text goes that is for standard output.
using TextSink = std::function<void(const std::string& text)>;

// Rows go to a temporary file beside the target piece by piece; commit() gives it its name. Without commit()
// nothing remains.
class FilterOutputFile {
 public:
  // `file`: "-" is standard output, which is handed the rows as they come; it may be empty for other files.
  // `rotation_sign`: of the output's rotation against the model's.
  FilterOutputFile(const std::filesystem::path& file, Existing existing, TextSink standard_output,
                   int samples, bool with_time, double rotation_sign);
  void add(const FilterOutput& output, double time_s);
  void commit();

 private:
  void put(double value);
  void put(std::int64_t value);

  void flush();

  const bool to_standard_output_;
  const TextSink standard_output_;
  FileTransaction transaction_;
  std::string buffer_;
  bool with_time_;
  double rotation_sign_;
};

}  // namespace odobench
