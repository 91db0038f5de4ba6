#include "datasets/csv/text_lines.hpp"

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

[[noreturn]] void refuse_reading(const std::string& name) {
  throw DataError(
      fmt::format("{}: cannot be read: {}", name, std::error_code(errno, std::generic_category()).message()));
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& file, const std::atomic<bool>* interrupt)
    : name_(file == "-" ? "standard input" : file.string()), interrupt_(interrupt) {
  descriptor_ = file == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3) : open_regular(file);
  if (descriptor_ < 0) refuse_reading(name_);
}

TextLines::~TextLines() {
  ::close(descriptor_);
}

// Adds a piece to the buffer; false at the end.
bool TextLines::fill() {
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
    if (n < 0) refuse_reading(name_);
    at_end_ = n == 0;
    end_ += static_cast<std::size_t>(n);
    return !at_end_;
  }
}

bool TextLines::take(std::string_view& line, std::size_t length, std::size_t used) {
  line = {buffer_.data() + begin_, length};
  begin_ += used;
  ++line_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

bool TextLines::next(std::string_view& line) {
  if (interrupt_ != nullptr && interrupt_->load(std::memory_order_relaxed)) interrupted_ = true;
  if (interrupted_) return false;
  std::size_t searched = 0;
  for (;;) {
    const std::size_t length = end_ - begin_;
    const char* first = buffer_.data() + begin_;
    const void* hit = length == searched ? nullptr : std::memchr(first + searched, '\n', length - searched);
    if (hit != nullptr) {
      const auto found = static_cast<std::size_t>(static_cast<const char*>(hit) - first);
      return take(line, found, found + 1);
    }
    searched = length;
    if (length > kLongestLine)
      throw DataError(fmt::format("{}:{}: found a line longer than {} bytes, expected rows of numbers", name_,
                                  line_ + 1, kLongestLine));
    if (fill()) continue;
    if (interrupted_ || begin_ == end_) return false;
    unfinished_ = true;
    return take(line, length, length);
  }
}

bool TextLines::only_blank_lines_left() {
  for (;;) {
    const char* first = buffer_.data() + begin_;
    const char* last = buffer_.data() + end_;
    if (std::any_of(first, last, [](char c) { return c != '\n' && c != '\r'; })) return false;
    begin_ = end_;
    if (!fill()) return true;
  }
}

}  // namespace odobench
