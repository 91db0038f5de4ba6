#include "datasets/import/csv/csv_proposal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/csv/csv_table.hpp"
#include "datasets/csv/decimal_time.hpp"
#include "datasets/import/csv/csv_files.hpp"
#include "datasets/import/csv/csv_map.hpp"
#include "datasets/robots/layouts.hpp"

namespace odobench {
namespace csv_import {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsLookedAt = 50;
constexpr const char* kUnnamed = "my_robot";

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

// The first file: names, and the stamps that a column could be.
struct Sample {
  std::vector<ColumnName> columns;
  std::vector<std::vector<std::string>> rows;
};

Sample look_at(const std::filesystem::path& file, const std::vector<std::string>* expected) {
  const std::string text = read_file(file);
  CsvTable table(text, file.string(), ',');
  if (expected != nullptr && table.names() != *expected)
    throw DataError(fmt::format("{}:{}: found other columns than in the first file, expected {}",
                                shown_path(file), table.header_line(),
                                shown(fmt::format("{}", fmt::join(*expected, ", ")), 400)));
  Sample sample;
  for (const std::string& name : table.names()) sample.columns.push_back(column_name(name));
  while (expected == nullptr && sample.rows.size() < kRowsLookedAt && table.next()) {
    sample.rows.emplace_back();
    for (std::size_t c = 0; c < table.names().size(); ++c) sample.rows.back().emplace_back(table.field(c));
  }
  return sample;
}

// The unit in which the median step lies from 1 ms to 1 s; "" where there is none or no steps.
std::string unit_of_steps(const Sample& sample, std::size_t column) {
  std::vector<std::int64_t> steps;
  std::optional<std::int64_t> before;
  for (const auto& row : sample.rows) {
    const std::optional<std::int64_t> now = decimal_nanoseconds(row[column], 6);  // as if in ms
    if (!now || (before && *now <= *before)) return "";
    if (before) steps.push_back(*now - *before);
    before = now;
  }
  if (steps.empty()) return "";
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const double step = static_cast<double>(steps[steps.size() / 2]) * 1e-6;  // in the column's own unit
  if (step >= 1e-3 && step < 1) return "s";
  if (step >= 1 && step < 1e3) return "ms";
  if (step >= 1e3 && step < 1e6) return "us";
  return step >= 1e6 && step < 1e9 ? "ns" : "";
}

class Proposal {
 public:
  explicit Proposal(Sample sample) : sample_(std::move(sample)) {}

  CsvProposal make() {
    Json map = {{"schema", kMapSchema}, {"schema_version", kMapSchemaVersion}, {"name", kUnnamed}};
    find_wheels();
    map["robot"] = robot();
    map["time"] = time();
    map["reference"] = {{"x", reference(Meaning::X, "x")},
                        {"y", reference(Meaning::Y, "y")},
                        {"theta", reference(Meaning::Heading, "theta")}};
    map["signals"] = std::move(signals_);
    for (std::size_t c = 0; c < sample_.columns.size(); ++c)
      if (!used_.contains(c)) say(fmt::format("{}: not used", quoted(c)));
    result_.map = map.dump(2) + "\n";
    return std::move(result_);
  }

 private:
  void say(std::string text) { result_.reasons.push_back(std::move(text)); }
  const ColumnName& column(std::size_t c) const { return sample_.columns[c]; }
  std::string quoted(std::size_t c) const { return fmt::format("\"{}\"", shown(column(c).name)); }
  static std::string known(const std::string& unit) { return unit.empty() ? "not in its name: null" : unit; }

  Json time() {
    for (std::size_t c = 0; c < sample_.columns.size(); ++c) {
      if (column(c).meaning != Meaning::Time) continue;
      used_.insert(c);
      std::string unit = time_digits(column(c).unit) ? column(c).unit : "";
      const bool named = !unit.empty();
      if (!named) unit = unit_of_steps(sample_, c);
      say(fmt::format("{}: time, unit {}", quoted(c),
                      named          ? unit
                      : unit.empty() ? "unknown: null"
                                     : unit + ", as its steps say"));
      return {{"column", column(c).name}, {"unit", text_or_null(unit)}};
    }
    say("no column of time: null");
    return {{"column", nullptr}, {"unit", nullptr}};
  }

  Json reference(Meaning meaning, const char* axis) {
    for (std::size_t c = 0; c < sample_.columns.size(); ++c) {
      if (column(c).meaning != meaning) continue;
      if (column(c).odometry) {
        used_.insert(c);
        say(fmt::format("{}: the robot's own odometry is no reference", quoted(c)));
        continue;
      }
      const std::string& unit = column(c).unit;
      const bool fits =
          meaning == Meaning::Heading ? angle_scale(unit).has_value() : length_scale(unit).has_value();
      used_.insert(c);
      say(fmt::format("{}: {} of the reference, unit {}", quoted(c), axis, known(fits ? unit : "")));
      return {{"column", column(c).name}, {"unit", text_or_null(fits ? unit : "")}};
    }
    say(fmt::format("no column of the reference's {}: null", axis));
    return {{"column", nullptr}, {"unit", nullptr}};
  }

  void find_wheels() {
    for (std::size_t c = 0; c < sample_.columns.size(); ++c) {
      const ColumnName& name = column(c);
      if (name.meaning != Meaning::Wheel && name.meaning != Meaning::Steering) continue;
      const bool steering = name.meaning == Meaning::Steering;
      std::string signal = steering ? "steering" : "wheel";
      if (!name.which.empty()) signal += "." + name.which;
      used_.insert(c);
      if (signals_.contains(signal)) {
        say(fmt::format("{}: {} is another column already: not used", quoted(c), signal));
        continue;
      }
      (steering ? steered_ : driven_).push_back(name.which);
      signals_[signal] = signal_json(name, steering);
      say(fmt::format("{}: {}, {}", quoted(c), signal,
                      name.unit.empty() ? "unit not in its name: null" : name.unit));
    }
  }

  static Json signal_json(const ColumnName& name, bool steering) {
    Json json = {{"column", name.name}};
    const bool travel = length_scale(name.unit).has_value(),
               speed = name.unit == "rpm" || name.unit.ends_with("/s");
    const bool fits = !name.unit.empty() && !(steering && (travel || speed));
    if (fits) json["kind"] = steering ? "angle" : speed ? "speed" : travel ? "travel" : "position";
    json["unit"] = text_or_null(fits ? name.unit : "");
    if (fits && name.unit == "count") json["per_turn"] = nullptr;
    if (fits && travel) json["radius"] = nullptr;
    return json;
  }

  Json robot() {
    const std::string kind = class_of_wheels(driven_, steered_);
    Json parameters = Json::array();
    if (!kind.empty())
      for (const BoundParameter& p : robots::make_robot(robots::layout(kind)).parameters)
        parameters.push_back(
            {{"name", p.parameter.name},
             {"nominal", p.parameter.unit == "m" ? Json(nullptr) : Json(p.parameter.nominal)}});
    std::vector<std::string> classes;
    for (const robots::Layout& layout : robots::layouts()) classes.push_back(layout.name);
    say(kind.empty() ? fmt::format("robot: the wheels fit several classes or none: null; there are {}",
                                   fmt::join(classes, ", "))
                     : fmt::format("robot: {}, as its wheels say; its lengths: null", kind));
    return {{"name", kUnnamed}, {"kinematics", text_or_null(kind)}, {"parameters", parameters}};
  }

  Sample sample_;
  std::set<std::size_t> used_;
  std::vector<std::string> driven_, steered_;
  Json signals_ = Json::object();
  CsvProposal result_;
};

}  // namespace
}  // namespace csv_import

CsvProposal propose_csv_map(const std::vector<std::string>& items) {
  const std::vector<std::filesystem::path> files = csv_import::csv_files(items);
  csv_import::Sample first = csv_import::look_at(files.front(), nullptr);
  std::vector<std::string> names;
  for (const ColumnName& column : first.columns) {
    if (!is_valid_utf8(column.name))
      throw DataError(fmt::format("{}: found the column \"{}\", expected names in UTF-8",
                                  shown_path(files.front()), shown(column.name)));
    names.push_back(column.name);
  }
  for (std::size_t i = 1; i < files.size(); ++i) csv_import::look_at(files[i], &names);
  return csv_import::Proposal(std::move(first)).make();
}

}  // namespace odobench
