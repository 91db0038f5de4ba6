// The CSV file that `bench filter` writes: the columns of the thesis' program (T. Stirblys, Kaunas 2015,
// Appendix 3), then what it keeps to itself, a row per window. docs/entropy_filter.md lists them.
#pragma once

#include <filesystem>
#include <string>

#include "base/files.hpp"
#include "problems/entropy/sliding_filter.hpp"

namespace odobench {

// Rows go to a temporary file beside the target piece by piece; commit() gives it its name. Without commit()
// nothing remains.
class FilterOutputFile {
 public:
  // `file`: "-" is standard output, which gets the rows as they come. `rotation_sign`: of the output's
  // rotation against the model's.
  FilterOutputFile(const std::filesystem::path& file, Existing existing, int samples, bool with_time,
                   double rotation_sign);
  void add(const FilterOutput& output, double time_s);
  void commit();

 private:
  void put(double value);
  void put(std::int64_t value);

  void flush();

  const bool standard_output_;
  FileTransaction transaction_;
  std::string buffer_;
  bool with_time_;
  double rotation_sign_;
};

}  // namespace odobench
