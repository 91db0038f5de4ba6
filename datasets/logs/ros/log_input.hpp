// A log's bytes from front to back: a regular file read in pieces, so that a file that shrinks meanwhile is
// one that is cut off, and numbers out of records.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

// What a chunk, a message or any other record may have at most [bytes], decompressed.
inline constexpr std::uint64_t kLargestLogRecord = std::uint64_t{64} << 20;
// Channels, topics, connections of one file.
inline constexpr std::size_t kMostLogChannels = 65536;

// Throws DataError "FILE: byte N: WHAT".
[[noreturn]] void fail_at(const std::filesystem::path& file, std::uint64_t byte, const std::string& what);

// The file ends before a record does. What it says of messages is added where they are counted.
struct LogCutOff {
  std::filesystem::path file;
  std::uint64_t byte = 0, expected = 0, left = 0;
};

class LogInput {
 public:
  // Throws DataError when it is no regular file or cannot be read.
  explicit LogInput(const std::filesystem::path& file);
  ~LogInput();
  LogInput(const LogInput&) = delete;
  LogInput& operator=(const LogInput&) = delete;

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t left() const { return size_ - position_; }

  // The next `count` bytes, valid until the next call. Throws LogCutOff when there are fewer, DataError when
  // `count` is more than a record may have.
  std::string_view take(std::uint64_t count);
  // The next bytes, at least one and at most `most`, of what is in memory anyway; "" at the end.
  std::string_view take_some(std::uint64_t most);
  void skip(std::uint64_t count);  // throws LogCutOff
  void seek(std::uint64_t position);
  // Throws LogCutOff when fewer than `count` bytes are left.
  void require(std::uint64_t count) const;

 private:
  void fill(std::size_t count);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0, position_ = 0;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // what is read and not yet taken
};

// A little-endian number out of bytes that are known to be there.
template <class T>
T little_endian(const char* bytes) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// Numbers and strings one after the other. Throws DataError "FILE: byte N: WHAT: ..." when they do not fit.
class LogCursor {
 public:
  LogCursor(std::string_view bytes, const LogInput& input, std::uint64_t byte, const char* what)
      : rest_(bytes), input_(&input), byte_(byte), what_(what) {}

  template <class T>
  T number() {
    return little_endian<T>(bytes(sizeof(T)).data());
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }  // length in 32 bits, then the bytes
  std::string_view bytes(std::uint64_t count) {
    if (count > rest_.size()) fail_short(count);
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view rest() const { return rest_; }

 private:
  [[noreturn]] void fail_short(std::uint64_t count) const;

  std::string_view rest_;
  const LogInput* input_;
  std::uint64_t byte_;
  const char* what_;
};

}  // namespace odobench
