#include "bench/console/table_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "base/text.hpp"
#include "bench/console/progress.hpp"

namespace odobench {
namespace {

constexpr int kPlainWidth = 110;

void line(const char* kind, const std::string& text) {
  const std::string whole = fmt::format("bench: {}{}\n", kind, one_line_message(text));
  std::fwrite(whole.data(), 1, whole.size(), stderr);
}

// https://no-color.org: any value but the empty one asks for plain text.
bool bold_is_welcome() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && (no_color == nullptr || *no_color == 0) &&
         (term == nullptr || std::string(term) != "dumb");
}

}  // namespace

void print_text(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw std::runtime_error(fmt::format("standard output: {}", std::strerror(errno)));
}

void print_tables(const std::vector<Table>& tables, Format format) {
  print_text(render(tables, format, {terminal_width(STDOUT_FILENO, kPlainWidth), bold_is_welcome()}));
}

void write_result(const std::string& path, std::string_view bytes, Existing existing) {
  if (path == "-")
    print_text(std::string(bytes));
  else
    write_file(path, bytes, existing);
}

void warn(const std::string& text) {
  line("warning: ", text);
}
void note(const std::string& text) {
  line("", text);
}
void hint(const std::string& text) {
  if (::isatty(STDERR_FILENO) == 1) note(text);
}

}  // namespace odobench
