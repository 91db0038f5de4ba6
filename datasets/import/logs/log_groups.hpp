// Which logs are one drive together.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

// What logs belong together: by the pattern `files` of the map's sources, the text behind * being the drive;
// without patterns every log is one. Throws std::invalid_argument for logs that no source takes.
struct LogGroup {
  std::string id;
  std::map<std::string, std::filesystem::path> file_of;  // source -> log
};
std::vector<LogGroup> group_logs(const LogMap& map, const std::vector<std::filesystem::path>& logs);

// The text that * of a pattern stands for in a name, nothing where the name does not fit; "" of a pattern
// without *. One * at most.
std::optional<std::string> star_text(const std::string& pattern, const std::string& name);

}  // namespace odobench::log_import
