// Which tables a verb prints.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "bench/console/exit_code.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// What is printed without --tables: those that are marked as key ones on the console and everything in the
// other formats, or everything everywhere.
enum class TablesByDefault { Key, All };

// --tables.
void add_tables(CLI::App& app, std::vector<std::string>& names, TablesByDefault standard);

struct ChosenTables {
  std::vector<Table> tables;
  std::string remark;   // which others there are, or "": a line for standard error
  std::string unknown;  // what is wrong with the names; `tables` are the key ones then
};

// `names`: "all", "key", or names of tables, each with what lies below it: "errors" takes
// "errors.line_x", and "totals" takes "calibration.demo.totals". Where nothing is marked as key, all are.
ChosenTables choose_tables(std::vector<Table> tables, const std::vector<std::string>& names, Format format,
                           TablesByDefault standard);

// Prints them. ExitCode::Usage after a warning when a name is unknown, which is told when the results are
// there; Success else. `quiet`: no remark.
ExitCode print_chosen(std::vector<Table> tables, const std::vector<std::string>& names, Format format,
                      TablesByDefault standard, bool quiet = false);

}  // namespace odobench
