#include "datasets/import/logs/end_poses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/csv/csv_table.hpp"
#include "datasets/import/csv/csv_map.hpp"

namespace odobench::log_import {
namespace {

struct PoseColumn {
  std::size_t column = 0;
  double scale = 1;
};

bool names_a_drive(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name == "drive" || name == "file" || name == "id" || name == "recording" || name == "name";
}

std::size_t drive_column(const CsvTable& table) {
  for (std::size_t k = 0; k < table.names().size(); ++k)
    if (names_a_drive(table.names()[k])) return k;
  throw DataError(fmt::format("{}:{}: found no column 'drive', expected drive, x, y, theta{}", table.file(),
                              table.header_line(), table.reading()));
}

PoseColumn pose_column(const CsvTable& table, Meaning meaning, const char* name) {
  std::optional<PoseColumn> found;
  const auto fail = [&](const std::string& what) {
    throw DataError(fmt::format("{}:{}: {}", table.file(), table.header_line(), what));
  };
  for (std::size_t k = 0; k < table.names().size(); ++k) {
    const ColumnName column = column_name(table.names()[k]);
    if (column.meaning != meaning || names_a_drive(table.names()[k])) continue;
    if (found) fail(fmt::format("found two columns of {}, expected one", name));
    const bool angle = meaning == Meaning::Heading;
    const std::optional<double> scale = column.unit.empty() ? 1
                                        : angle             ? csv_import::angle_scale(column.unit)
                                                            : csv_import::length_scale(column.unit);
    if (!scale)
      fail(fmt::format("{} is in {}, expected {}", shown(table.names()[k]), shown(column.unit),
                       angle ? "rad or deg" : "m, cm or mm"));
    found = {k, *scale};
  }
  if (!found)
    fail(fmt::format("found no column of {}, expected drive, x, y, theta{}", name, table.reading()));
  return *found;
}

// The recordings that a row means: one by its id, those of a log by the log's name.
std::vector<std::size_t> meant(const EndPose& pose,
                               const std::vector<std::vector<std::filesystem::path>>& logs,
                               const Dataset& set) {
  std::vector<std::size_t> of_log;
  for (std::size_t i = 0; i < set.recordings.size(); ++i) {
    if (set.recordings[i].id == pose.drive) return {i};
    if (std::any_of(logs[i].begin(), logs[i].end(), [&](const std::filesystem::path& log) {
          return log.filename() == pose.drive || log.stem() == pose.drive;
        }))
      of_log.push_back(i);
  }
  return of_log;
}

std::string ids_of(const Dataset& set, const std::vector<std::size_t>& which) {
  std::vector<std::string> ids;
  for (const std::size_t i : which) ids.push_back(set.recordings[i].id);
  return fmt::format("{}", fmt::join(ids, ", "));
}

void keep_only(const std::vector<bool>& wanted, Dataset& set) {
  std::vector<Recording> kept;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) kept.push_back(std::move(set.recordings[i]));
  set.recordings = std::move(kept);
  std::erase_if(set.trajectories, [&](const Trajectory& t) {
    return std::none_of(set.recordings.begin(), set.recordings.end(),
                        [&](const Recording& r) { return r.trajectory == t.name; });
  });
}

}  // namespace

std::vector<EndPose> parse_end_poses(std::string_view text, const std::string& file) {
  CsvTable table(text, file, ',');
  const std::size_t drive = drive_column(table);
  const PoseColumn x = pose_column(table, Meaning::X, "x"), y = pose_column(table, Meaning::Y, "y"),
                   theta = pose_column(table, Meaning::Heading, "theta");
  std::vector<EndPose> poses;
  while (table.next()) {
    const EndPose pose{std::string(table.field(drive)), table.number(x.column) * x.scale,
                       table.number(y.column) * y.scale, table.number(theta.column) * theta.scale,
                       table.line()};
    if (pose.drive.empty()) table.fail("found no name of a drive, expected one");
    for (const EndPose& other : poses)
      if (other.drive == pose.drive)
        table.fail(fmt::format("drive '{}' has a pose in line {} already, expected one", shown(pose.drive),
                               other.line));
    poses.push_back(pose);
  }
  if (poses.empty()) throw DataError(fmt::format("{}: found no row, expected one per drive", file));
  return poses;
}

void join_end_poses(const std::vector<EndPose>& poses, const std::string& file,
                    const std::vector<std::vector<std::filesystem::path>>& logs, Dataset& set) {
  std::vector<std::size_t> line_of(set.recordings.size(), 0);
  std::vector<std::string> known;
  for (std::size_t i = 0; i < set.recordings.size(); ++i) {
    known.push_back(set.recordings[i].id);
    for (const std::filesystem::path& log : logs[i])
      if (const std::string stem = log.stem().string(); stem != known.back()) known.push_back(stem);
  }
  for (const EndPose& pose : poses) {
    const auto fail = [&](const std::string& what) {
      throw DataError(fmt::format("{}:{}: {}", file, pose.line, what));
    };
    const std::vector<std::size_t> which = meant(pose, logs, set);
    if (which.empty())
      fail(fmt::format("no drive '{}'{}; drives: {}", shown(pose.drive), did_you_mean(pose.drive, known),
                       shown(fmt::format("{}", fmt::join(known, ", ")), 400)));
    if (which.size() > 1)
      fail(fmt::format("'{}' has {} drives, expected the name of one: {}", shown(pose.drive), which.size(),
                       shown(ids_of(set, which), 400)));
    Recording& r = set.recordings[which.front()];
    if (line_of[which.front()] != 0)
      fail(fmt::format("drive '{}' has a pose in line {} already, expected one", r.id,
                       line_of[which.front()]));
    line_of[which.front()] = pose.line;
    r.reference = {{0, r.size() - 1}, {0, pose.x}, {0, pose.y}, {0, pose.theta}};
  }
  std::vector<bool> wanted;
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < line_of.size(); ++i) {
    wanted.push_back(line_of[i] != 0);
    if (line_of[i] == 0) without.push_back(i);
  }
  if (!without.empty())
    set.notes.push_back(fmt::format("{} drives without a pose in {} left out: {}", without.size(),
                                    printable(std::filesystem::path(file).filename().string()),
                                    ids_of(set, without)));
  keep_only(wanted, set);
}

}  // namespace odobench::log_import
