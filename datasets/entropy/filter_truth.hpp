// What really happened in a run of the relative-entropy filter, row by row beside its input. Columns, in the
// filter's frame (its x axis goes through wheels 1 and 3), with or without the unit in the name:
//   sx_m, sy_m                 m, displacement of the centre in the step that ends at the row
//   dtheta_deg or dtheta_rad   rotation in that step, counting like the input's
//   ax_m_s2, ay_m_s2           rate at which the frame's components of the velocity change
//   enc1x_m, enc1y_m .. enc4y_m  m, displacement of each wheel; all or none
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "datasets/csv/csv_stream.hpp"
#include "datasets/entropy/filter_columns.hpp"

namespace odobench {

struct FilterTruth {
  double sx = 0, sy = 0;  // m
  double rotation_deg = 0;
  double ax = 0, ay = 0;                                      // m/s^2
  std::optional<std::array<std::array<double, 2>, 4>> wheel;  // m, x and y of each
};

class FilterTruthReader {
 public:
  // Names as above that a mapping may give other columns for (without the spellings that lack a unit).
  static const std::vector<std::string>& columns();

  // Throws DataError like FilterRunReader.
  FilterTruthReader(const std::filesystem::path& file, const ColumnMapping& mapping,
                    const std::atomic<bool>* interrupt = nullptr);

  bool next(FilterTruth& truth);
  bool interrupted() const { return stream_.interrupted(); }
  // Throw DataError: the truth has fewer or more rows than `file`.
  [[noreturn]] void too_short(const std::string& file) const;
  [[noreturn]] void too_long(const std::string& file) const;

 private:
  CsvStream stream_;
  std::size_t sx_ = 0, sy_ = 0, rotation_ = 0, ax_ = 0, ay_ = 0;
  double rotation_unit_ = 1;
  std::optional<std::array<std::array<std::size_t, 2>, 4>> wheel_;
  std::int64_t rows_ = 0;
};

}  // namespace odobench
