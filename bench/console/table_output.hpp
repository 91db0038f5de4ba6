// Tables and texts to standard output, remarks to standard error.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/files.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Standard output; console tables as wide as the terminal, with the best values in bold unless NO_COLOR is
// set; 110 columns and stars elsewhere. Throws std::runtime_error
// when it cannot be written.
void print_tables(const std::vector<Table>& tables, Format format);
void print_text(const std::string& text);

// `bytes` to a file (write_file), or to standard output where `path` is "-".
void write_result(const std::string& path, std::string_view bytes, Existing existing);

// One line on standard error: "bench: warning: ...", escaped and of bounded length (one_line_message).
void warn(const std::string& text);
void note(const std::string& text);
// note() for people alone: nothing where standard error is no terminal.
void hint(const std::string& text);

}  // namespace odobench
