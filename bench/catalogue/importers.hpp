// Sources of recordings that `bench import` makes data sets of. One more is a folder in datasets/import/ and
// a row in importers.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace odobench {

struct ImportRequest {
  std::string from;  // as the user says it
  std::vector<int> exclude;
  bool drop_lost = false;
  std::string map;                                    // file that says what the columns are
  std::function<void(int done, int total)> progress;  // may be empty
  std::function<void(const std::string&)> say;        // remarks on what was read; may be empty
};

struct ImporterEntry {
  std::string name;
  // Which of the options it takes.
  bool excludes = false, drops_lost = false, maps = false;
  // Throws DataError with file:line on bad raw files.
  std::function<Dataset(const ImportRequest&)> read;
};

// Those that come with the program.
const std::vector<ImporterEntry>& known_importers();

}  // namespace odobench
