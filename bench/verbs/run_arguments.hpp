// The options of `bench run`, and what other verbs have in common with it.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <optional>
#include <string>

#include "bench/verbs/command_options.hpp"

namespace odobench {

// An option whose value `set` parses: CLI11's own messages do not say what was expected.
CLI::Option* add_value(CLI::App& app, const std::string& name, const char* type, const std::string& help,
                       const std::function<void(const std::string&)>& set);
// Remarks for add_kernel.
inline constexpr const char* kLastBits = "the last bits of a calibration depend on it";
inline constexpr const char* kSpeedOnly = "it decides the speed of the searches, never what they find";
inline constexpr const char* kNamedOnly = "no result of this verb depends on it";

// --kernel. `remark`: what the verb's results have to do with it.
void add_kernel(CLI::App& app, std::optional<InstructionSet>& kernel, const std::string& remark);
// --max-evals, --time-limit, --target.
void add_budget(CLI::App& app, Budget& budget);

// Adds the options to `app`, writing to `options`, which must outlive it. `config` receives --config.
void add_run_options(CLI::App& app, RunOptions& options, std::string& config);

// Sets what the configuration file says and the command line, parsed before, does not. Throws
// std::invalid_argument "file:line: ..." on unknown keys and bad values.
void apply_config(CLI::App& app, const std::string& config);

// ", did you mean '--x'?" or "" for an option that `app` does not have; "--x=1" counts as "--x".
std::string option_suggestion(const CLI::App& app, const std::string& typed);

}  // namespace odobench
