// ROS 1 bags, version 2.0, front to back: no index is needed, so files of a recorder that crashed
// (.bag.active) work, too.
#include <fmt/format.h>

#include <optional>
#include <unordered_map>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/ros/containers.hpp"
#include "datasets/logs/ros/decompress.hpp"
#include "datasets/logs/ros/log_input.hpp"

namespace odobench {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
enum BagOp : unsigned char { kBagMessage = 2, kBagHeader = 3, kBagChunk = 5, kBagConnection = 7 };

// Records of a chunk that is in memory; the interface of LogInput.
class ChunkBytes {
 public:
  ChunkBytes(std::string_view bytes, const LogInput& input, std::uint64_t byte)
      : cursor_(bytes, input, byte, "a record of the chunk"), byte_(byte) {}
  std::string_view take(std::uint64_t count) { return cursor_.bytes(count); }
  void skip(std::uint64_t count) { cursor_.bytes(count); }
  std::uint64_t position() const { return byte_; }
  std::uint64_t left() const { return cursor_.rest().size(); }

 private:
  LogCursor cursor_;
  std::uint64_t byte_;
};

class BagWalk {
 public:
  BagWalk(const std::filesystem::path& file, const LogOptions& options, RosSink& sink, const Stop& stop)
      : input_(file), sink_(sink), stop_(stop), decompressed_(file, options.max_bytes) {}

  void run() {
    if (input_.take(kBagMagic.size()) != kBagMagic)
      fail(0, "found another version, expected a ROS 1 bag of version 2.0: convert it by `rosbag fix`");
    while (input_.left() > 0) record(input_, true);
  }

 private:
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const {
    fail_at(input_.file(), byte, what);
  }

  // The value of a field of a record's header, nothing where it has none.
  std::optional<std::string_view> find(std::string_view header, std::string_view name, std::uint64_t byte) {
    while (!header.empty()) {
      if (header.size() < 4) fail(byte, "a record whose header ends early");
      const std::uint32_t length = little_endian<std::uint32_t>(header.data());
      header.remove_prefix(4);
      if (length > header.size())
        fail(byte, fmt::format("a header's field of {} bytes, {} left", length, header.size()));
      const std::string_view field = header.substr(0, length);
      if (field.size() > name.size() && field[name.size()] == '=' && field.substr(0, name.size()) == name)
        return field.substr(name.size() + 1);
      header.remove_prefix(length);
    }
    return std::nullopt;
  }
  std::string_view text(std::string_view header, std::string_view name, std::uint64_t byte) {
    if (const auto value = find(header, name, byte)) return *value;
    fail(byte, fmt::format("a record without the field '{}'", name));
  }
  template <class T>
  T number(std::string_view header, std::string_view name, std::uint64_t byte) {
    const std::string_view value = text(header, name, byte);
    if (value.size() != sizeof(T))
      fail(byte, fmt::format("field '{}' of {} bytes, expected {}", name, value.size(), sizeof(T)));
    return little_endian<T>(value.data());
  }

  template <class Source>
  void record(Source& source, bool top);
  template <class Source>
  void message(Source& source, std::uint64_t length, std::uint64_t byte);
  void connection(std::string_view data, std::uint64_t byte);
  void chunk(std::uint64_t length, std::uint64_t byte);

  LogInput input_;
  RosSink& sink_;
  const Stop& stop_;
  DecompressedBytes decompressed_;
  Decompressor decompressor_;
  std::unordered_map<std::uint32_t, int> channels_;
  std::string header_;  // of the record at hand: the source's bytes go when more are taken
};

template <class Source>
void BagWalk::record(Source& source, bool top) {
  const std::uint64_t byte = source.position();
  header_ = source.take(little_endian<std::uint32_t>(source.take(4).data()));
  const std::uint32_t length = little_endian<std::uint32_t>(source.take(4).data());
  const auto op = number<unsigned char>(header_, "op", byte);
  if (op == kBagMessage) return message(source, length, byte);
  if (op == kBagConnection) return connection(source.take(length), byte);
  if (op == kBagChunk) {
    if (!top) fail(byte, "a chunk inside a chunk");
    return chunk(length, byte);
  }
  if (op == kBagHeader) {
    const auto encryptor = find(header_, "encryptor", byte);
    if (encryptor && !encryptor->empty())
      fail(byte, fmt::format("the bag is encrypted by {}", shown(*encryptor)));
  }
  source.skip(length);
}

template <class Source>
void BagWalk::message(Source& source, std::uint64_t length, std::uint64_t byte) {
  const auto connection = number<std::uint32_t>(header_, "conn", byte);
  const auto channel = channels_.find(connection);
  if (channel == channels_.end())
    fail(byte, fmt::format("a message of connection {}, which has no record", connection));
  if ((sink_.seen & 255) == 0) stop_.check();
  if (channel->second < 0) {
    source.skip(length);
    ++sink_.seen;
    return;
  }
  const auto time = number<std::uint64_t>(header_, "time", byte);
  const std::int64_t log_ns =
      static_cast<std::int64_t>(time & 0xFFFFFFFF) * 1'000'000'000 + static_cast<std::int64_t>(time >> 32);
  const std::string_view data = source.take(length);
  ++sink_.seen;
  sink_.message(channel->second, log_ns, data, {&input_.file(), byte, false});
}

void BagWalk::connection(std::string_view data, std::uint64_t byte) {
  const auto id = number<std::uint32_t>(header_, "conn", byte);
  if (channels_.count(id) != 0) return;  // again, as at the end of the file
  if (channels_.size() >= kMostLogChannels)
    fail(byte, fmt::format("more than {} connections", kMostLogChannels));
  RosChannel channel;
  channel.topic = text(header_, "topic", byte);
  channel.type = text(data, "type", byte);
  channel.encoding = RosEncoding::Ros1;
  if (const auto definition = find(data, "message_definition", byte))
    channel.definition = definition_text(*definition);
  channels_[id] = sink_.channel(channel);
}

void BagWalk::chunk(std::uint64_t length, std::uint64_t byte) {
  stop_.check();
  const std::string_view name = text(header_, "compression", byte);
  const auto size = number<std::uint32_t>(header_, "size", byte);
  const auto compression = log_compression(name);
  if (!compression || *compression == LogCompression::Zstd)
    fail(byte, fmt::format("a chunk compressed by '{}', expected none, bz2 or lz4", shown(name)));
  if (*compression == LogCompression::None) {
    if (size != length) fail(byte, fmt::format("a chunk that claims {} bytes and has {}", size, length));
    const std::uint64_t end = input_.position() + length;
    while (input_.position() < end) record(input_, false);
    if (input_.position() != end) fail(byte, "a record that is longer than its chunk");
    return;
  }
  // The recorder writes the size when the chunk is full.
  if (length == 0 && input_.left() > 0) throw LogCutOff{input_.file(), byte, 0, input_.left()};
  if (size > kLargestLogRecord)
    throw DataError(fmt::format("{}: chunk at byte {} claims {} bytes, more than {}",
                                shown_path(input_.file()), byte, size, kLargestLogRecord));
  input_.require(length);
  try {
    decompressor_.begin(*compression, size);
    for (std::uint64_t left = length; left > 0;) {
      const std::string_view piece = input_.take_some(left);
      decompressor_.put(piece);
      left -= piece.size();
    }
    const std::string_view bytes = decompressor_.end();
    if (bytes.size() != size)
      throw BadCompression(fmt::format("claims {} bytes and gives {}", size, bytes.size()));
    decompressed_.add(size);
    ChunkBytes source(bytes, input_, byte);
    while (source.left() > 0) record(source, false);
  } catch (const BadCompression& e) {
    fail(byte, fmt::format("chunk: {}", e.what()));
  }
}

class Bag : public RosContainer {
 public:
  Bag(const std::filesystem::path& file, const LogOptions& options) : file_(file), options_(options) {}
  const char* format() const override { return "ROS 1 bag"; }
  const std::filesystem::path& file() const override { return file_; }
  void walk(RosSink& sink, const Stop& stop) const override { BagWalk(file_, options_, sink, stop).run(); }

 private:
  std::filesystem::path file_;
  LogOptions options_;
};

}  // namespace

bool is_bag(std::string_view head) {
  return head.substr(0, 9) == "#ROSBAG V";
}

std::unique_ptr<RosContainer> open_bag(const std::filesystem::path& file, const LogOptions& options) {
  return std::make_unique<Bag>(file, options);
}

}  // namespace odobench
