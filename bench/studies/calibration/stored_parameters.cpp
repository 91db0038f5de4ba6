#include "bench/studies/calibration/stored_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/studies/records.hpp"

namespace odobench {
namespace {

struct StoredSource {
  std::string runs;  // folder or file
  std::string row;   // "": all
};

bool holds_runs(const std::string& path) {
  std::error_code e;
  if (std::filesystem::is_directory(path, e)) return true;
  return path.size() > 6 && path.compare(path.size() - 6, 6, ".jsonl") == 0 &&
         std::filesystem::exists(path, e);
}

// "results" of results/, results/runs.jsonl and results.jsonl.
std::string name_of_source(const StoredSource& source) {
  std::filesystem::path path = std::filesystem::absolute(source.runs).lexically_normal();
  if (!path.has_filename() || path.filename() == "runs.jsonl") path = path.parent_path();
  return path.extension() == ".jsonl" ? path.stem().string() : path.filename().string();
}

// Rows have commas in their options, "pso[swarm=9,w=1]", and files in their names.
std::vector<std::string> entries_of(const std::string& list) {
  if (std::filesystem::exists(list)) return {list};
  std::vector<std::string> entries(1);
  int depth = 0;
  for (const char c : list) {
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == ',' && depth <= 0)
      entries.emplace_back();
    else
      entries.back() += c;
  }
  return entries;
}

// None for what read_parameters() reads.
std::optional<StoredSource> stored_source(const std::string& entry) {
  if (holds_runs(entry)) return StoredSource{entry, ""};
  if (std::filesystem::exists(entry)) return std::nullopt;
  for (std::size_t colon = entry.find(':'); colon != std::string::npos; colon = entry.find(':', colon + 1))
    if (holds_runs(entry.substr(0, colon)))
      return StoredSource{entry.substr(0, colon), entry.substr(colon + 1)};
  return std::nullopt;
}

std::vector<const RunRecord*> wanted_rows(const std::vector<RunRecord>& records, const StoredSource& source) {
  std::vector<const RunRecord*> rows = best_of_rows(records);
  std::vector<std::string> known;
  for (const RunRecord* row : rows) known.push_back(row->label);
  std::erase_if(rows, [&](const RunRecord* row) {
    return source.row.empty() ? row->label == "nominal" : row->label != source.row;
  });
  if (!rows.empty()) return rows;
  if (source.row.empty())
    throw DataError(fmt::format("{}: found no run with parameters, expected at least one", source.runs));
  throw std::invalid_argument(
      fmt::format("--parameters={}:{}: there is no such row with parameters{}; known: {}", source.runs,
                  source.row, did_you_mean(source.row, known), fmt::join(known, ", ")));
}

// "b, r_left" of `names` that `others` do not have.
std::string missing(const std::set<std::string>& names, const std::set<std::string>& others) {
  std::vector<std::string> list;
  std::set_difference(names.begin(), names.end(), others.begin(), others.end(), std::back_inserter(list));
  return list.empty() ? "nothing" : fmt::format("{}", fmt::join(list, ", "));
}

// Throws where the record's robot is another kind of robot than the set's.
void require_same_robot(const LoadedProblem& loaded, const StoredSource& source, const RunRecord& row) {
  std::set<std::string> theirs, ours;
  for (const ParameterValue& p : row.parameters) theirs.insert(fmt::format("{} [{}]", p.name, p.unit));
  for (const ParameterInfo& p : loaded.problem.parameters())
    ours.insert(fmt::format("{} [{}]", p.name, p.unit));
  if (theirs == ours) return;
  std::string text =
      fmt::format("{}: '{}' was found for another robot than that of '{}' ({}): only there {}, only here {}",
                  source.runs, shown(row.label), shown(loaded.dataset_name()),
                  loaded.dataset->robot.kinematics, missing(theirs, ours), missing(ours, theirs));
  if (theirs.count("mount_x [m]") > 0) text += "; --mount takes the mount, too";
  throw DataError(text);
}

// "b 0.2 there and 0.21 here"
std::string nominal_differences(const LoadedProblem& loaded, const RunRecord& row) {
  std::string list;
  for (const ParameterInfo& p : loaded.problem.parameters())
    for (const ParameterValue& own : row.parameters)
      if (own.name == p.name && own.nominal != p.nominal)
        list += fmt::format("{}{} {:g} there and {:g} here", list.empty() ? "" : ", ", p.name, own.nominal,
                            p.nominal);
  return list;
}

void read_stored(const LoadedProblem& loaded, const StoredSource& source, std::vector<ParameterSet>& sets,
                 Watcher& watcher) {
  const std::vector<RunRecord> records = read_all_records({source.runs}, watcher);
  std::set<std::string> told;
  const auto tell = [&](const std::string& text) {
    if (told.insert(text).second) watcher.note(text);
  };
  for (const RunRecord* row : wanted_rows(records, source)) {
    require_same_robot(loaded, source, *row);
    const std::vector<ParameterInfo>& parameters = loaded.problem.parameters();
    Vector values(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t i = 0; i < parameters.size(); ++i)
      for (const ParameterValue& own : row->parameters)
        if (own.name == parameters[i].name) values[static_cast<Eigen::Index>(i)] = own.value;
    add_parameter_set({fmt::format("{}@{}", row->label, name_of_source(source)), values}, sets);
    if (row->dataset_sha256 != loaded.dataset_sha256)
      tell(fmt::format("parameters of {} were found on other data ('{}') than they are judged on ('{}')",
                       source.runs, row->dataset, loaded.dataset_name()));
    if (row->problem != loaded.name())
      tell(fmt::format("they were found by {}, J here is of {}", row->problem, loaded.name()));
    if (const std::string differ = nominal_differences(loaded, *row); !differ.empty())
      tell(fmt::format("nominal values differ: {}", differ));
  }
}

}  // namespace

std::vector<ParameterSet> read_judged_parameters(const LoadedProblem& loaded,
                                                 const std::vector<std::string>& lists, Watcher& watcher) {
  const ParameterNames names = parameter_names(loaded);
  std::vector<std::pair<std::string, std::optional<StoredSource>>> entries;
  bool any_stored = false, nominal_given = false;
  for (const std::string& list : lists)
    for (const std::string& entry : entries_of(list)) entries.emplace_back(entry, stored_source(entry));
  if (entries.empty()) entries.emplace_back("nominal", std::nullopt);
  for (const auto& [entry, stored] : entries) {
    any_stored |= stored.has_value();
    nominal_given |= entry == "nominal";
  }
  if (any_stored && !nominal_given) entries.insert(entries.begin(), {"nominal", std::nullopt});
  std::vector<ParameterSet> sets;
  for (const auto& [entry, stored] : entries)
    if (stored)
      read_stored(loaded, *stored, sets, watcher);
    else
      for (ParameterSet& set : read_parameters(names, entry)) add_parameter_set(std::move(set), sets);
  for (const ParameterSet& set : sets) warn_outside(loaded, set, watcher);
  return sets;
}

}  // namespace odobench
