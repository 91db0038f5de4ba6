#include "datasets/csv/csv_stream.hpp"

namespace odobench {

CsvStream::CsvStream(const std::filesystem::path& file, char separator, const std::atomic<bool>* interrupt)
    : CsvRow(file == "-" ? "standard input" : file.string(), separator),
      lines_(file, interrupt),
      interrupt_(interrupt) {
  if (take_header() || interrupted()) return;
  line_ = 1;
  fail("found an empty file, expected a header line");
}

bool CsvStream::take_line(std::string_view& line) {
  if (!lines_.next(line)) return false;
  line_ = lines_.line();
  unfinished_ = lines_.unfinished();
  return true;
}

bool CsvStream::next() {
  if (interrupt_ != nullptr && interrupt_->load(std::memory_order_relaxed)) interrupted_ = true;
  if (interrupted()) return false;
  if (take_waiting_row()) return true;
  std::string_view line;
  do {
    if (!take_line(line)) return false;
    if (line.empty()) {  // looking on may move the buffer, but this line has no bytes
      if (lines_.only_blank_lines_left()) return false;
      line = {};
    }
  } while (!take_row(line));
  return true;
}

}  // namespace odobench
