#include "tests/support/log_writers.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

namespace odobench::testing {
namespace {

constexpr const char* kTicks = "std_msgs/Header header\nint32 left\nint32 right\n";

// Definitions as recorders write them: all types behind the main one.
std::string text_bytes(std::string_view text) {
  return number_bytes(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

}  // namespace

std::string full_definition(const std::string& main, RosEncoding encoding,
                            const std::vector<std::string>& parts) {
  std::string text = main;
  for (const std::string& part : parts) {
    std::string layout(standard_message(part));
    if (part == "std_msgs/Header" && encoding == RosEncoding::Ros1)
      layout = "uint32 seq\ntime stamp\nstring frame_id";
    text += fmt::format("\n{}\nMSG: {}\n{}\n", std::string(80, '='), part, layout);
  }
  return text;
}

MessageBytes::MessageBytes(RosEncoding encoding, bool big_endian)
    : encoding_(encoding), big_endian_(big_endian) {
  if (encoding == RosEncoding::Cdr) bytes_ = std::string("\0\1\0\0", 4);
  if (big_endian) bytes_[1] = '\0';
}

MessageBytes& MessageBytes::text(std::string_view value) {
  const bool end = encoding_ == RosEncoding::Cdr;
  count(value.size() + (end ? 1 : 0));
  bytes_ += value;
  if (end) bytes_ += '\0';
  return *this;
}

MessageBytes& MessageBytes::numbers(const std::vector<double>& values) {
  count(values.size());
  for (const double value : values) number(value);
  return *this;
}

MessageBytes& MessageBytes::texts(const std::vector<std::string>& values) {
  count(values.size());
  for (const std::string& value : values) text(value);
  return *this;
}

MessageBytes& MessageBytes::stamp(std::int64_t ns) {
  number(static_cast<std::uint32_t>(ns / 1'000'000'000));
  return number(static_cast<std::uint32_t>(ns % 1'000'000'000));
}

MessageBytes& MessageBytes::header(std::int64_t ns, std::string_view frame) {
  if (encoding_ == RosEncoding::Ros1) number(std::uint32_t{17});
  return stamp(ns).text(frame);
}

WrittenLog small_log(RosEncoding encoding) {
  WrittenLog log;
  log.encoding = encoding;
  const std::vector<std::string> transform{"geometry_msgs/TransformStamped", "std_msgs/Header",
                                           "geometry_msgs/Transform", "geometry_msgs/Vector3",
                                           "geometry_msgs/Quaternion"};
  const std::string middle = encoding == RosEncoding::Ros1 ? "/" : "/msg/";
  log.channels = {
      {"/ticks", "test_msgs" + middle + "Ticks", full_definition(kTicks, encoding, {"std_msgs/Header"})},
      {"/joints", "sensor_msgs" + middle + "JointState",
       full_definition(std::string(standard_message("sensor_msgs/JointState")), encoding,
                       {"std_msgs/Header"})},
      {"/tf", "tf2_msgs" + middle + "TFMessage",
       full_definition("geometry_msgs/TransformStamped[] transforms", encoding, transform)}};
  for (int k = 0; k < kSmallLogMessages; ++k) {
    const std::int64_t stamp = kSmallLogBegin + k * kSmallLogStep;
    const auto add = [&](std::size_t channel, const MessageBytes& message) {
      log.messages.push_back({channel, stamp + kSmallLogDelay, message.bytes()});
    };
    MessageBytes ticks(encoding);
    ticks.header(stamp, std::string(static_cast<std::size_t>(k % 5), 'f')).number(k).number(-2 * k);
    add(0, ticks);
    MessageBytes joints(encoding);
    joints.header(stamp, "");
    if (k % 3 == 0)
      joints.texts({"left", "right"}).numbers({k / 2.0, k / 4.0}).numbers({1, 2});
    else if (k % 3 == 1)
      joints.texts({"right", "left"}).numbers({k / 4.0, k / 2.0}).numbers({2, 1});
    else
      joints.texts({"arm"}).numbers({9}).numbers({});
    add(1, joints.numbers({}));
    MessageBytes tf(encoding);
    tf.count(2);
    for (const bool odom : {false, true}) {
      tf.header(stamp, odom ? "odom" : "map").text(odom ? "base" : "odom");
      for (const double value : {odom ? k / 8.0 : 7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) tf.number(value);
    }
    add(2, tf);
  }
  return log;
}

std::string compressed(std::string_view compression, std::string_view bytes) {
  if (compression == "none") return std::string(bytes);
  std::string out(bytes.size() + bytes.size() / 8 + 1024, '\0');
  if (compression == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    if (BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                                 static_cast<unsigned>(bytes.size()), 9, 0, 0) != BZ_OK)
      throw std::runtime_error("bz2");
    out.resize(size);
  } else if (compression == "lz4") {
    out.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else {
    out.resize(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  }
  return out;
}

std::string bag_record(const std::vector<std::pair<std::string, std::string>>& header,
                       std::string_view data) {
  std::string fields;
  for (const auto& [name, value] : header) fields += text_bytes(name + "=" + value);
  return text_bytes(fields) + text_bytes(data);
}

namespace {

std::string bag_connection(const WrittenLog& log, std::size_t i) {
  const WrittenChannel& c = log.channels[i];
  std::string data;
  for (const std::string& field :
       {"topic=" + c.topic, "type=" + c.type, std::string("md5sum=*"), "message_definition=" + c.definition})
    data += text_bytes(field);
  return bag_record(
      {{"op", "\x07"}, {"conn", number_bytes(static_cast<std::uint32_t>(i))}, {"topic", c.topic}}, data);
}

}  // namespace

std::string bag_bytes(const WrittenLog& log, const std::string& compression, std::size_t per_chunk) {
  std::string bytes = "#ROSBAG V2.0\n" + bag_record({{"op", "\x03"}}, std::string(100, ' ')), chunk;
  std::set<std::size_t> written;
  std::size_t in_chunk = 0;
  const auto flush = [&] {
    if (chunk.empty()) return;
    bytes += per_chunk == 0 ? chunk
                            : bag_record({{"op", "\x05"},
                                          {"compression", compression},
                                          {"size", number_bytes(static_cast<std::uint32_t>(chunk.size()))}},
                                         compressed(compression, chunk));
    chunk.clear();
    in_chunk = 0;
  };
  for (const WrittenMessage& m : log.messages) {
    if (written.insert(m.channel).second) chunk += bag_connection(log, m.channel);
    const std::string time = number_bytes(static_cast<std::uint32_t>(m.log_ns / 1'000'000'000)) +
                             number_bytes(static_cast<std::uint32_t>(m.log_ns % 1'000'000'000));
    chunk += bag_record(
        {{"op", "\x02"}, {"conn", number_bytes(static_cast<std::uint32_t>(m.channel))}, {"time", time}},
        m.data);
    if (++in_chunk >= std::max<std::size_t>(per_chunk, 1)) flush();
  }
  flush();
  for (std::size_t i = 0; i < log.channels.size(); ++i) bytes += bag_connection(log, i);
  return bytes;
}

std::string mcap_record(unsigned char op, std::string_view body) {
  return std::string(1, static_cast<char>(op)) + number_bytes(static_cast<std::uint64_t>(body.size())) +
         std::string(body);
}

namespace {

// Schemas and channels; their numbers begin with 1.
std::string mcap_channels(const WrittenLog& log, const McapOptions& options) {
  std::string bytes;
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    const WrittenChannel& c = log.channels[i];
    const std::string id = number_bytes(static_cast<std::uint16_t>(i + 1));
    bytes += mcap_record(
        3, id + text_bytes(c.type) + text_bytes(options.schema_encoding) + text_bytes(c.definition));
    bytes +=
        mcap_record(4, id + id + text_bytes(c.topic) + text_bytes(options.message_encoding) + text_bytes(""));
  }
  return bytes;
}

std::string mcap_chunk(const std::string& records, const McapOptions& options) {
  const auto crc =
      options.crc ? ::crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()) : 0;
  const std::string stored = compressed(options.compression, records);
  return mcap_record(6, std::string(16, '\0') + number_bytes(static_cast<std::uint64_t>(records.size())) +
                            number_bytes(static_cast<std::uint32_t>(crc)) +
                            text_bytes(options.compression == "none" ? "" : options.compression) +
                            number_bytes(static_cast<std::uint64_t>(stored.size())) + stored);
}

}  // namespace

std::string mcap_bytes(const WrittenLog& log, const McapOptions& options) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string bytes = magic + mcap_record(1, text_bytes("ros2") + text_bytes("test")), chunk, indexes;
  bytes += mcap_record(0x90, "private") + mcap_channels(log, options);
  std::set<std::size_t> in_chunk;
  std::size_t count = 0;
  const auto flush = [&] {
    if (count == 0) return;
    std::string offsets;
    for (const std::size_t c : in_chunk)
      offsets += number_bytes(static_cast<std::uint16_t>(c + 1)) + std::string(8, '\0');
    const std::string record = options.per_chunk == 0 ? chunk : mcap_chunk(chunk, options);
    indexes +=
        mcap_record(8, std::string(16, '\0') + number_bytes(static_cast<std::uint64_t>(bytes.size())) +
                           number_bytes(static_cast<std::uint64_t>(record.size())) + text_bytes(offsets) +
                           std::string(8, '\0') + text_bytes("") + std::string(16, '\0'));
    bytes += record;
    chunk.clear();
    in_chunk.clear();
    count = 0;
  };
  for (const WrittenMessage& m : log.messages) {
    chunk += mcap_record(5, number_bytes(static_cast<std::uint16_t>(m.channel + 1)) + std::string(4, '\0') +
                                number_bytes(m.log_ns) + std::string(8, '\0') + m.data);
    in_chunk.insert(m.channel);
    if (++count >= std::max<std::size_t>(options.per_chunk, 1)) flush();
  }
  flush();
  if (!options.footer) return bytes;
  bytes += mcap_record(15, std::string(4, '\0'));
  const std::uint64_t summary = options.index ? bytes.size() : 0;
  if (options.index) bytes += mcap_channels(log, options) + (options.per_chunk > 0 ? indexes : "");
  return bytes + mcap_record(2, number_bytes(summary) + std::string(12, '\0')) + magic;
}

namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;

Database open_database(const std::filesystem::path& file) {
  sqlite3* db = nullptr;
  if (sqlite3_open(file.c_str(), &db) != SQLITE_OK) throw std::runtime_error("sqlite3_open");
  return {db, sqlite3_close};
}

void execute(sqlite3* db, const std::string& statements) {
  if (sqlite3_exec(db, statements.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(db));
}

// One row; text and blobs are all that is not an int64.
void insert(sqlite3* db, const std::string& statement, const std::vector<std::int64_t>& integers,
            const std::vector<std::string>& others, bool blob) {
  sqlite3_stmt* s = nullptr;
  sqlite3_prepare_v2(db, statement.c_str(), -1, &s, nullptr);
  int column = 1;
  for (const std::int64_t value : integers) sqlite3_bind_int64(s, column++, value);
  for (const std::string& value : others) {
    const auto size = static_cast<int>(value.size());
    if (blob)
      sqlite3_bind_blob(s, column++, value.data(), size, SQLITE_STATIC);
    else
      sqlite3_bind_text(s, column++, value.data(), size, SQLITE_STATIC);
  }
  const int result = sqlite3_step(s);
  sqlite3_finalize(s);
  if (result != SQLITE_DONE) throw std::runtime_error(sqlite3_errmsg(db));
}

}  // namespace

void run_sql(const std::filesystem::path& file, const std::string& statements) {
  execute(open_database(file).get(), statements);
}

void write_rosbag2(const std::filesystem::path& file, const WrittenLog& log, const Rosbag2Options& options) {
  const Database db = open_database(file);
  execute(
      db.get(),
      "BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL DEFAULT ''); "
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL); CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
  if (options.definitions)
    execute(db.get(),
            "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding "
            "TEXT NOT "
            "NULL, encoded_message_definition TEXT NOT NULL);");
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    const WrittenChannel& c = log.channels[i];
    insert(db.get(), "INSERT INTO topics(id, name, type, serialization_format) VALUES(?,?,?,'cdr')",
           {static_cast<std::int64_t>(i + 1)}, {c.topic, c.type}, false);
    if (options.definitions)
      insert(db.get(),
             "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition) "
             "VALUES(?,'ros2msg',?)",
             {}, {c.type, c.definition}, false);
  }
  for (const WrittenMessage& m : log.messages)
    insert(db.get(), "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)",
           {static_cast<std::int64_t>(m.channel + 1), m.log_ns},
           {options.compress_messages ? compressed("zstd", m.data) : m.data}, true);
  execute(db.get(), "COMMIT;");
}

}  // namespace odobench::testing
