// A linear system as a JSON file:
//   {"name": "...", "description": "...", "states": ["x [m]", ...], "inputs": [...], "noises": [...],
//    "A": [[..], ..], "B": [[..], ..], "G": [[..], ..], "Qc": [[..], ..]}
// A is needed; without B there are no inputs, without G and Qc no noise (both or neither). Matrices are
// arrays of rows. A unit in brackets after a name is optional, names may be left out.
#pragma once

#include <filesystem>
#include <string>

#include "problems/kalman/linear_system.hpp"

namespace odobench {

struct SystemFile {
  LinearSystem system;
  std::string description;
};

// Throws DataError naming the file, the path in it, what was found and what was expected.
SystemFile read_system(const std::filesystem::path& file);

}  // namespace odobench
