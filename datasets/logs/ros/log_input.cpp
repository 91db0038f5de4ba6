#include "datasets/logs/ros/log_input.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/files.hpp"

namespace odobench {
namespace {

// As fast as larger ones, and it stays in the cache until it is decoded.
constexpr std::size_t kLogPiece = std::size_t{256} << 10;

[[noreturn]] void fail_reading(const std::filesystem::path& file) {
  throw DataError(fmt::format("{}: cannot be read: {}", shown_path(file),
                              std::error_code(errno, std::generic_category()).message()));
}

}  // namespace

void fail_at(const std::filesystem::path& file, std::uint64_t byte, const std::string& what) {
  throw DataError(fmt::format("{}: byte {}: {}", shown_path(file), byte, what));
}

LogInput::LogInput(const std::filesystem::path& file)
    : file_(file), descriptor_(open_regular(file)), buffer_(kLogPiece) {
  struct ::stat status {};
  if (::fstat(descriptor_, &status) != 0) {
    ::close(descriptor_);
    fail_reading(file);
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

LogInput::~LogInput() {
  ::close(descriptor_);
}

void LogInput::require(std::uint64_t count) const {
  if (count > left()) throw LogCutOff{file_, position_, count, left()};
}

// Until `count` bytes are in the buffer; count <= left().
void LogInput::fill(std::size_t count) {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (buffer_.size() < count) buffer_.resize(count + kLogPiece);
  while (end_ < count) {
    const ssize_t n = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_reading(file_);
    if (n == 0) throw LogCutOff{file_, position_, count, end_};
    end_ += static_cast<std::size_t>(n);
  }
}

std::string_view LogInput::take(std::uint64_t count) {
  require(count);
  if (count > kLargestLogRecord)
    fail_at(file_, position_, fmt::format("a record of {} bytes, more than {}", count, kLargestLogRecord));
  const auto n = static_cast<std::size_t>(count);
  if (end_ - begin_ < n) fill(n);
  const std::string_view taken(buffer_.data() + begin_, n);
  begin_ += n;
  position_ += n;
  return taken;
}

std::string_view LogInput::take_some(std::uint64_t most) {
  most = std::min(most, left());
  if (most == 0) return {};
  if (begin_ == end_) fill(1);
  return take(std::min<std::uint64_t>(most, end_ - begin_));
}

void LogInput::skip(std::uint64_t count) {
  require(count);
  if (count > end_ - begin_) return seek(position_ + count);
  begin_ += static_cast<std::size_t>(count);
  position_ += count;
}

void LogInput::seek(std::uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail_reading(file_);
  position_ = position;
  begin_ = end_ = 0;
}

void LogCursor::fail_short(std::uint64_t count) const {
  fail_at(input_->file(), byte_, fmt::format("{}: found {} bytes, expected {}", what_, rest_.size(), count));
}

}  // namespace odobench
