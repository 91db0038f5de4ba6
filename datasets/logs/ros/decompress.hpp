// What compressed chunks and messages of logs decompress to, whatever they claim: piece by piece into memory
// that is used as it fills.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace odobench {

// "none" and "" are None; "bz2", "lz4" (its frame format) and "zstd".
enum class LogCompression { None, Bz2, Lz4, Zstd };
std::optional<LogCompression> log_compression(std::string_view name);

// Begins with the magic bytes of a zstd frame.
bool is_zstd(std::string_view bytes);

// What a frame of zstd says of its size, at most kLargestLogRecord, which also stands for an unknown one.
std::uint64_t zstd_size(std::string_view frame);

// What is wrong with compressed data, e.g. "lz4: ERROR_frameType_unknown"; the caller says where.
class BadCompression : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Used for one piece of data after the other. Contexts and memory stay.
class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  // Begins new data that may give at most `most` <= kLargestLogRecord bytes.
  void begin(LogCompression compression, std::uint64_t most);
  // The next compressed bytes. Throws BadCompression, also when the result has more than `most` bytes.
  void put(std::string_view compressed);
  // What came out, valid until the next begin(). Throws BadCompression when the data end early.
  std::string_view end();

  // zstd data of any length, given on in pieces of at most 128 kB; `next` gives compressed bytes, "" at the
  // end. Throws BadCompression.
  void zstd_stream(const std::function<std::string_view()>& next,
                   const std::function<void(std::string_view)>& take);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace odobench
