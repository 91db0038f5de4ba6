#include "bench/studies/exporting/found_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "base/error.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

FoundNumber number_of(const FoundParameter& found) {
  const ParameterValue& p = found.parameter;
  return {p.name, p.unit, p.value, p.nominal, found.half_width, p.at_bound, found.decided_by};
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "ratio" ? text : text + " " + printable(unit);
}

std::string bound_remark(const FoundNumber& n) {
  return n.at_bound.empty() ? "" : fmt::format(", on its {} bound", printable(n.at_bound));
}

// Only that the box decides; other reasons (too few recordings) are in the parameter file.
std::string box_remark(const FoundNumber& n) {
  return n.decided_by.rfind("decided by the box", 0) == 0 ? ", decided by the box" : "";
}

std::string interval_text(double half_width) {
  return fmt::format(", +- {:.2g}", half_width);
}

// Letters, digits and _, a letter first.
std::string plain_name(const std::string& text) {
  std::string name;
  for (const char c : text) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name = "wheel_" + name;
  return name;
}

}  // namespace

std::string decimal(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

int digits_of(std::string_view unit) {
  return unit == "m" || unit == "rad" ? 6 : 9;
}

std::string remark_on(const FoundNumber& n) {
  const int digits = digits_of(n.unit);
  std::string text = "nominal " + decimal(n.nominal, digits);
  if (n.half_width) text += interval_text(*n.half_width);
  return with_unit(text, n.unit) + bound_remark(n) + box_remark(n);
}

std::string words_of(const FoundNumber& n) {
  const int digits = digits_of(n.unit);
  std::string text = fmt::format("{} {}, nominal {}", printable(n.name),
                                 with_unit(decimal(n.value, digits), n.unit), decimal(n.nominal, digits));
  if (n.half_width) text += interval_text(*n.half_width);
  return text + bound_remark(n) + box_remark(n);
}

MeanNumber mean_of(const std::vector<FoundNumber>& numbers) {
  MeanNumber mean;
  double low = numbers.front().value, high = low;
  for (const FoundNumber& n : numbers) {
    mean.mean += n.value / static_cast<double>(numbers.size());
    mean.nominal += n.nominal / static_cast<double>(numbers.size());
    low = std::min(low, n.value);
    high = std::max(high, n.value);
  }
  mean.half_difference = (high - low) / 2;
  return mean;
}

bool FoundValues::has(const std::string& name) const {
  return std::any_of(file_.parameters.begin(), file_.parameters.end(),
                     [&](const FoundParameter& f) { return f.parameter.name == name; });
}

FoundNumber FoundValues::at(const std::string& name) const {
  std::string wanted = name;
  for (std::size_t step = 0; step <= file_.ties.size(); ++step) {
    for (const FoundParameter& found : file_.parameters)
      if (found.parameter.name == wanted) {
        FoundNumber number = number_of(found);
        number.name = name;
        return number;
      }
    for (const auto& [tied, other] : file_.ties)
      if (tied == wanted) {
        wanted = other;
        break;
      }
  }
  throw DataError(fmt::format("row '{}': found no parameter '{}', expected it of a robot of class {}",
                              shown(file_.label), name, shown(file_.kinematics)));
}

std::vector<FoundNumber> FoundValues::numbered(const std::string& name) const {
  std::vector<FoundNumber> all;
  for (std::size_t i = 1; i <= file_.wheels.size(); ++i) all.push_back(at(fmt::format("{}{}", name, i)));
  return all;
}

std::vector<std::size_t> quadrants(const ParameterFile& file) {
  constexpr std::size_t kNone = 4;
  std::array<std::size_t, 4> at{kNone, kNone, kNone, kNone};
  if (file.nominal_wheels.size() != at.size()) return {};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Wheel& wheel = file.nominal_wheels[i];
    if (wheel.x == 0 || wheel.y == 0) return {};
    at[(wheel.x > 0 ? 0U : 2U) + (wheel.y > 0 ? 0U : 1U)] = i;
  }
  if (std::find(at.begin(), at.end(), kNone) != at.end()) return {};
  return {at.begin(), at.end()};
}

std::vector<std::string> wheel_names(const ParameterFile& file) {
  constexpr std::array<const char*, 4> kQuadrants = {"front_left", "front_right", "rear_left", "rear_right"};
  std::vector<std::string> names(file.wheels.size());
  const std::vector<std::size_t> at = quadrants(file);
  for (std::size_t k = 0; k < at.size(); ++k) names[at[k]] = kQuadrants[k];
  if (!at.empty()) return names;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Wheel& wheel = file.wheels[i];
    const std::string base = wheel.drive.size() == 1   ? plain_name(wheel.drive.front().name)
                             : !wheel.steering.empty() ? plain_name(wheel.steering)
                                                       : fmt::format("wheel_{}", i + 1);
    names[i] = base;
    for (int k = 2; !taken.insert(names[i]).second; ++k) names[i] = fmt::format("{}_{}", base, k);
  }
  return names;
}

std::optional<FoundMount> found_mount(const ParameterFile& file) {
  const FoundValues values(file);
  if (!values.has("mount_x") || !values.has("mount_y") || !values.has("mount_yaw")) return std::nullopt;
  return FoundMount{values.at("mount_x"), values.at("mount_y"), values.at("mount_yaw")};
}

std::vector<std::string> origin_lines(const ParameterFile& file) {
  return {fmt::format("Robot '{}' of class {}, calibrated by {} (row '{}', run {}, {})",
                      printable(file.robot), printable(file.kinematics), printable(file.solver),
                      printable(file.label), printable(file.run_id), printable(file.time_utc)),
          fmt::format("on data set '{}' ({}), {}{}", printable(file.dataset),
                      printable(file.dataset_sha256.substr(0, 12)), printable(file.problem),
                      file.cost ? fmt::format(", J = {:.6g}", *file.cost) : std::string())};
}

std::vector<std::string> bound_warnings(const ParameterFile& file) {
  std::vector<std::string> all;
  for (const FoundParameter& found : file.parameters)
    if (!found.parameter.at_bound.empty())
      all.push_back(fmt::format("{} lies on its {} bound: a wider box, other drives or another nominal value",
                                printable(found.parameter.name), printable(found.parameter.at_bound)));
  return all;
}

}  // namespace odobench
