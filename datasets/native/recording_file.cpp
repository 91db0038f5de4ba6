#include "datasets/native/recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/json_node.hpp"
#include "base/sha256.hpp"
#include "datasets/native/columns.hpp"

namespace odobench {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kLongestHeader = 64 * 1024;
constexpr std::size_t kEntryBytes = 8;
constexpr std::string_view kRecordingFormat = "odobench-recording";

static_assert(sizeof(double) == kEntryBytes && sizeof(std::int64_t) == kEntryBytes);
static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

template <class T>
void reverse_bytes(T* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    char* bytes = reinterpret_cast<char*>(values + i);
    std::reverse(bytes, bytes + kEntryBytes);
  }
}

template <class T>
void append(std::string& out, std::vector<T> values) {
  if constexpr (std::endian::native == std::endian::big) reverse_bytes(values.data(), values.size());
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * kEntryBytes);
}

template <class T>
void extract(std::string_view bytes, std::vector<T>& values) {
  values.resize(bytes.size() / kEntryBytes);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  if constexpr (std::endian::native == std::endian::big) reverse_bytes(values.data(), values.size());
}

// Ids and column names need no escapes: validate_dataset() restricts ids to letters, digits, '_', '-' and
// '.'.
std::string header(const Recording& recording, int schema) {
  std::string line =
      fmt::format(R"({{"format": "{}", "version": {}, "id": "{}", "samples": {}, "columns": [)",
                  kRecordingFormat, schema, recording.id, recording.size());
  line += R"({"name": "time_us", "unit": "us", "type": "int64"})";
  for_each_value_column(
      recording, schema, [&](const std::string& name, const char* unit, const std::vector<double>&) {
        line += fmt::format(R"(, {{"name": "{}", "unit": "{}", "type": "float64"}})", name, unit);
      });
  line += "]}";
  line.append(kAlignment - 1 - line.size() % kAlignment, ' ');
  return line + "\n";
}

void check_columns(const JsonNode& columns, const Recording& recording, int schema) {
  const std::vector<JsonNode> found = columns.elements();
  if (found.size() != 1 + value_columns(recording))
    columns.fail(fmt::format("{} columns", found.size()), fmt::format("{}", 1 + value_columns(recording)));
  std::size_t next = 0;
  const auto check = [&](const std::string& name, const char* unit, const char* type) {
    const JsonNode& column = found[next++];
    column.allow_only({"name", "unit", "type"});
    const auto member = [&](const char* key, const std::string& expected) {
      const JsonNode value = column.at(key);
      if (value.text() != expected) value.fail('"' + value.text() + '"', '"' + expected + '"');
    };
    member("name", name);
    member("unit", unit);
    member("type", type);
  };
  check("time_us", "us", "int64");
  for_each_value_column(recording, schema,
                        [&](const std::string& name, const char* unit, const std::vector<double>&) {
                          check(name, unit, "float64");
                        });
}

// Returns the length of the header line.
std::size_t check_header(std::string_view bytes, const ExpectedRecording& expected,
                         const Recording& recording) {
  const std::size_t newline = bytes.substr(0, kLongestHeader).find('\n');
  if (newline == std::string_view::npos)
    throw DataError(fmt::format("{}: byte {}: found no end of the header line, expected one line of JSON",
                                expected.file, std::min(bytes.size(), kLongestHeader)));
  const JsonNode root = JsonNode::parse(bytes.substr(0, newline), expected.file);
  const JsonNode format = root.at("format");
  if (format.text() != kRecordingFormat)
    format.fail('"' + format.text() + '"', fmt::format("\"{}\"", kRecordingFormat));
  const JsonNode version = root.at("version");
  if (version.integer() != expected.schema)
    version.fail(fmt::format("version {}", version.integer()), fmt::format("version {}", expected.schema));
  root.allow_only({"format", "version", "id", "samples", "columns"});
  if (root.at("id").text() != recording.id)
    root.at("id").fail('"' + root.at("id").text() + '"', '"' + recording.id + '"');
  const JsonNode samples = root.at("samples");
  if (samples.integer() < 0 || static_cast<std::size_t>(samples.integer()) != expected.samples)
    samples.fail(fmt::format("{} samples", samples.integer()),
                 fmt::format("{} as in the set", expected.samples));
  check_columns(root.at("columns"), recording, expected.schema);
  return newline + 1;
}

}  // namespace

std::string encode_recording(const Recording& sparse, int schema) {
  const Recording recording = with_reference_everywhere(sparse);
  std::string bytes = header(recording, schema);
  bytes.reserve(bytes.size() + (1 + value_columns(recording)) * kEntryBytes * recording.size());
  append(bytes, recording.time_us);
  for_each_value_column(
      recording, schema,
      [&](const std::string&, const char*, const std::vector<double>& v) { append(bytes, v); });
  return bytes;
}

void decode_recording(std::string_view bytes, const ExpectedRecording& expected, Recording& recording) {
  const std::size_t start = check_header(bytes, expected, recording);
  // Divided, not multiplied: a stated number of samples may be absurd.
  const std::size_t row = (1 + value_columns(recording)) * kEntryBytes;
  const std::size_t body = bytes.size() - start;
  if (body % row != 0 || body / row != expected.samples)
    throw DataError(fmt::format(
        "{}: byte {}: found the end of the file after {} bytes of columns, expected {} samples of {} bytes",
        expected.file, bytes.size(), body, expected.samples, row));
  const std::string sum = sha256(bytes);
  if (sum != expected.sha256)
    throw DataError(
        fmt::format("{}: found SHA-256 {}, expected {} as in the set", expected.file, sum, expected.sha256));

  const std::size_t column = expected.samples * kEntryBytes;
  std::size_t offset = start;
  extract(bytes.substr(offset, column), recording.time_us);
  for_each_value_column(recording, expected.schema,
                        [&](const std::string&, const char*, std::vector<double>& values) {
                          offset += column;
                          extract(bytes.substr(offset, column), values);
                        });
  if (expected.schema > 1) drop_missing_reference(recording);
  const std::optional<ColumnFault> fault = find_fault(recording, expected.schema);
  if (!fault) return;
  std::size_t index = 0, next = 1;
  for_each_value_column(recording, expected.schema,
                        [&](const std::string& name, const char*, const std::vector<double>&) {
                          if (name == fault->column) index = next;
                          ++next;
                        });
  const std::size_t byte = start + index * column + fault->sample.value_or(0) * kEntryBytes;
  throw DataError(fmt::format("{}: byte {} ({}, sample {}): {}", expected.file, byte, fault->column,
                              fault->sample.value_or(0), fault->what));
}

}  // namespace odobench
