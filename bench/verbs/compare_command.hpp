// `bench compare OLD NEW`: two sets of stored runs side by side.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "bench/console/exit_code.hpp"
#include "reports/regression/changes.hpp"

namespace odobench {

struct CompareArguments {
  std::string before, after;         // folders with runs.jsonl, or .jsonl files
  std::vector<std::string> metrics;  // comma lists as typed
  std::vector<std::string> fail_on;  // comma lists of METRIC:LIMIT as typed
  double alpha = 0.05;
  bool gate_foreign_times = false;
  std::string format = "console";
};

CLI::App* add_compare_verb(CLI::App& app, CompareArguments& arguments);

// "J:+0.1%,seconds:+20%,evaluations:+50": a sign that says which way is worse, a size, % for relative ones. Throws
// std::invalid_argument that names the part, what was found and what was expected. Names of metrics are not checked.
std::vector<Gate> parse_gates(const std::vector<std::string>& lists);

// CheckFailed when a limit is passed and the change is sure.
ExitCode compare_command(const CompareArguments& arguments);

}  // namespace odobench
