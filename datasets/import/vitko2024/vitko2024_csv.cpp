#include "datasets/import/vitko2024/vitko2024_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/text.hpp"
#include "datasets/csv/csv_table.hpp"

namespace odobench::vitko2024 {
namespace {

constexpr char kSeparator = ';';
// Wheels 1 to 4 as the robot's driver names them: front-left, back-left, back-right, front-right.
constexpr std::array<std::string_view, kWheelCount> kWheelNames = {"FL", "BL", "BR", "FR"};
// The yaw formula holds for unit quaternions; a lost body is published as zeros.
constexpr double kNormTolerance = 0.1;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// Calls visit(entry) for the entries of "[a, b]" or "(a, b)".
template <class Visit>
std::size_t for_each_entry(const CsvTable& row, std::size_t column, Visit visit) {
  std::string_view text = trimmed(row.field(column));
  const bool list = text.size() >= 2 && ((text.front() == '[' && text.back() == ']') ||
                                         (text.front() == '(' && text.back() == ')'));
  if (!list)
    row.fail(fmt::format("found {} in column \"{}\", expected a list like (0.0, 1.0)",
                         text.empty() ? "nothing" : fmt::format("\"{}\"", shown(text)),
                         shown(row.name(column))));
  text = text.substr(1, text.size() - 2);
  if (trimmed(text).empty()) return 0;
  std::size_t count = 0;
  for (;;) {
    const std::size_t comma = text.find(',');
    visit(count++, trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return count;
    text.remove_prefix(comma + 1);
  }
}

std::int64_t time_of(const CsvTable& row, std::size_t column) {
  std::int64_t time_us = 0;
  if (!parse_time(row.field(column), time_us))
    row.fail(fmt::format("found \"{}\" in column \"{}\", expected a time like 2024/05/03/12:34:34.823195",
                         shown(row.field(column)), shown(row.name(column))));
  return time_us;
}

// Where in the lists the signals of each wheel stand.
struct WheelMap {
  std::size_t entries = 0;
  std::array<std::size_t, kWheelCount> position{}, wheel{};
};

WheelMap map_names(const CsvTable& row, std::size_t column) {
  constexpr std::size_t absent = static_cast<std::size_t>(-1);
  WheelMap map;
  map.position.fill(absent);
  map.wheel.fill(absent);
  map.entries = for_each_entry(row, column, [&](std::size_t index, std::string_view entry) {
    if (entry.size() >= 2 && (entry.front() == '\'' || entry.front() == '"') && entry.back() == entry.front())
      entry = entry.substr(1, entry.size() - 2);
    std::size_t* slot = nullptr;
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      if (entry.substr(0, 2) != kWheelNames[i]) continue;
      if (entry.substr(2) == "_Position") slot = &map.position[i];
      if (entry.substr(2) == "_Wheel") slot = &map.wheel[i];
    }
    if (slot == nullptr)
      row.fail(fmt::format(
          "found the unknown wheel name \"{}\", expected FL, BL, BR or FR with _Position or _Wheel",
          shown(entry)));
    if (*slot != absent)
      row.fail(fmt::format("found the wheel name \"{}\" twice, expected it once", shown(entry)));
    *slot = index;
  });
  for (std::size_t i = 0; i < kWheelCount; ++i)
    if (map.position[i] == absent || map.wheel[i] == absent)
      row.fail(fmt::format("found no name \"{}{}\", expected all eight", kWheelNames[i],
                           map.position[i] == absent ? "_Position" : "_Wheel"));
  return map;
}

// The numbers of a list, one per name.
void read_list(const CsvTable& row, std::size_t column, std::size_t entries, std::vector<double>& values) {
  values.clear();
  for_each_entry(row, column,
                 [&](std::size_t, std::string_view entry) { values.push_back(row.number(entry, column)); });
  if (values.size() != entries)
    row.fail(fmt::format("found {} entries in column \"{}\", expected {} as there are names", values.size(),
                         shown(row.name(column)), entries));
}

bool digits(std::string_view text, std::size_t at, std::size_t count, int& value) {
  if (text.size() < at + count) return false;
  value = 0;
  for (const char c : text.substr(at, count)) {
    if (c < '0' || c > '9') return false;
    value = 10 * value + (c - '0');
  }
  return true;
}

}  // namespace

bool parse_time(std::string_view text, std::int64_t& time_us) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, fraction = 0;
  constexpr std::size_t whole = 19;  // up to the seconds; a fraction of 1 to 6 digits may follow
  if (!digits(text, 0, 4, year) || !digits(text, 5, 2, month) || !digits(text, 8, 2, day) ||
      !digits(text, 11, 2, hour) || !digits(text, 14, 2, minute) || !digits(text, 17, 2, second))
    return false;
  if (text[4] != '/' || text[7] != '/' || text[10] != '/' || text[13] != ':' || text[16] != ':') return false;
  if (text.size() > whole) {
    const std::size_t places = text.size() - whole - 1;
    if (text[whole] != '.' || places < 1 || places > 6 || !digits(text, whole + 1, places, fraction))
      return false;
    for (std::size_t k = places; k < 6; ++k) fraction *= 10;
  }
  namespace chrono = std::chrono;
  const chrono::year_month_day date{chrono::year(year), chrono::month(static_cast<unsigned>(month)),
                                    chrono::day(static_cast<unsigned>(day))};
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) return false;
  const std::int64_t days = chrono::sys_days(date).time_since_epoch().count();
  time_us = ((days * 24 + hour) * 60 + minute) * 60 + second;
  time_us = time_us * 1'000'000 + fraction;
  return true;
}

namespace {

bool is_nan(std::string_view field) {
  return field.size() == 3 && (field[0] | 0x20) == 'n' && (field[1] | 0x20) == 'a' &&
         (field[2] | 0x20) == 'n';
}

// The columns of a pose.
struct PoseColumns {
  std::size_t x, y, qx, qy, qz, qw;
};

struct CapturedPose {
  double x, y, yaw;
};

// Nothing where the tracking was lost and such samples are to be left out.
std::optional<CapturedPose> captured_pose(const CsvTable& row, const PoseColumns& at, bool drop_lost) {
  const auto fields = {at.x, at.y, at.qx, at.qy, at.qz, at.qw};
  if (drop_lost &&
      std::any_of(fields.begin(), fields.end(), [&](std::size_t c) { return is_nan(row.field(c)); }))
    return std::nullopt;
  const double x = row.number(at.x), y = row.number(at.y);
  const double i = row.number(at.qx), j = row.number(at.qy), k = row.number(at.qz), w = row.number(at.qw);
  const double norm = std::sqrt(i * i + j * j + k * k + w * w);
  if (std::abs(norm - 1) <= kNormTolerance)
    return CapturedPose{x, y, std::atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))};
  if (drop_lost) return std::nullopt;
  row.fail(fmt::format(
      "found an orientation quaternion of norm {:.4g}, expected 1 (within {}); --drop-lost leaves "
      "out samples whose tracking was lost",
      norm, kNormTolerance));
}

}  // namespace

CaptureLog parse_capture(std::string_view text, const std::string& file, bool drop_lost) {
  CsvTable row(text, file, kSeparator);
  const std::size_t time = row.column("time");
  const PoseColumns pose{row.column(".pose.position.x"),    row.column(".pose.position.y"),
                         row.column(".pose.orientation.x"), row.column(".pose.orientation.y"),
                         row.column(".pose.orientation.z"), row.column(".pose.orientation.w")};
  CaptureLog log;
  const std::size_t rows = row.rows_left_at_most();
  log.time_us.reserve(rows);
  for (auto* values : {&log.x, &log.y, &log.yaw}) values->reserve(rows);
  while (row.next()) {
    const std::int64_t stamp = time_of(row, time);
    const std::optional<CapturedPose> seen = captured_pose(row, pose, drop_lost);
    if (!seen) {
      ++log.lost;
      continue;
    }
    log.time_us.push_back(stamp);
    log.lines.rows.push_back(row.line());
    log.x.push_back(seen->x);
    log.y.push_back(seen->y);
    log.yaw.push_back(seen->yaw);
  }
  log.lines.header = row.header_line();
  log.lines.unfinished = row.unfinished();
  return log;
}

WheelLog parse_wheels(std::string_view text, const std::string& file) {
  CsvTable row(text, file, kSeparator);
  const std::size_t time = row.column("time"), names = row.column(".name"),
                    position = row.column(".position"), velocity = row.column(".velocity");
  WheelLog log;
  const std::size_t rows = row.rows_left_at_most();
  log.time_us.reserve(rows);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    log.steering[i].reserve(rows);
    log.wheel_speed[i].reserve(rows);
  }
  std::string mapped_names;  // the names of the row that map was made for
  WheelMap map;
  std::vector<double> values;
  while (row.next()) {
    log.time_us.push_back(time_of(row, time));
    log.lines.rows.push_back(row.line());
    if (row.field(names) != mapped_names || mapped_names.empty()) {
      map = map_names(row, names);
      mapped_names = row.field(names);
    }
    read_list(row, position, map.entries, values);
    for (std::size_t i = 0; i < kWheelCount; ++i) log.steering[i].push_back(values[map.position[i]]);
    read_list(row, velocity, map.entries, values);
    for (std::size_t i = 0; i < kWheelCount; ++i) log.wheel_speed[i].push_back(values[map.wheel[i]]);
  }
  log.lines.header = row.header_line();
  log.lines.unfinished = row.unfinished();
  return log;
}

}  // namespace odobench::vitko2024
