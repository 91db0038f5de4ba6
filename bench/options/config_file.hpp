// Configuration files of `bench run --config=FILE`: the long options without their dashes.
//   JSON  {"solver": ["lm", "pso[swarm=60]"], "repeat": 10, "quiet": true}
//   INI / TOML subset: one `key = value` a line, '#' or ';' begins a comment, values bare, "quoted" or
//   'quoted', or a one-line array ["a", "b"]; the only section is [run].
#pragma once

#include <string>
#include <vector>

namespace odobench {

struct ConfigEntry {
  std::string key;
  std::vector<std::string> values;  // as they would be typed; booleans are "true" or "false"
  std::string where;                // "file:line" or "file"
};

// A file whose first character other than white space is '{' is JSON. Throws std::invalid_argument
// "file:line: ..." on a file that cannot be read, on syntax errors and on a key given twice. Whether a key
// exists is the caller's to say.
std::vector<ConfigEntry> read_config(const std::string& path);

}  // namespace odobench
