// A log of any format as tables: what stands in it, and the columns that somebody asks for.
//
// A log has sources: topics of a bag or of JSON lines, structs of a MAT file, prefixes of an npz file; a
// table has one, called "". A source has rows (messages, lines) and fields. Nothing here knows robots or
// units of signals: clocks, mapping and repair are common to all formats (datasets/import).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"

namespace odobench {

// Text that comes out of a log (names of topics, frames, columns) may hold anything: printable() of
// base/text.hpp before it is shown.
struct LogField {
  std::string
      path;  // "pose.position.x", "position[name=left]", "count[0]", a column's name, "#3" without one
  std::string type;  // "float64", "int32", "string", "time", "quaternion"; "number" or "text" of what is text
  std::string first;  // the first row's value as text, "" where it has none
};

struct LogSource {
  std::string name;
  std::string type;              // message type; "table", "struct", "array" where there is none
  std::vector<LogField> fields;  // numbers, strings and stamps; arrays by their first elements or by name
  std::int64_t rows = 0;
  // Of the log's own clock (receive time), else of the first field that tells time; 0 where nothing does.
  std::int64_t first_ns = 0, last_ns = 0;
  std::int64_t largest_gap_ns = 0;
  // Stamp of the message minus the log's time, median [ns]; nothing where one of the two is missing.
  std::optional<std::int64_t> stamp_minus_log_ns;
  std::string unreadable;  // "" or why its rows cannot be read: "no definition of a/B in this file"
};

struct LogRequest {
  std::string source;
  // The field that tells a row's time; "": as the format has it ("header.stamp" where there is one and it is
  // not 0, else the log's time; the first column that tells time).
  std::string time;
  // Of a time that is a plain number or text: "s", "ms", "us", "ns", "iso8601", or a pattern of strptime with
  // %f for the digits of a second's fraction; "": from its name, type and size.
  std::string time_unit;
  // Numbers of each row: paths as in LogField; "position[name=J]" is looked up by name in every row. A field
  // of type bool gives 0 and 1. A field of type string, named in `text`, is returned as text.
  std::vector<std::string> fields;
  std::vector<std::string> text;
};

struct LogTable {
  // As the file has them, in its order; int64 all the way (1.76e18 ns do not fit in a double).
  std::vector<std::int64_t> time_ns;
  std::vector<std::int64_t> log_time_ns;    // empty where the format has none
  std::vector<std::vector<double>> values;  // one vector per requested field; NaN where a row has no value
  std::vector<std::vector<std::string>> text;
  std::vector<std::string> notes;  // what was passed over or assumed, with counts
};

struct LogOptions {
  bool keep_cut = false;                            // of a file that is cut off, the part before
  std::int64_t max_bytes = std::int64_t{64} << 30;  // decompressed, per file
  std::vector<std::filesystem::path> messages;      // definitions: FILE.msg
  // How tables are written where looking at them does not tell: separator one character, "tab" or "blanks";
  // decimal "." or ","; the characters that begin a comment; encoding "utf-8" or "latin-1".
  std::string separator, decimal, comment, encoding;
  std::optional<int> header_rows;
  std::string plane;  // of the ground in a trajectory: "xy", "zx" (y up), "xz" (camera axes); "": looked at
};

// Refusals are DataError: "FILE: byte N: found ..., expected ...", in tables "FILE:LINE: ...". Memory stays
// within a constant plus what is asked for, whatever the file claims of itself.
class LogFile {
 public:
  virtual ~LogFile() = default;

  virtual std::string format() const = 0;  // "ROS 1 bag", "MCAP", "rosbag2 (sqlite3)", "CSV", ...
  // Reads the file once. In the order of the file (or of its table of topics).
  virtual std::vector<LogSource> sources(const Stop& stop) const = 0;
  // One table per request, the file read once for all. An unknown source or field is a std::invalid_argument
  // that names the nearest one and what there is: "no field 'lefft' in courier_msgs/WheelTicks, did you mean
  // 'left'? it has header.stamp, left, right".
  virtual std::vector<LogTable> read(const std::vector<LogRequest>& requests, const Stop& stop) const = 0;
};

// A reader of one format.
struct LogFormat {
  std::string name;
  // Told by magic bytes and content, never by the file's name (of a folder: by the files in it). `head`: the
  // first 4 kB of the file, empty for a folder.
  bool (*recognises)(const std::filesystem::path& path, const std::string& head);
  std::unique_ptr<LogFile> (*open)(const std::filesystem::path& path, const LogOptions& options);
};

}  // namespace odobench
