// A text whose rows are a table, as a log: CSV in any dialect, and the presets that are tables too.
#pragma once

#include <filesystem>
#include <memory>

#include "datasets/logs/log_file.hpp"
#include "datasets/logs/tables/table_layout.hpp"

namespace odobench {

// The log that this layout describes. Rows that have none of the values that a request asks for (tables that
// mix two sensors) are passed over and counted in its notes. A stamp before the one above it is a DataError
// "FILE:7: time goes back by 0.150 s".
std::unique_ptr<LogFile> open_table(const std::filesystem::path& file, TableLayout layout, bool keep_cut);

// CSV, TSV, blanks: the layout is looked for (find_table_layout).
LogFormat csv_log_format();

}  // namespace odobench
