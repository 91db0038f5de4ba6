#include "datasets/logs/arrays/byte_source.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/files.hpp"

namespace odobench {
namespace {

constexpr std::size_t kBuffer = 1 << 18;

}  // namespace

bool ByteSource::read_exactly(char* to, std::size_t count) {
  while (count > 0) {
    const std::size_t n = read(to, count);
    if (n == 0) return false;
    to += n;
    count -= n;
  }
  return true;
}

void ByteSource::skip(std::uint64_t count) {
  char thrown_away[1 << 14];
  while (count > 0) {
    const std::size_t n =
        read(thrown_away, static_cast<std::size_t>(std::min<std::uint64_t>(count, sizeof thrown_away)));
    if (n == 0) return;
    count -= n;
  }
}

FileBytes::FileBytes(const std::filesystem::path& file)
    : file_(file), descriptor_(open_regular(file)), buffer_(kBuffer) {
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0) size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() {
  ::close(descriptor_);
}

std::size_t FileBytes::read(char* to, std::size_t most) {
  if (begin_ == end_) {
    at_ += end_;
    begin_ = end_ = 0;
    for (;;) {
      const ssize_t n = ::pread(descriptor_, buffer_.data(), buffer_.size(), static_cast<off_t>(at_));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0)
        throw DataError(fmt::format("{}: cannot be read: {}", shown_path(file_),
                                    std::error_code(errno, std::generic_category()).message()));
      end_ = static_cast<std::size_t>(n);
      break;
    }
  }
  const std::size_t count = std::min(most, end_ - begin_);
  std::memcpy(to, buffer_.data() + begin_, count);
  begin_ += count;
  return count;
}

void FileBytes::seek(std::uint64_t position) {
  position = std::min(position, size_);
  if (position >= at_ && position <= at_ + end_) {
    begin_ = static_cast<std::size_t>(position - at_);
    return;
  }
  at_ = position;
  begin_ = end_ = 0;
}

std::size_t LimitedBytes::read(char* to, std::size_t most) {
  const std::size_t count = from_.read(to, static_cast<std::size_t>(std::min<std::uint64_t>(most, left_)));
  left_ -= count;
  return count;
}

void LimitedBytes::skip(std::uint64_t count) {
  count = std::min(count, left_);
  from_.skip(count);
  left_ -= count;
}

struct InflatedBytes::Stream {
  z_stream z{};
};

InflatedBytes::InflatedBytes(ByteSource& from, bool raw, std::uint64_t most, std::string name)
    : from_(from),
      left_(most),
      name_(std::move(name)),
      stream_(std::make_unique<Stream>()),
      buffer_(1 << 16) {
  constexpr int window = 15;
  if (::inflateInit2(&stream_->z, raw ? -window : window) != Z_OK)
    throw DataError(fmt::format("{}: zlib cannot begin", name_));
}

InflatedBytes::~InflatedBytes() {
  ::inflateEnd(&stream_->z);
}

std::size_t InflatedBytes::read(char* to, std::size_t most) {
  constexpr std::size_t largest = 1 << 30;
  z_stream& z = stream_->z;
  if (most == 0) return 0;
  z.next_out = reinterpret_cast<Bytef*>(to);
  z.avail_out = static_cast<uInt>(std::min(most, largest));
  const uInt room = z.avail_out;
  while (z.avail_out == room && !ended_) {
    if (z.avail_in == 0) {
      z.avail_in = static_cast<uInt>(from_.read(buffer_.data(), buffer_.size()));
      z.next_in = reinterpret_cast<Bytef*>(buffer_.data());
      if (z.avail_in == 0) throw DataError(fmt::format("{}: the compressed data are cut off", name_));
    }
    const int status = ::inflate(&z, Z_NO_FLUSH);
    if (status == Z_STREAM_END)
      ended_ = true;
    else if (status != Z_OK && status != Z_BUF_ERROR)
      throw DataError(
          fmt::format("{}: the compressed data are damaged ({})", name_, z.msg == nullptr ? "zlib" : z.msg));
  }
  const std::size_t count = room - z.avail_out;
  if (count > left_) throw DataError(fmt::format("{}: decompresses to more than is allowed", name_));
  left_ -= count;
  return count;
}

}  // namespace odobench
