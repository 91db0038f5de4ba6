#include "bench/console/table_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
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
constexpr std::array kSaved{Format::Console, Format::Markdown, Format::Csv, Format::Json, Format::Latex};

void line(const char* kind, const std::string& text) {
  const std::string whole = fmt::format("bench: {}{}\n", kind, one_line_message(text));
  std::fwrite(whole.data(), 1, whole.size(), stderr);
}

// https://no-color.org: any value but the empty one asks for plain text.
bool bold_is_welcome() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && (no_color == nullptr || *no_color == 0) &&
         (terminal == nullptr || std::string(terminal) != "dumb");
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

std::vector<std::filesystem::path> table_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const Format format : kSaved) files.push_back(folder / ("tables." + file_extension(format)));
  return files;
}

void save_tables(const std::vector<Table>& tables, const std::filesystem::path& folder) {
  FileTransaction files;
  for (const Format format : kSaved)
    files.add(folder / ("tables." + file_extension(format)), render(tables, format, {kPlainWidth, false}));
  files.commit();
}

void warn(const std::string& text) {
  line("warning: ", text);
}
void note(const std::string& text) {
  line("", text);
}

}  // namespace odobench
