// Bytes of a file, or of what is compressed in it, one piece after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace odobench {

class ByteSource {
 public:
  virtual ~ByteSource() = default;
  // At most `most` bytes; 0 at the end only.
  virtual std::size_t read(char* to, std::size_t most) = 0;
  virtual void skip(std::uint64_t count);

  // Exactly this many; false where there are fewer.
  bool read_exactly(char* to, std::size_t count);
};

// A regular file.
class FileBytes : public ByteSource {
 public:
  // DataError where it cannot be opened.
  explicit FileBytes(const std::filesystem::path& file);
  ~FileBytes() override;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::size_t read(char* to, std::size_t most) override;
  void skip(std::uint64_t count) override { seek(position() + count); }
  void seek(std::uint64_t position);
  std::uint64_t position() const { return at_ + begin_; }
  std::uint64_t size() const { return size_; }

 private:
  std::filesystem::path file_;
  int descriptor_;
  std::uint64_t size_ = 0, at_ = 0;  // at_: position of the buffer's first byte
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

// The next bytes of another source, no more than these.
class LimitedBytes : public ByteSource {
 public:
  LimitedBytes(ByteSource& from, std::uint64_t count) : from_(from), left_(count) {}
  std::size_t read(char* to, std::size_t most) override;
  void skip(std::uint64_t count) override;
  std::uint64_t left() const { return left_; }

 private:
  ByteSource& from_;
  std::uint64_t left_;
};

// Decompressed by zlib: a raw deflate stream (zip) or one with zlib's header (MAT). DataError "NAME: ..."
// where it is damaged or gives more than `most` bytes.
class InflatedBytes : public ByteSource {
 public:
  InflatedBytes(ByteSource& from, bool raw, std::uint64_t most, std::string name);
  ~InflatedBytes() override;
  InflatedBytes(const InflatedBytes&) = delete;
  InflatedBytes& operator=(const InflatedBytes&) = delete;
  std::size_t read(char* to, std::size_t most) override;

 private:
  struct Stream;
  ByteSource& from_;
  std::uint64_t left_;
  std::string name_;
  std::unique_ptr<Stream> stream_;
  std::vector<char> buffer_;
  bool ended_ = false;
};

}  // namespace odobench
