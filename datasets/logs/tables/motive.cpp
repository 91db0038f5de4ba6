// OptiTrack Motive's CSV export: a column's name is spread over five lines (type, name, id, quantity, axis).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/tables/ground_plane.hpp"
#include "datasets/logs/tables/table_log.hpp"
#include "datasets/logs/tables/trajectories.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstWords = "Format Version,1.";
constexpr std::size_t kMostColumnsOfMotive = 10'000;

bool is_motive(const fs::path&, const std::string& head) {
  const std::size_t mark = head.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
  return head.compare(mark, kFirstWords.size(), kFirstWords) == 0;
}

// The header's lines that matter, found by what stands in their second field.
struct MotiveHeader {
  std::map<std::string, std::string> keys;
  std::vector<std::string> type, name, quantity, axis;
  std::size_t first_row_line = 0;
};

bool row_begins(const std::vector<std::string>& row, const std::string& word) {
  return row.size() > 2 && row[0].empty() && row[1] == word;
}

MotiveHeader read_header(const fs::path& file) {
  const TableHead head = read_table_head(file, "");
  const std::vector<std::vector<std::string>> rows = head.rows(',');
  MotiveHeader header;
  for (std::size_t i = 0; i + 1 < rows[0].size(); i += 2) header.keys[rows[0][i]] = rows[0][i + 1];
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (row_begins(rows[r], "Type")) header.type = rows[r];
    if (row_begins(rows[r], "Name")) header.name = rows[r];
    if (rows[r].size() < 3 || rows[r][0] != "Frame" || rows[r][1].substr(0, 4) != "Time") continue;
    header.axis = rows[r];
    header.quantity = rows[r - 1];
    header.first_row_line = head.lines[r].number + 1;
    break;
  }
  const std::size_t count = header.axis.size();
  if (header.first_row_line == 0 || count > kMostColumnsOfMotive || header.type.size() < count - 1 ||
      header.name.size() < count - 1 || header.quantity.size() < count - 1)
    throw DataError(
        fmt::format("{}: found no header of five lines (Type, Name, ID, quantity, axis), expected a "
                    "CSV export of OptiTrack Motive 1.2x",
                    shown_path(file)));
  for (std::vector<std::string>* row : {&header.type, &header.name, &header.quantity}) row->resize(count);
  return header;
}

struct RigidBody {
  std::string name;
  std::map<std::string, std::size_t> rotation, position;
  std::string order;  // of the axes in the header
};

std::vector<RigidBody> rigid_bodies(const MotiveHeader& header) {
  std::vector<RigidBody> bodies;
  std::map<std::string, std::size_t> place;
  for (std::size_t c = 2; c < header.axis.size(); ++c) {
    if (header.type[c] != "Rigid Body") continue;
    const auto [at, fresh] = place.emplace(header.name[c], bodies.size());
    if (fresh) bodies.push_back({header.name[c], {}, {}, ""});
    RigidBody& body = bodies[at->second];
    if (header.quantity[c] == "Position") body.position[header.axis[c]] = c;
    if (header.quantity[c] != "Rotation") continue;
    body.rotation[header.axis[c]] = c;
    if (header.axis[c] != "W") body.order += header.axis[c];
  }
  return bodies;
}

double metres_per_unit(const MotiveHeader& header) {
  const auto found = header.keys.find("Length Units");
  if (found == header.keys.end()) return 1;
  if (found->second == "Millimeters") return 1e-3;
  return found->second == "Centimeters" ? 1e-2 : 1;
}

bool has_axes(const std::map<std::string, std::size_t>& columns) {
  return columns.count("X") > 0 && columns.count("Y") > 0 && columns.count("Z") > 0;
}

void add_angles(std::vector<TableField>& fields, const GroundPlane& plane, const RigidBody& body,
                const std::string& type) {
  std::string order = body.order, sorted = type;
  std::sort(sorted.begin(), sorted.end());
  if (sorted == "XYZ") order = type;
  std::vector<std::size_t> columns;
  for (const char axis : order) columns.push_back(body.rotation.at(std::string(1, axis)));
  fields.push_back({{"heading", "number", ""}, columns, [plane, order](const double* degrees) {
                      double angles[3];
                      for (std::size_t k = 0; k < 3; ++k) angles[k] = degrees[k] * std::numbers::pi / 180;
                      return heading_of_matrix(plane, matrix_of_angles(order, angles));
                    }});
}

TableSource source_of(const RigidBody& body, const GroundPlane& plane, const MotiveHeader& header) {
  TableSource source;
  source.type = fmt::format("trajectory (Motive, plane {})", plane.name);
  const auto& p = body.position;
  const auto& r = body.rotation;
  if (has_axes(p))
    add_position(source.fields, plane, {p.at("X"), p.at("Y"), p.at("Z")}, metres_per_unit(header));
  if (has_axes(r) && r.count("W") > 0) {
    add_quaternion(source.fields, plane, {r.at("X"), r.at("Y"), r.at("Z"), r.at("W")});
  } else if (has_axes(r) && body.order.size() == 3) {
    const auto type = header.keys.find("Rotation Type");
    add_angles(source.fields, plane, body, type == header.keys.end() ? "" : type->second);
  }
  return source;
}

std::unique_ptr<LogFile> open_motive(const fs::path& file, const LogOptions& options) {
  const MotiveHeader header = read_header(file);
  const GroundPlane plane = ground_plane(options.plane.empty() ? "zx" : options.plane);
  const std::vector<RigidBody> bodies = rigid_bodies(header);
  if (bodies.empty())
    throw DataError(fmt::format(
        "{}: found no rigid body, expected one at least (markers alone have no heading)", shown_path(file)));
  TableLayout layout;
  layout.format = "Motive";
  layout.comment_marks.clear();
  layout.first_row_line = header.first_row_line;
  layout.time = 1;
  layout.time_unit = "s";
  for (std::size_t c = 0; c < header.axis.size(); ++c)
    layout.names.push_back(
        c < 2 ? header.axis[c] : fmt::format("{}.{}.{}", header.name[c], header.quantity[c], header.axis[c]));
  for (const RigidBody& body : bodies) {
    layout.sources.push_back(source_of(body, plane, header));
    if (bodies.size() > 1) layout.sources.back().name = body.name;
  }
  const auto start = header.keys.find("Capture Start Time");
  if (start != header.keys.end())
    layout.notes.push_back("time counts from the start of the capture, " + shown(start->second) +
                           " local time");
  return open_table(file, std::move(layout), options.keep_cut);
}

}  // namespace

LogFormat motive_log_format() {
  return {"Motive", is_motive, open_motive};
}

}  // namespace odobench
