// Where data lies without being told: beside an installed bench, or in the source tree it was built from.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace odobench {

// The embedded demo set. Throws DataError naming every place looked at when it is nowhere.
std::filesystem::path demo_set();

// The folder of the scenarios that come with the program; empty when it is nowhere.
std::filesystem::path scenario_folder();

// Known sets that exist: (name, set.json).
std::vector<std::pair<std::string, std::filesystem::path>> known_sets();

}  // namespace odobench
