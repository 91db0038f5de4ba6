// All formats of logs, and which of them a file is.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/error.hpp"
#include "datasets/logs/log_file.hpp"

namespace odobench {

// In the order in which they are asked.
const std::vector<LogFormat>& log_formats();

// Throws DataError for what cannot be read, is neither a regular file nor a folder, or is of no known format;
// the message says how other formats are converted.
std::unique_ptr<LogFile> open_log(const std::filesystem::path& path, const LogOptions& options = {});

}  // namespace odobench
