#include "datasets/csv/csv_stream.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/files.hpp"

namespace odobench {
namespace {

constexpr std::size_t kPiece = 1 << 16;
constexpr int kPollMilliseconds = 100;

std::string shown_name(const std::filesystem::path& file) {
  return file == "-" ? "standard input" : file.string();
}

}  // namespace

CsvStream::CsvStream(const std::filesystem::path& file, char separator, const std::atomic<bool>* interrupt)
    : CsvRow(shown_name(file), separator), interrupt_(interrupt) {
  descriptor_ = file == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3) : open_regular(file);
  if (descriptor_ < 0)
    throw DataError(fmt::format("{}: cannot be read: {}", shown_name(file),
                                std::error_code(errno, std::generic_category()).message()));
  try {
    const bool any = take_header();
    if (interrupted_) return;
    if (!any) {
      line_ = 1;
      fail("found an empty file, expected a header line");
    }
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

CsvStream::~CsvStream() {
  ::close(descriptor_);
}

// Adds a piece to the buffer; false at the end.
bool CsvStream::fill() {
  if (at_end_ || interrupted_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() < end_ + kPiece) buffer_.resize(end_ + kPiece);
  for (;;) {
    if (interrupt_ != nullptr && interrupt_->load()) {
      interrupted_ = true;
      return false;
    }
    pollfd ready{descriptor_, POLLIN, 0};
    if (interrupt_ != nullptr && ::poll(&ready, 1, kPollMilliseconds) <= 0) continue;
    const ssize_t n = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw DataError(fmt::format("{}: cannot be read: {}", file(),
                                  std::error_code(errno, std::generic_category()).message()));
    at_end_ = n == 0;
    end_ += static_cast<std::size_t>(n);
    return !at_end_;
  }
}

bool CsvStream::take_line(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const std::size_t length = end_ - begin_;
    const void* hit = length == searched
                          ? nullptr
                          : std::memchr(buffer_.data() + begin_ + searched, '\n', length - searched);
    if (hit != nullptr) {
      const char* first = buffer_.data() + begin_;
      line = {first, static_cast<std::size_t>(static_cast<const char*>(hit) - first)};
      begin_ += line.size() + 1;
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      return true;
    }
    searched = length;
    if (length > kLongestLine) {
      ++line_;
      fail(fmt::format("found a line longer than {} bytes, expected rows of numbers", kLongestLine));
    }
    if (fill()) continue;
    if (interrupted_ || begin_ == end_) return false;
    unfinished_ = true;
    line = {buffer_.data() + begin_, end_ - begin_};
    begin_ = end_;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }
}

// A blank line was read: is the rest of the file blank too? A second blank piece is read over the first one.
bool CsvStream::only_blank_lines_left() {
  for (;;) {
    const char* first = buffer_.data() + begin_;
    const char* last = buffer_.data() + end_;
    if (std::any_of(first, last, [](char c) { return c != '\n' && c != '\r'; })) return false;
    begin_ = end_;
    if (!fill()) return true;
  }
}

bool CsvStream::next() {
  if (interrupt_ != nullptr && interrupt_->load(std::memory_order_relaxed)) interrupted_ = true;
  if (interrupted_) return false;
  if (take_waiting_row()) return true;
  std::string_view line;
  do {
    if (!take_line(line)) return false;
    if (line.empty()) {  // fill() may move the buffer, but this line has no bytes
      const std::size_t here = line_;
      if (only_blank_lines_left()) return false;
      line_ = here;
      line = {};
    }
  } while (!take_row(line));
  return true;
}

}  // namespace odobench
