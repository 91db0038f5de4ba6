// One drive of a user's own: a CSV file with stamps, reference and wheels in one table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/import/csv/csv_map.hpp"
#include "datasets/recording.hpp"

namespace odobench::csv_import {

struct CsvDrive {
  Recording recording;                // without names
  bool unfinished = false;            // the last line has no line break: its last number may be cut
  std::size_t without_reference = 0;  // rows, of those that were kept
  std::size_t before_reference = 0;   // rows left out at the beginning, since the start was unknown
  std::size_t turns_removed = 0;      // jumps of the heading by a turn
  std::size_t unclear_turns = 0;      // more than half a turn between references that are not neighbours
  double first_increment = 0;         // size of the largest of the first row (rad)
  double usual_step = 0;              // median, s
  std::size_t gaps = 0;               // steps of more than kGap usual ones
  double longest_step = 0;            // s
  std::size_t longest_line = 0;       // at whose end it is
};

inline constexpr double kGap = 10;

// Signals in rad/s or rad, the reference in m and rad. Cells of x, y and theta may be empty or nan, all three
// together: that row has no reference. Throws DataError "file:line: ..." for columns that the header has not
// (with the nearest one) or has twice, cells that are no finite numbers, counts beyond 2^53, stamps that are
// not later than the one before; for files without two rows from the first reference on, or without another
// reference.
CsvDrive parse_drive(std::string_view text, const std::string& file, const CsvMap& map);

// How far the reference went, and how much it turned. Moves of less than 1 cm or 1 degree are noise.
struct Travelled {
  double metres = 0, left = 0, right = 0;  // left, right: rad
};
Travelled travelled(const Reference& reference);

// One line: id, samples, seconds, metres, degrees turned to the left and to the right; with the file's name
// where there is one.
std::string describe_drive(const Recording& recording, const std::string& file = "");

}  // namespace odobench::csv_import
