// Data sets from a user's own CSV files: a table per drive, a map that says what its columns are
// (docs/import.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace odobench {

struct CsvImport {
  Dataset dataset;
  // A line per drive: samples, seconds, metres, degrees turned.
  std::vector<std::string> report;
};

// `items`: files, folders, patterns (csv_files()). A file's name without a trailing _N or -N is its
// trajectory, N its repetition, unless the map says otherwise; without a number it is the first that is free.
// Whatever was left out or repaired is counted in the set's notes. Throws what csv_files(), parse_csv_map()
// and parse_drive() throw; DataError for two drives with one trajectory and repetition, names in the map that
// no file has.
CsvImport import_csv(const std::vector<std::string>& items, const std::filesystem::path& map);

}  // namespace odobench
