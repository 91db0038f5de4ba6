// MCAP files, front to back. The index at the end, where there is one, tells which chunks have no message of
// a wanted channel: they are passed over unread.
#include <fmt/format.h>
#include <zlib.h>

#include <set>
#include <unordered_map>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/ros/containers.hpp"
#include "datasets/logs/ros/decompress.hpp"
#include "datasets/logs/ros/log_input.hpp"

namespace odobench {
namespace {

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
enum McapOp : unsigned char {
  kMcapFooter = 2,
  kMcapSchema = 3,
  kMcapChannel = 4,
  kMcapMessage = 5,
  kMcapChunk = 6,
  kMcapChunkIndex = 8,
  kMcapDataEnd = 15
};
constexpr std::uint64_t kMcapHead = 9;          // op and length of a record
constexpr std::uint64_t kMcapFooterBytes = 20;  // of the footer record behind its head
constexpr std::uint64_t kMcapMessageHead = 22;  // of a message record before the data
constexpr std::size_t kMostIndexedChunks = 1 << 20;

class McapWalk {
 public:
  McapWalk(const std::filesystem::path& file, const LogOptions& options, RosSink& sink, const Stop& stop)
      : input_(file), sink_(sink), stop_(stop), decompressed_(file, options.max_bytes) {}

  void run() {
    if (input_.take(kMcapMagic.size()) != kMcapMagic) fail(0, "found other bytes, expected an MCAP file");
    read_index();
    while (top_record()) {
    }
  }

 private:
  struct Schema {
    std::string name, encoding;
    std::shared_ptr<const std::string> text;
  };
  struct MessageHead {
    int channel;
    std::int64_t log_ns;
  };

  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const {
    fail_at(input_.file(), byte, what);
  }
  LogCursor cursor(std::string_view bytes, std::uint64_t byte, const char* what) const {
    return {bytes, input_, byte, what};
  }

  bool top_record();  // false at the end of the data
  void read_index();
  void index_record(unsigned char op, std::string_view body, std::uint64_t byte);
  void schema(std::string_view body, std::uint64_t byte);
  void channel(std::string_view body, std::uint64_t byte);
  std::string why_unreadable(RosChannel& channel, std::string_view encoding, const Schema* schema) const;
  void chunk(std::uint64_t length, std::uint64_t byte);
  std::string_view chunk_records(std::uint64_t length, std::uint64_t byte);
  void records_in_chunk(std::string_view bytes, std::uint64_t byte);
  MessageHead message_head(LogCursor head, std::uint64_t byte);

  LogInput input_;
  RosSink& sink_;
  const Stop& stop_;
  DecompressedBytes decompressed_;
  Decompressor decompressor_;
  std::unordered_map<std::uint16_t, Schema> schemas_;
  std::unordered_map<std::uint16_t, int> channels_;
  std::unordered_map<std::uint64_t, std::vector<std::uint16_t>> chunk_channels_;  // by the chunk's byte
};

bool McapWalk::top_record() {
  if (input_.left() == 0) {
    sink_.notes.push_back(
        fmt::format("{}: no end: its recorder was stopped; all messages up to there are read",
                    shown_path(input_.file())));
    return false;
  }
  const std::uint64_t byte = input_.position();
  const std::string_view head = input_.take(kMcapHead);
  const auto op = static_cast<unsigned char>(head[0]);
  const auto length = little_endian<std::uint64_t>(head.data() + 1);
  if (op == kMcapFooter || op == kMcapDataEnd) return false;
  if (op == kMcapMessage && length >= kMcapMessageHead) {
    input_.require(length);
    const MessageHead m = message_head(cursor(input_.take(kMcapMessageHead), byte, "message"), byte);
    if (m.channel < 0)
      input_.skip(length - kMcapMessageHead);
    else
      sink_.message(m.channel, m.log_ns, input_.take(length - kMcapMessageHead),
                    {&input_.file(), byte, false});
    return true;
  }
  switch (op) {
    case kMcapSchema:
      schema(input_.take(length), byte);
      break;
    case kMcapChannel:
      channel(input_.take(length), byte);
      break;
    case kMcapMessage:
      fail(byte, fmt::format("a message record of {} bytes, expected {} and more", length, kMcapMessageHead));
    case kMcapChunk:
      chunk(length, byte);
      break;
    default:
      input_.skip(length);
  }
  return true;
}

// The records behind the data: schemas, channels and where the chunks are. A recorder that crashed has not
// written them.
void McapWalk::read_index() {
  const std::uint64_t begin = input_.position(), tail = kMcapHead + kMcapFooterBytes + kMcapMagic.size();
  if (input_.left() < tail) return;
  input_.seek(input_.size() - tail);
  const std::string footer(input_.take(tail));
  const auto summary = little_endian<std::uint64_t>(footer.data() + kMcapHead);
  const bool whole = footer[0] == kMcapFooter && footer.substr(tail - kMcapMagic.size()) == kMcapMagic;
  const std::uint64_t end = input_.size() - tail;
  if (whole && summary >= begin && summary < end) {
    input_.seek(summary);
    while (input_.position() < end) {
      const std::uint64_t byte = input_.position();
      const std::string_view head = input_.take(kMcapHead);
      const auto op = static_cast<unsigned char>(head[0]);
      const auto length = little_endian<std::uint64_t>(head.data() + 1);
      if (length > end - input_.position()) fail(byte, fmt::format("a record of {} bytes, too long", length));
      if (op == kMcapSchema || op == kMcapChannel || op == kMcapChunkIndex)
        index_record(op, input_.take(length), byte);
      else
        input_.skip(length);
    }
  }
  input_.seek(begin);
}

void McapWalk::index_record(unsigned char op, std::string_view body, std::uint64_t byte) {
  if (op == kMcapSchema) return schema(body, byte);
  if (op == kMcapChannel) return channel(body, byte);
  if (chunk_channels_.size() >= kMostIndexedChunks) return;
  LogCursor c = cursor(body, byte, "chunk index");
  c.bytes(16);  // first and last time
  const auto chunk = c.number<std::uint64_t>();
  c.bytes(8);  // its length
  LogCursor offsets = cursor(c.text(), byte, "chunk index");
  std::vector<std::uint16_t> channels;
  while (!offsets.rest().empty()) {
    channels.push_back(offsets.number<std::uint16_t>());
    offsets.bytes(8);
  }
  if (!channels.empty()) chunk_channels_[chunk] = std::move(channels);
}

void McapWalk::schema(std::string_view body, std::uint64_t byte) {
  LogCursor c = cursor(body, byte, "schema");
  const auto id = c.number<std::uint16_t>();
  if (schemas_.count(id) != 0) return;
  Schema s;
  s.name = c.text();
  s.encoding = c.text();
  s.text = definition_text(c.text());
  schemas_[id] = std::move(s);
}

void McapWalk::channel(std::string_view body, std::uint64_t byte) {
  LogCursor c = cursor(body, byte, "channel");
  const auto id = c.number<std::uint16_t>();
  if (channels_.count(id) != 0) return;
  const auto schema_id = c.number<std::uint16_t>();
  RosChannel channel;
  channel.topic = c.text();
  const std::string_view encoding = c.text();
  const auto found = schemas_.find(schema_id);
  if (schema_id != 0 && found == schemas_.end())
    fail(byte, fmt::format("channel {}: its schema {} has no record", id, schema_id));
  channel.unreadable = why_unreadable(channel, encoding, schema_id == 0 ? nullptr : &found->second);
  channels_[id] = sink_.channel(channel);
}

std::string McapWalk::why_unreadable(RosChannel& channel, std::string_view encoding,
                                     const Schema* schema) const {
  channel.type = schema != nullptr ? schema->name : std::string(encoding);
  if (encoding == "json") {
    channel.encoding = RosEncoding::Json;
    return "";
  }
  channel.encoding = encoding == "ros1" ? RosEncoding::Ros1 : RosEncoding::Cdr;
  if (encoding != "cdr" && encoding != "ros1")
    return fmt::format("messages are encoded as '{}', expected cdr, ros1 or json", shown(encoding));
  const std::string expected = encoding == "cdr" ? "ros2msg" : "ros1msg";
  if (schema != nullptr && !schema->encoding.empty() && schema->encoding != expected)
    return fmt::format("its definition is written in '{}', expected {}", shown(schema->encoding), expected);
  if (schema != nullptr && !schema->text->empty()) channel.definition = schema->text;
  return "";
}

// Counts the message.
McapWalk::MessageHead McapWalk::message_head(LogCursor head, std::uint64_t byte) {
  const auto id = head.number<std::uint16_t>();
  const auto channel = channels_.find(id);
  if (channel == channels_.end()) fail(byte, fmt::format("a message of channel {}, which has no record", id));
  head.bytes(4);  // its number
  const auto log_ns = static_cast<std::int64_t>(head.number<std::uint64_t>());
  head.bytes(8);  // time of publication
  if ((sink_.seen & 255) == 0) stop_.check();
  ++sink_.seen;
  return {channel->second, log_ns};
}

void McapWalk::chunk(std::uint64_t length, std::uint64_t byte) {
  stop_.check();
  input_.require(length);
  const std::uint64_t end = input_.position() + length;
  if (const auto known = chunk_channels_.find(byte); known != chunk_channels_.end()) {
    bool wanted = false;
    for (const std::uint16_t id : known->second) wanted |= channels_.count(id) == 0 || channels_[id] >= 0;
    if (!wanted) return input_.seek(end);
  }
  records_in_chunk(chunk_records(length, byte), byte);
  if (input_.position() != end) fail(byte, "a chunk whose records end before it does");
}

// Decompressed and checked.
std::string_view McapWalk::chunk_records(std::uint64_t length, std::uint64_t byte) {
  constexpr std::uint64_t kFixed = 32;  // two times, size, crc, length of the compression's name
  if (length < kFixed) fail(byte, "a chunk without its head");
  LogCursor head = cursor(input_.take(kFixed), byte, "chunk");
  head.bytes(16);
  const auto size = head.number<std::uint64_t>();
  const auto crc = head.number<std::uint32_t>();
  const auto name_length = head.number<std::uint32_t>();
  if (length - kFixed < 8 || name_length > length - kFixed - 8) fail(byte, "a chunk without its head");
  const std::string name(input_.take(name_length));
  const auto stored = little_endian<std::uint64_t>(input_.take(8).data());
  if (stored != length - kFixed - 8 - name_length)
    fail(byte, fmt::format("a chunk with {} bytes of records that claims {}",
                           length - kFixed - 8 - name_length, stored));
  const auto compression = log_compression(name);
  if (!compression || *compression == LogCompression::Bz2)
    fail(byte, fmt::format("a chunk compressed by '{}', expected none, lz4 or zstd", shown(name)));
  if (size > kLargestLogRecord)
    throw DataError(fmt::format("{}: chunk at byte {} claims {} bytes, more than {}",
                                shown_path(input_.file()), byte, size, kLargestLogRecord));
  try {
    std::string_view records;
    if (*compression == LogCompression::None) {
      records = input_.take(stored);
    } else {
      decompressor_.begin(*compression, size);
      for (std::uint64_t left = stored; left > 0;) {
        const std::string_view piece = input_.take_some(left);
        decompressor_.put(piece);
        left -= piece.size();
      }
      records = decompressor_.end();
      decompressed_.add(records.size());
    }
    if (records.size() != size)
      throw BadCompression(fmt::format("claims {} bytes and gives {}", size, records.size()));
    const auto* bytes = reinterpret_cast<const Bytef*>(records.data());
    if (crc != 0 && ::crc32_z(0, bytes, records.size()) != crc)
      throw BadCompression("its check sum does not fit its bytes");
    return records;
  } catch (const BadCompression& e) {
    fail(byte, fmt::format("chunk: {}", e.what()));
  }
}

void McapWalk::records_in_chunk(std::string_view bytes, std::uint64_t byte) {
  LogCursor c = cursor(bytes, byte, "a record of the chunk");
  while (!c.rest().empty()) {
    const auto op = c.number<unsigned char>();
    const std::string_view body = c.bytes(c.number<std::uint64_t>());
    if (op == kMcapMessage) {
      if (body.size() < kMcapMessageHead) fail(byte, "a message record without its head");
      const MessageHead m = message_head(cursor(body, byte, "message"), byte);
      if (m.channel >= 0)
        sink_.message(m.channel, m.log_ns, body.substr(kMcapMessageHead), {&input_.file(), byte, false});
    }
    if (op == kMcapSchema) schema(body, byte);
    if (op == kMcapChannel) channel(body, byte);
    if (op == kMcapChunk) fail(byte, "a chunk inside a chunk");
  }
}

class Mcap : public RosContainer {
 public:
  Mcap(const std::filesystem::path& file, const LogOptions& options) : file_(file), options_(options) {}
  const char* format() const override { return "MCAP"; }
  const std::filesystem::path& file() const override { return file_; }
  void walk(RosSink& sink, const Stop& stop) const override { McapWalk(file_, options_, sink, stop).run(); }

 private:
  std::filesystem::path file_;
  LogOptions options_;
};

}  // namespace

bool is_mcap(std::string_view head) {
  return head.substr(0, kMcapMagic.size()) == kMcapMagic;
}

std::unique_ptr<RosContainer> open_mcap(const std::filesystem::path& file, const LogOptions& options) {
  return std::make_unique<Mcap>(file, options);
}

}  // namespace odobench
