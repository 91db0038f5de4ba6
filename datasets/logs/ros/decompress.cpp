#include "datasets/logs/ros/decompress.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <vector>

#include "datasets/logs/ros/log_input.hpp"

namespace odobench {
namespace {

constexpr std::size_t kSmallestRoom = 4 << 10;

}  // namespace

std::optional<LogCompression> log_compression(std::string_view name) {
  if (name.empty() || name == "none") return LogCompression::None;
  if (name == "bz2") return LogCompression::Bz2;
  if (name == "lz4") return LogCompression::Lz4;
  if (name == "zstd") return LogCompression::Zstd;
  return std::nullopt;
}

std::uint64_t zstd_size(std::string_view frame) {
  // Both kinds of "unknown" are larger than any limit.
  return std::min<std::uint64_t>(ZSTD_getFrameContentSize(frame.data(), frame.size()), kLargestLogRecord);
}

bool is_zstd(std::string_view bytes) {
  return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

struct Decompressor::State {
  LogCompression compression = LogCompression::None;
  std::uint64_t most = 0;
  // Room for `most`, which takes no memory until it is written to: neither claims nor copies count.
  std::unique_ptr<char[]> out;
  std::size_t capacity = 0, used = 0;
  bool finished = false;
  LZ4F_dctx* lz4 = nullptr;
  ZSTD_DCtx* zstd = nullptr;
  bz_stream bz2 = {};
  bool bz2_open = false;

  ~State() {
    if (lz4 != nullptr) LZ4F_freeDecompressionContext(lz4);
    if (zstd != nullptr) ZSTD_freeDCtx(zstd);
    close_bz2();
  }
  void close_bz2() {
    if (bz2_open) BZ2_bzDecompressEnd(&bz2);
    bz2_open = false;
  }
  // One byte more than allowed, so that what is too long shows.
  std::size_t room() const { return static_cast<std::size_t>(most) + 1 - used; }
  void wrote(std::size_t bytes) {
    used += bytes;
    if (used > most) throw BadCompression(fmt::format("decompresses to more than {} bytes", most));
  }
  void begin_zstd() {
    if (zstd == nullptr) {
      zstd = ZSTD_createDCtx();
      if (zstd == nullptr) throw std::bad_alloc();
      ZSTD_DCtx_setParameter(zstd, ZSTD_d_windowLogMax, 26);
    }
    ZSTD_DCtx_reset(zstd, ZSTD_reset_session_only);
  }
  void put_lz4(std::string_view in);
  void put_zstd(std::string_view in);
  void put_bz2(std::string_view in);
};

void Decompressor::State::put_lz4(std::string_view in) {
  LZ4F_decompressOptions_t options = {};
  options.stableDst = 1;
  while (!in.empty()) {
    std::size_t read = in.size(), written = room();
    const std::size_t result = LZ4F_decompress(lz4, out.get() + used, &written, in.data(), &read, &options);
    if (LZ4F_isError(result)) throw BadCompression(fmt::format("lz4: {}", LZ4F_getErrorName(result)));
    in.remove_prefix(read);
    wrote(written);
    finished = result == 0;
    if (read == 0 && written == 0 && !finished) throw BadCompression("lz4: no progress");
  }
}

void Decompressor::State::put_zstd(std::string_view in) {
  ZSTD_inBuffer input{in.data(), in.size(), 0};
  while (input.pos < input.size) {
    ZSTD_outBuffer output{out.get() + used, room(), 0};
    const std::size_t result = ZSTD_decompressStream(zstd, &output, &input);
    if (ZSTD_isError(result) != 0) throw BadCompression(fmt::format("zstd: {}", ZSTD_getErrorName(result)));
    wrote(output.pos);
    finished = result == 0;
  }
  // What the decoder still holds back.
  while (!finished) {
    ZSTD_outBuffer output{out.get() + used, room(), 0};
    const std::size_t result = ZSTD_decompressStream(zstd, &output, &input);
    if (ZSTD_isError(result) != 0) throw BadCompression(fmt::format("zstd: {}", ZSTD_getErrorName(result)));
    wrote(output.pos);
    finished = result == 0;
    if (output.pos == 0) break;
  }
}

void Decompressor::State::put_bz2(std::string_view in) {
  bz2.next_in = const_cast<char*>(in.data());  // it only reads
  bz2.avail_in = static_cast<unsigned>(in.size());
  while (!finished) {
    const auto before = static_cast<unsigned>(room());
    bz2.next_out = out.get() + used;
    bz2.avail_out = before;
    const unsigned left = bz2.avail_in;
    const int result = BZ2_bzDecompress(&bz2);
    if (result != BZ_OK && result != BZ_STREAM_END)
      throw BadCompression(fmt::format("bz2: error {}", result));
    wrote(before - bz2.avail_out);
    finished = result == BZ_STREAM_END;
    if (bz2.avail_in == left && bz2.avail_out == before) break;  // it waits for more
  }
  if (finished && bz2.avail_in > 0) throw BadCompression("bz2: bytes behind the end");
}

Decompressor::Decompressor() : state_(std::make_unique<State>()) {}
Decompressor::~Decompressor() = default;

void Decompressor::begin(LogCompression compression, std::uint64_t most) {
  State& s = *state_;
  s.compression = compression;
  s.most = std::min(most, kLargestLogRecord);
  s.used = 0;
  s.finished = false;
  if (s.capacity <= s.most) {
    s.capacity = std::max<std::size_t>(static_cast<std::size_t>(s.most) + 1, kSmallestRoom);
    s.out.reset(new char[s.capacity]);
  }
  if (compression == LogCompression::Lz4) {
    if (s.lz4 == nullptr && LZ4F_isError(LZ4F_createDecompressionContext(&s.lz4, LZ4F_VERSION)))
      throw std::bad_alloc();
    LZ4F_resetDecompressionContext(s.lz4);
  } else if (compression == LogCompression::Zstd) {
    s.begin_zstd();
  } else if (compression == LogCompression::Bz2) {
    s.close_bz2();
    s.bz2 = {};
    if (BZ2_bzDecompressInit(&s.bz2, 0, 0) != BZ_OK) throw std::bad_alloc();
    s.bz2_open = true;
  }
}

void Decompressor::put(std::string_view compressed) {
  State& s = *state_;
  switch (s.compression) {
    case LogCompression::Lz4:
      return s.put_lz4(compressed);
    case LogCompression::Zstd:
      return s.put_zstd(compressed);
    case LogCompression::Bz2:
      return s.put_bz2(compressed);
    case LogCompression::None:
      break;
  }
  const std::size_t count = std::min(compressed.size(), s.room());
  std::copy_n(compressed.data(), count, s.out.get() + s.used);
  s.wrote(count);
  s.finished = true;
}

std::string_view Decompressor::end() {
  State& s = *state_;
  s.close_bz2();
  if (!s.finished && s.compression != LogCompression::None)
    throw BadCompression("the compressed data end early");
  return {s.out.get(), s.used};
}

void Decompressor::zstd_stream(const std::function<std::string_view()>& next,
                               const std::function<void(std::string_view)>& take) {
  State& s = *state_;
  s.begin_zstd();
  std::vector<char> piece(ZSTD_DStreamOutSize());
  std::size_t result = 1;
  for (std::string_view in = next(); !in.empty(); in = next()) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    for (bool full = true; input.pos < input.size || full;) {
      ZSTD_outBuffer output{piece.data(), piece.size(), 0};
      result = ZSTD_decompressStream(s.zstd, &output, &input);
      if (ZSTD_isError(result) != 0) throw BadCompression(fmt::format("zstd: {}", ZSTD_getErrorName(result)));
      take({piece.data(), output.pos});
      full = output.pos == output.size;
    }
  }
  if (result != 0) throw BadCompression("the compressed data end early");
}

}  // namespace odobench
