#include "bench/studies/exporting/robot_export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "base/error.hpp"
#include "base/files.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/studies/exporting/export_texts.hpp"
#include "bench/studies/exporting/found_values.hpp"

namespace odobench {
namespace {

const std::vector<std::string> kTargets = {"ros2", "urdf", "yaml", "json", "c", "wpilib"};

void check_request(const RobotExport& study) {
  const std::string& target = study.target;
  if (std::find(kTargets.begin(), kTargets.end(), target) == kTargets.end())
    throw std::invalid_argument(fmt::format("--to={}: unknown target{}; known: {}", shown(target),
                                            did_you_mean(target, kTargets), fmt::join(kTargets, ", ")));
  const bool has_node = target == "ros2" || target == "yaml" || target == "c";
  if (!study.node.empty() && !has_node)
    throw std::invalid_argument(fmt::format("--node is of --to=ros2, yaml and c, not of {}", target));
  if (study.absolute && target != "ros2")
    throw std::invalid_argument("--absolute is of --to=ros2, where multipliers stand beside nominal lengths");
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; };
  if (!std::all_of(study.node.begin(), study.node.end(), good) ||
      (!study.node.empty() && std::isdigit(static_cast<unsigned char>(study.node.front())) != 0))
    throw std::invalid_argument(
        fmt::format("--node={}: expected letters, digits, _ and /, no digit first", shown(study.node)));
}

ParameterFile wanted_row(const RobotExport& study) {
  std::vector<ParameterFile> rows;
  std::vector<std::string> labels;
  const std::vector<std::filesystem::path> files = stored_parameter_files(study.run);
  for (const std::filesystem::path& file : files) {
    ParameterFile row = read_parameter_file(file);
    if (row.kinematics.empty()) continue;
    labels.push_back(row.label);
    rows.push_back(std::move(row));
  }
  if (rows.empty())
    throw DataError(fmt::format(
        "{}: found {}, expected parameters/*.json of a calibration, as 'bench run' "
        "with --out writes them",
        shown_path(study.run), files.empty() ? "no parameters" : "parameters of other problems alone"));
  const auto better = [](const ParameterFile& a, const ParameterFile& b) {
    return b.cost.has_value() < a.cost.has_value() || (a.cost && b.cost && *a.cost < *b.cost);
  };
  if (study.row.empty()) return *std::min_element(rows.begin(), rows.end(), better);
  const auto found = std::find(labels.begin(), labels.end(), study.row);
  if (found != labels.end()) return rows[static_cast<std::size_t>(found - labels.begin())];
  for (std::string& label : labels) label = shown(label);
  throw std::invalid_argument(fmt::format("--row={}: there is no such row with parameters{}; known: {}",
                                          shown(study.row), did_you_mean(study.row, labels),
                                          fmt::join(labels, ", ")));
}

}  // namespace

ExportedRobot export_robot(const RobotExport& study) {
  check_request(study);
  const ParameterFile row = wanted_row(study);
  ExportedRobot out;
  out.row = row.label;
  out.warnings = bound_warnings(row);
  const std::string& target = study.target;
  if (target == "ros2" || target == "yaml") {
    const KeyTable table = target == "ros2" ? controller_keys(row, study.absolute) : generic_keys(row);
    out.text = yaml_text(row, table, study.node.empty() ? table.controller : study.node);
    out.warnings.insert(out.warnings.end(), table.losses.begin(), table.losses.end());
  } else if (target == "json") {
    out.text = to_json_text(row);
  } else if (target == "c") {
    out.text = c_text(row, study.node.empty() ? "odometry" : study.node);
  } else if (target == "urdf") {
    out.text = urdf_text(row);
  } else {
    out.text = wpilib_text(row);
  }
  return out;
}

}  // namespace odobench
