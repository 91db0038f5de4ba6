#include "bench/options/table_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/names.hpp"
#include "bench/console/table_output.hpp"

namespace odobench {
namespace {

// Whether "calibration.demo.errors.line_x" has these parts one after the other: "errors", "demo.errors".
bool names_table(const std::string& id, const std::string& name) {
  return ("." + id + ".").find("." + name + ".") != std::string::npos;
}

// "errors" of "errors.line_x" and "calibration.demo.errors.line_x" where other ids have the prefix, too: what
// a reader would type. Prefixes are those of the first table.
std::string prefix_of(const std::vector<Table>& tables) {
  std::string common = tables.empty() ? "" : tables.front().id;
  for (const Table& table : tables) {
    std::size_t same = 0;
    while (same < std::min(common.size(), table.id.size()) && common[same] == table.id[same]) ++same;
    common.resize(same);
  }
  const std::size_t end = common.rfind('.');
  return end == std::string::npos || tables.size() < 2 ? "" : common.substr(0, end + 1);
}

std::vector<std::string> short_names(const std::vector<Table>& tables) {
  const std::string prefix = prefix_of(tables);
  std::vector<std::string> names;
  for (const Table& table : tables) {
    std::string name = table.id.substr(prefix.size());
    if (const std::size_t dot = name.find('.'); dot != std::string::npos && name.rfind("errors.", 0) == 0)
      name.resize(dot);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

std::vector<std::string> split_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists) {
    std::istringstream in(list);
    for (std::string name; std::getline(in, name, ',');) {
      if (name.empty()) throw std::invalid_argument(fmt::format("--tables: an empty name in '{}'", list));
      names.push_back(name);
    }
  }
  return names;
}

ChosenTables key_tables(std::vector<Table> tables) {
  ChosenTables chosen;
  std::vector<Table> others;
  for (Table& table : tables) (table.key ? chosen.tables : others).push_back(std::move(table));
  if (chosen.tables.empty()) return {std::move(others), "", ""};
  if (!others.empty())
    chosen.remark = fmt::format("more: --tables=all, or some of {}", fmt::join(short_names(others), ","));
  return chosen;
}

}  // namespace

void add_tables(CLI::App& app, std::vector<std::string>& names, TablesByDefault standard) {
  app.add_option(
         "--tables", names,
         fmt::format("which tables to print: all, key, or names of some, e.g. totals,parameters,errors; "
                     "a comma list [{}]",
                     standard == TablesByDefault::Key ? "key; all in formats other than console" : "all"))
      ->type_name("LIST")
      ->allow_extra_args(false);
}

ChosenTables choose_tables(std::vector<Table> tables, const std::vector<std::string>& lists, Format format,
                           TablesByDefault standard) {
  std::vector<std::string> names = split_names(lists);
  if (names.empty()) names = {standard == TablesByDefault::Key && format == Format::Console ? "key" : "all"};
  const auto asked = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::vector<std::string> there = short_names(tables);
  std::string unknown;
  for (const std::string& name : names)
    if (name != "key" && name != "all" &&
        std::none_of(tables.begin(), tables.end(), [&](const Table& t) { return names_table(t.id, name); }))
      unknown = fmt::format("--tables: no table '{}'{}; there are {}", name, did_you_mean(name, there),
                            fmt::join(there, ", "));
  if (asked("all") && unknown.empty()) return {std::move(tables), "", ""};
  ChosenTables chosen;
  if (!unknown.empty() || (names.size() == 1 && asked("key"))) {
    chosen = key_tables(std::move(tables));
    chosen.unknown = unknown;
    return chosen;
  }
  for (Table& table : tables)
    if ((asked("key") && table.key) || std::any_of(names.begin(), names.end(), [&](const std::string& n) {
          return names_table(table.id, n);
        }))
      chosen.tables.push_back(std::move(table));
  return chosen;
}

ExitCode print_chosen(std::vector<Table> tables, const std::vector<std::string>& names, Format format,
                      TablesByDefault standard, bool quiet) {
  const ChosenTables chosen = choose_tables(std::move(tables), names, format, standard);
  print_tables(chosen.tables, format);
  if (!chosen.unknown.empty()) {
    warn(chosen.unknown);
    return ExitCode::Usage;
  }
  if (!chosen.remark.empty() && !quiet) hint(chosen.remark);
  return ExitCode::Success;
}

}  // namespace odobench
