#include "datasets/logs/tables/trajectories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/files.hpp"
#include "datasets/csv/decimal_number.hpp"
#include "datasets/logs/tables/ground_plane.hpp"
#include "datasets/logs/tables/table_log.hpp"
#include "datasets/logs/tables/table_rows.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using Numbers = std::vector<std::vector<double>>;

// The first rows, where all of them are `least` to `most` numbers and nothing else stands in the file but
// comments; else nothing.
Numbers rows_of_numbers(const fs::path& file, char separator, std::size_t least, std::size_t most) {
  const TableHead head = read_table_head(file, "#%");
  Numbers numbers;
  for (const std::vector<std::string>& row : head.rows(separator)) {
    if (row.size() < least || row.size() > most) return {};
    std::vector<double> values;
    for (const std::string& field : row) {
      const std::optional<double> value = decimal_number(field, '.');
      if (!value || !std::isfinite(*value)) return {};
      values.push_back(*value);
    }
    numbers.push_back(values);
  }
  return numbers;
}

// Four numbers from `at` on are a quaternion of length 1 in every row.
bool has_quaternion(const Numbers& rows, std::size_t at) {
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [&](const std::vector<double>& row) {
    double sum = 0;
    for (std::size_t i = at; i < at + 4; ++i) sum += row[i] * row[i];
    return std::abs(sum - 1) < 0.02;
  });
}

bool has_rotation_matrix(const Numbers& rows) {
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const std::vector<double>& row) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        double dot = 0;
        for (std::size_t j = 0; j < 3; ++j) dot += row[4 * i + j] * row[4 * k + j];
        if (std::abs(dot - (i == k ? 1 : 0)) > 0.02) return false;
      }
    return true;
  });
}

bool increasing(const Numbers& rows) {
  return std::is_sorted(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
}

TableLayout layout_of(const std::string& format, const GroundPlane& plane, char separator,
                      std::vector<std::string> names) {
  TableLayout layout;
  layout.format = format;
  layout.separator = separator;
  layout.names = std::move(names);
  layout.sources.resize(1);
  layout.sources[0].type = fmt::format("trajectory ({}, plane {})", format, plane.name);
  return layout;
}

std::string plane_or(const LogOptions& options, const char* usual) {
  return options.plane.empty() ? usual : options.plane;
}

bool is_tum(const fs::path& file, const std::string&) {
  const Numbers rows = rows_of_numbers(file, ' ', 8, 8);
  return has_quaternion(rows, 4) && increasing(rows);
}

std::unique_ptr<LogFile> open_tum(const fs::path& file, const LogOptions& options) {
  const GroundPlane plane = ground_plane(plane_or(options, "xy"));
  TableLayout layout = layout_of("TUM", plane, ' ', {"t", "x", "y", "z", "qx", "qy", "qz", "qw"});
  layout.time = 0;
  layout.time_unit = "s";
  add_position(layout.sources[0].fields, plane, {1, 2, 3}, 1);
  add_quaternion(layout.sources[0].fields, plane, {4, 5, 6, 7});
  return open_table(file, layout, options.keep_cut);
}

constexpr std::size_t kMostEurocColumns = 64;

// Nanoseconds of Unix time or of a clock since start: whole numbers that step by 0.1 ms to 10 s.
bool is_euroc(const fs::path& file, const std::string&) {
  const Numbers rows = rows_of_numbers(file, ',', 8, kMostEurocColumns);
  if (!has_quaternion(rows, 4) || !increasing(rows)) return false;
  if (rows.size() < 2) return rows[0][0] > 1e15;
  const double step = (rows.back()[0] - rows[0][0]) / static_cast<double>(rows.size() - 1);
  return step >= 1e5 && step <= 1e10;
}

std::unique_ptr<LogFile> open_euroc(const fs::path& file, const LogOptions& options) {
  const GroundPlane plane = ground_plane(plane_or(options, "xy"));
  TableLayout layout = find_table_layout(file, LogOptions());  // for the columns behind the pose
  const std::size_t count = layout.names.size();
  const std::vector<TableField> columns = layout.sources[0].fields;
  layout = layout_of("EuRoC", plane, ',', layout.names);
  layout.time = 0;
  layout.time_unit = "ns";
  std::vector<TableField>& fields = layout.sources[0].fields;
  add_position(fields, plane, {1, 2, 3}, 1);
  add_quaternion(fields, plane, {5, 6, 7, 4});
  for (std::size_t c = 8; c < count; ++c) fields.push_back(columns[c]);
  return open_table(file, layout, options.keep_cut);
}

bool is_kitti(const fs::path& file, const std::string&) {
  return has_rotation_matrix(rows_of_numbers(file, ' ', 12, 12));
}

fs::path kitti_times(const fs::path& file) {
  std::error_code error;
  for (const std::string& name : {file.stem().string() + "_times.txt", std::string("times.txt")}) {
    const fs::path times = file.parent_path() / name;
    if (fs::is_regular_file(times, error)) return times;
  }
  throw DataError(fmt::format(
      "{}: found poses without times (KITTI: 12 numbers per line), expected their times in {} or times.txt "
      "beside it",
      shown_path(file), shown_path(file.stem().string() + "_times.txt")));
}

// The axis about which the body turns is up: in the odometry benchmark the camera's y.
std::string kitti_plane(const fs::path& file, const TableLayout& layout) {
  TableRows rows(file, layout, {3, 5, 7, 10, 11}, true, Stop());
  double about_y = 0, about_z = 0, least_y = 0, most_y = 0, least_z = 0, most_z = 0;
  while (rows.next()) {
    about_y += 1 - rows.number(1);
    about_z += 1 - rows.number(3);
    least_y = std::min(least_y, rows.number(2));
    most_y = std::max(most_y, rows.number(2));
    least_z = std::min(least_z, rows.number(4));
    most_z = std::max(most_z, rows.number(4));
  }
  if (std::abs(about_y - about_z) > 1e-3) return about_z < about_y ? "xy" : "xz";
  return most_z - least_z < most_y - least_y ? "xy" : "xz";
}

std::unique_ptr<LogFile> open_kitti(const fs::path& file, const LogOptions& options) {
  const std::vector<std::string> names{"r11", "r12", "r13", "x",   "r21", "r22",
                                       "r23", "y",   "r31", "r32", "r33", "z"};
  TableLayout layout;
  layout.separator = ' ';
  layout.names = names;
  const fs::path times = kitti_times(file);
  const GroundPlane plane = ground_plane(options.plane.empty() ? kitti_plane(file, layout) : options.plane);
  layout = layout_of("KITTI", plane, ' ', names);
  layout.times_file = times;
  std::vector<TableField>& fields = layout.sources[0].fields;
  add_position(fields, plane, {3, 7, 11}, 1);
  fields.push_back({{"heading", "number", ""}, {0, 1, 2, 4, 5, 6, 8, 9, 10}, [plane](const double* r) {
                      std::array<double, 9> matrix;
                      std::copy(r, r + 9, matrix.begin());
                      return heading_of_matrix(plane, matrix);
                    }});
  if (options.plane.empty())
    layout.notes.push_back(fmt::format("plane {}: the body turns about its normal", plane.name));
  return open_table(file, layout, options.keep_cut);
}

// A preset is not recognised where the text cannot even be read as one.
template <bool (*Is)(const fs::path&, const std::string&)>
bool recognised(const fs::path& file, const std::string& head) {
  if (head.empty() || head.find('\0') != std::string::npos) return false;
  try {
    return Is(file, head);
  } catch (const DataError&) {
    return false;
  }
}

}  // namespace

LogFormat tum_log_format() {
  return {"TUM", recognised<is_tum>, open_tum};
}

LogFormat euroc_log_format() {
  return {"EuRoC", recognised<is_euroc>, open_euroc};
}

LogFormat kitti_log_format() {
  return {"KITTI", recognised<is_kitti>, open_kitti};
}

}  // namespace odobench
