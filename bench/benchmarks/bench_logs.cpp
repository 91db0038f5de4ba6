// Speed of reading logs: bytes of messages per second, with the values of three topics decoded, on recordings
// that are made for it in the temporary folder and removed again.
//   bench_logs [--size=MB] [Google Benchmark's flags]        200 MB of messages by default
// Joint states and poses in turns, every 17th message an unwanted cloud of points of 4 kB.
// bytes_per_second: of messages of all topics. One core.
#include <benchmark/benchmark.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "datasets/logs/ros/ros_logs.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void put_text(std::string& to, const std::string& text) {
  put(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}

// Fields of a message, aligned as CDR wants it or packed as ROS 1 does.
struct Serialiser {
  bool cdr;
  std::string bytes = cdr ? std::string("\0\1\0\0", 4) : std::string();
  template <class T>
  void number(T value) {
    while (cdr && (bytes.size() - 4) % sizeof value != 0) bytes += '\0';
    put(bytes, value);
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + (cdr ? 1 : 0)));
    bytes += value;
    if (cdr) bytes += '\0';
  }
  void header(std::int64_t ns, const std::string& frame) {
    if (!cdr) number(std::uint32_t{0});
    number(static_cast<std::uint32_t>(ns / 1'000'000'000));
    number(static_cast<std::uint32_t>(ns % 1'000'000'000));
    text(frame);
  }
};

const std::vector<std::string> kTopics{"/joint_states", "/mocap/pose", "/points"};

std::string definition(std::size_t topic, bool cdr) {
  const std::string header = cdr ? "std_msgs/Header header\n" : "Header header\n";
  const std::string body[] = {"string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
                              "float64 x\nfloat64 y\nfloat64 z\nfloat64[4] q\n", "uint8[] data\n"};
  const std::string seconds = cdr ? "builtin_interfaces/Time stamp" : "uint32 seq\ntime stamp";
  return header + body[topic] + std::string(80, '=') + "\nMSG: std_msgs/Header\n" + seconds +
         "\nstring frame_id\n";
}

// Message k of the recording, and its topic.
std::string message(std::size_t k, bool cdr, std::size_t& topic) {
  static std::mt19937 random(1);
  const std::int64_t stamp = 1'760'000'000'000'000'000 + static_cast<std::int64_t>(k) * 2'500'000;
  const double t = 1e-3 * static_cast<double>(k);
  topic = k % 17 == 16 ? 2 : k % 2;
  Serialiser s{cdr};
  s.header(stamp, topic == 0 ? "" : "world");
  if (topic == 0) {
    s.number(std::uint32_t{4});
    for (const char* name : {"left_wheel_joint", "right_wheel_joint", "caster_joint", "lift_joint"})
      s.text(name);
    for (const double speed : {1.0, 0.1}) {
      s.number(std::uint32_t{4});
      for (int i = 0; i < 4; ++i) s.number(speed * std::sin(t + i));
    }
    s.number(std::uint32_t{0});
  } else if (topic == 1) {
    for (int i = 0; i < 7; ++i) s.number(std::cos(t + i));
  } else {
    std::string points(4000, '\0');
    for (char& c : points) c = static_cast<char>(random() % 16);
    s.number(static_cast<std::uint32_t>(points.size()));
    s.bytes += points;
  }
  return std::move(s.bytes);
}

std::string lz4(const std::string& bytes) {
  std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}
std::string zstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

// A record of a bag: fields of its header by name, then the data.
std::string bag_record(const std::vector<std::pair<std::string, std::string>>& fields,
                       const std::string& data) {
  std::string header, record;
  for (const auto& [name, value] : fields) put_text(header, name + "=" + value);
  put_text(record, header);
  put_text(record, data);
  return record;
}
template <class T>
std::string bytes_of(T value) {
  std::string bytes;
  put(bytes, value);
  return bytes;
}
std::string mcap_record(char op, const std::string& body) {
  return op + bytes_of(static_cast<std::uint64_t>(body.size())) + body;
}

struct Recording {
  fs::path file;
  std::int64_t bytes = 0;  // of messages
};

constexpr std::size_t kChunk = 768 << 10;

Recording write_bag(const fs::path& file, std::int64_t size, bool compress) {
  Recording r{file};
  std::ofstream out(file, std::ios::binary);
  out << "#ROSBAG V2.0\n";
  std::string chunk;
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    std::string data;
    put_text(data, "type=bench_msgs/T" + std::to_string(i));
    put_text(data, "message_definition=" + definition(i, false));
    chunk += bag_record(
        {{"op", "\x07"}, {"conn", bytes_of(static_cast<std::uint32_t>(i))}, {"topic", kTopics[i]}}, data);
  }
  for (std::size_t k = 0; r.bytes < size; ++k) {
    std::size_t topic = 0;
    const std::string data = message(k, false, topic);
    r.bytes += static_cast<std::int64_t>(data.size());
    chunk += bag_record({{"op", "\x02"},
                         {"conn", bytes_of(static_cast<std::uint32_t>(topic))},
                         {"time", bytes_of(static_cast<std::uint64_t>(k))}},
                        data);
    if (chunk.size() < kChunk && r.bytes < size) continue;
    out << bag_record({{"op", "\x05"},
                       {"compression", compress ? "lz4" : "none"},
                       {"size", bytes_of(static_cast<std::uint32_t>(chunk.size()))}},
                      compress ? lz4(chunk) : chunk);
    chunk.clear();
  }
  return r;
}

Recording write_mcap(const fs::path& file, std::int64_t size, const std::string& compression) {
  Recording r{file};
  std::ofstream out(file, std::ios::binary);
  out << std::string("\x89MCAP0\r\n", 8);
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    std::string schema = bytes_of(static_cast<std::uint16_t>(i + 1)), channel = schema + schema;
    put_text(schema, "bench_msgs/msg/T" + std::to_string(i));
    put_text(schema, "ros2msg");
    put_text(schema, definition(i, true));
    put_text(channel, kTopics[i]);
    put_text(channel, "cdr");
    put_text(channel, "");
    out << mcap_record(3, schema) << mcap_record(4, channel);
  }
  std::string chunk;
  for (std::size_t k = 0; r.bytes < size; ++k) {
    std::size_t topic = 0;
    const std::string data = message(k, true, topic);
    r.bytes += static_cast<std::int64_t>(data.size());
    chunk += mcap_record(5, bytes_of(static_cast<std::uint16_t>(topic + 1)) + std::string(20, '\0') + data);
    if (chunk.size() < kChunk && r.bytes < size) continue;
    const std::string stored = compression == "lz4"    ? lz4(chunk)
                               : compression == "zstd" ? zstd(chunk)
                                                       : chunk;
    std::string body =
        std::string(16, '\0') + bytes_of(static_cast<std::uint64_t>(chunk.size())) + std::string(4, '\0');
    put_text(body, compression);
    out << mcap_record(6, body + bytes_of(static_cast<std::uint64_t>(stored.size())) + stored);
    chunk.clear();
  }
  out << mcap_record(15, std::string(4, '\0'));
  return r;
}

Recording write_rosbag2(const fs::path& file, std::int64_t size, bool compress) {
  Recording r{file};
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  std::string make =
      "BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
      "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type, encoding, "
      "encoded_message_definition);";
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    const std::string n = std::to_string(i), type = "'bench_msgs/msg/T" + n + "'";
    make += "INSERT INTO topics VALUES(" + n + ", '" + kTopics[i] + "', " + type + ", 'cdr');";
    make += "INSERT INTO message_definitions VALUES(" + n + ", " + type + ", 'ros2msg', '" +
            definition(i, true) + "');";
  }
  sqlite3_exec(db, make.c_str(), nullptr, nullptr, nullptr);
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(db, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &row, nullptr);
  for (std::size_t k = 0; r.bytes < size; ++k) {
    std::size_t topic = 0;
    const std::string data = message(k, true, topic), stored = compress ? zstd(data) : data;
    r.bytes += static_cast<std::int64_t>(data.size());
    sqlite3_bind_int64(row, 1, static_cast<sqlite3_int64>(topic));
    sqlite3_bind_int64(row, 2, static_cast<sqlite3_int64>(k));
    sqlite3_bind_blob(row, 3, stored.data(), static_cast<int>(stored.size()), SQLITE_STATIC);
    sqlite3_step(row);
    sqlite3_reset(row);
  }
  sqlite3_finalize(row);
  sqlite3_exec(db, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(db);
  return r;
}

void add(const std::string& name, const std::function<Recording()>& write) {
  const auto read = [write](benchmark::State& state) {
    const Recording recording = write();
    LogRequest joints, pose;
    joints.source = kTopics[0];
    joints.fields = {"position[name=left_wheel_joint]", "position[name=right_wheel_joint]"};
    pose.source = kTopics[1];
    pose.fields = {"x", "y", "q[2]", "q[3]"};
    std::size_t rows = 0;
    for (auto _ : state) {
      const auto log = open_ros_recording({recording.file}, {});
      const std::vector<LogTable> tables = log->read({joints, pose}, {});
      rows = tables[0].time_ns.size() + tables[1].time_ns.size();
      benchmark::DoNotOptimize(rows);
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * recording.bytes);
    state.counters["rows"] = static_cast<double>(rows);
    fs::remove(recording.file);
  };
  benchmark::RegisterBenchmark(name.c_str(), read)->Unit(benchmark::kMillisecond)->Iterations(3);
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  using namespace odobench;
  std::int64_t size = 200 << 20;
  for (int i = 1; i < argc; ++i)
    if (std::strncmp(argv[i], "--size=", 7) == 0) {
      size = std::int64_t{std::atoi(argv[i] + 7)} << 20;
      std::rotate(argv + i, argv + i + 1, argv + argc--);
      --i;
    }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::string folder = (fs::temp_directory_path() / "odobench-logs-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return 3;
  const fs::path at = folder;
  for (const bool compress : {false, true})
    add(compress ? "bag/lz4" : "bag/none", [=] { return write_bag(at / "drive.bag", size, compress); });
  for (const char* compression : {"", "lz4", "zstd"})
    add(std::string("mcap/") + (*compression == '\0' ? "none" : compression),
        [=] { return write_mcap(at / "drive.mcap", size, compression); });
  for (const bool compress : {false, true})
    add(compress ? "rosbag2/zstd_message" : "rosbag2/none",
        [=] { return write_rosbag2(at / "drive.db3", size, compress); });
  benchmark::RunSpecifiedBenchmarks();
  fs::remove_all(at);
  return 0;
}
