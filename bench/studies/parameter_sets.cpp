#include "bench/studies/parameter_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/error.hpp"
#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/names.hpp"
#include "base/range.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/parameter_files.hpp"

namespace odobench {
namespace {

using Json = nlohmann::json;

// "; differential has b, r_right, r_left: parameters of another robot are not judged on it".
std::string own_names(const ParameterNames& of, const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return fmt::format("; {} has {}: parameters of another robot are not judged on it",
                     of.robot == kOwnWheels ? "the robot" : of.robot, list);
}

ParameterSet from_object(const Json& object, const ParameterNames& of, const std::string& where,
                         std::string label) {
  const std::vector<ParameterInfo>& parameters = of.parameters;
  if (!object.is_object())
    throw DataError(fmt::format("{}: found {}, expected an object of parameters", where, object.type_name()));
  std::vector<std::string> names;
  for (const ParameterInfo& p : parameters) names.push_back(p.name);
  const std::string others = of.robot.empty() ? "" : own_names(of, names);
  for (const auto& [key, value] : object.items()) {
    if (key == "name" && value.is_string()) {
      label = value.get<std::string>();
    } else if (std::find(names.begin(), names.end(), key) == names.end()) {
      if (!others.empty())
        throw DataError(
            fmt::format("{}: unknown key '{}'{}{}", where, key, did_you_mean(key, names), others));
      throw DataError(fmt::format("{}: unknown key '{}'{}; expected {} .. {} and, if you like, a text 'name'",
                                  where, key, did_you_mean(key, names), names.front(), names.back()));
    }
  }
  Vector values(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto entry = object.find(names[i]);
    if (entry == object.end()) throw DataError(fmt::format("{}: '{}' is missing{}", where, names[i], others));
    if (!entry->is_number() || !in_range(entry->get<double>()))
      throw DataError(fmt::format("{}: '{}' is {}, expected a number of at most {:g} in size", where,
                                  names[i], entry->dump(), kLargestNumber));
    values[static_cast<Eigen::Index>(i)] = entry->get<double>();
  }
  return {label, values};
}

// What runs keep of their results has the values as an object of their own.
bool is_parameter_file(const Json& root) {
  if (!root.is_object()) return false;
  const auto schema = root.find("schema");
  return schema != root.end() && schema->is_string() && *schema == kParameterSchema;
}

ParameterSet from_parameter_file(const ParameterNames& of, const std::string& file) {
  const ParameterFile found = read_parameter_file(file);
  Json values = Json::object();
  for (const FoundParameter& one : found.parameters) values[one.parameter.name] = one.parameter.value;
  return from_object(values, of, file, found.label);
}

std::vector<ParameterSet> from_file(const ParameterNames& of, const std::string& file) {
  const Json root = parse_json(read_file(file), file);
  const std::string stem = std::filesystem::path(file).stem().string();
  if (is_parameter_file(root)) return {from_parameter_file(of, file)};
  if (!root.is_array()) return {from_object(root, of, file, stem)};
  std::vector<ParameterSet> sets;
  for (std::size_t i = 0; i < root.size(); ++i)
    sets.push_back(from_object(root[i], of, fmt::format("{}: entry {}", file, i + 1),
                               fmt::format("{} {}", stem, i + 1)));
  if (sets.empty())
    throw DataError(fmt::format("{}: an empty array, expected at least one object of parameters", file));
  return sets;
}

}  // namespace

std::vector<std::string> split_sources(const std::vector<std::string>& lists) {
  std::vector<std::string> sources;
  for (const std::string& list : lists) {
    if (std::filesystem::exists(list)) {
      sources.push_back(list);
      continue;
    }
    for (std::string& item : comma_items(list)) sources.push_back(std::move(item));
  }
  return sources.empty() ? std::vector<std::string>{"nominal"} : sources;
}

ParameterNames parameter_names(const LoadedProblem& loaded) {
  ParameterNames names{loaded.problem.parameters(), {}};
  if (loaded.dataset) names.known = loaded.dataset->known_parameters;
  if (loaded.dataset && loaded.dataset->robot.kinematics != "4wis4wid")
    names.robot = loaded.dataset->robot.kinematics;
  return names;
}

std::vector<ParameterSet> read_parameters(const ParameterNames& names, const std::string& source,
                                          const char* option) {
  const auto count = static_cast<Eigen::Index>(names.parameters.size());
  std::vector<std::string> known = {"nominal"};
  if (source == "nominal") {
    Vector values(count);
    for (Eigen::Index i = 0; i < count; ++i)
      values[i] = names.parameters[static_cast<std::size_t>(i)].nominal;
    return {{source, values}};
  }
  for (const NamedParameters& set : names.known) {
    if (set.name == source) {  // of the robot alone: a mount, a lag, ... stay nominal
      Vector values = read_parameters(names, "nominal", option).front().values;
      for (std::size_t i = 0; i < std::min(set.values.size(), names.parameters.size()); ++i)
        values[static_cast<Eigen::Index>(i)] = set.values[i];
      return {{source, values}};
    }
    known.push_back(set.name);
  }
  if (std::filesystem::exists(source)) return from_file(names, source);
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  throw std::invalid_argument(fmt::format("{}={}: neither a file nor a name this data set knows{}; known: {}",
                                          option, source, did_you_mean(source, known), list));
}

void warn_outside(const LoadedProblem& loaded, const ParameterSet& set, Watcher& watcher) {
  std::string list;
  const std::vector<ParameterInfo>& parameters = loaded.problem.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = set.values[static_cast<Eigen::Index>(i)];
    // Published values are rounded: 26.67 mm is one unit in the last place above 1.05 * 25.4 mm.
    const double slack = 1e-9 * (parameters[i].upper - parameters[i].lower);
    if (value < parameters[i].lower - slack || value > parameters[i].upper + slack)
      list += fmt::format("{}{}={} ({}..{})", list.empty() ? "" : ", ", parameters[i].name, value,
                          parameters[i].lower, parameters[i].upper);
  }
  if (!list.empty())
    watcher.warn(fmt::format("parameters '{}' lie outside the box of the set: {}", set.label, list));
}

void add_parameter_set(ParameterSet set, std::vector<ParameterSet>& sets) {
  const auto same = [&](const ParameterSet& s) { return s.label == set.label; };
  if (std::any_of(sets.begin(), sets.end(), same))
    throw std::invalid_argument(
        fmt::format("--parameters: two sets are called '{}'; give them different names", set.label));
  sets.push_back(std::move(set));
}

}  // namespace odobench
