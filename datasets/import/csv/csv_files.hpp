// Which files an import reads, and what their names say.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace odobench::csv_import {

// Each item is a file, a folder (all *.csv in it) or a pattern of names with * and ? in one folder. Files of
// folders and patterns are ordered by name and number, run_2 before run_10. Throws std::invalid_argument for
// no item, an empty one, a file that is given twice; DataError for a folder that cannot be read or has none,
// a pattern that nothing fits.
std::vector<std::filesystem::path> csv_files(const std::vector<std::string>& items);

// "line_x_2.csv": trajectory "line_x", number 2; 0 where the name ends in none (of one to four digits behind
// _ or -).
struct NameParts {
  std::string trajectory;
  int number = 0;
};
NameParts name_parts(const std::filesystem::path& file);

// A name as an id: letters, digits, _, - and . are left as they are, others become _.
std::string as_id(const std::string& text);

}  // namespace odobench::csv_import
