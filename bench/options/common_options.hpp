// Options that several verbs have.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/calibration/classical_study.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/run.hpp"

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
// --cost, --integration, --twist, --weights, --distance, --piece, --loss, --loss-scale: J of the parameters
// that the set has.
void add_cost(CLI::App& app, CalibrationChoice& choice);
// Those and --mount, --model of a calibration.
void add_calibration(CLI::App& app, CalibrationChoice& choice);
// --model alone.
void add_model(CLI::App& app, CalibrationChoice& choice);
// --screen of verbs that compare recordings with their siblings.
void add_screen(CLI::App& app, double& screen);
// --classical, --side.
void add_classical(CLI::App& app, ClassicalChoice& choice);
// --max-evals, --time-limit, --target.
void add_budget(CLI::App& app, Budget& budget);

// --format of the tables that the verb prints.
void add_format(CLI::App& app, std::string& format);
// Of verbs that write files instead of printing tables.
void add_json(CLI::App& app, bool& json);
// --out and --overwrite of a study whose records and tables go to a folder.
void add_study_folder(CLI::App& app, std::string& out, bool& overwrite);
// A whole number between two limits.
void add_count(CLI::App& app, const std::string& name, int& value, int lowest, int highest,
               const std::string& help);
void add_seed(CLI::App& app, std::uint64_t& seed, const std::string& help);
void add_threads(CLI::App& app, int& threads);
// --wait of verbs that write to a store.
void add_wait(CLI::App& app, int& seconds);
// --out and --overwrite of verbs that write each run as it ends.
void add_run_folder(CLI::App& app, std::string& out, bool& overwrite);
// --seed and --threads of simulated drives.
void add_noise_options(CLI::App& app, std::uint64_t& seed, int& threads);
CLI::Option* add_scenario(CLI::App& app, const std::string& name, std::string& scenario);
// --robot of verbs that have --scenario, too; require_one() throws std::invalid_argument unless one of them
// is given.
CLI::Option* add_robot(CLI::App& app, std::string& robot);
void require_one(const std::string& scenario, const std::string& robot);

// Sets what the configuration file says and the command line, parsed before, does not. Throws
// std::invalid_argument "file:line: ..." on unknown keys and bad values.
void apply_config(CLI::App& app, const std::string& config);

// ", did you mean '--x'?" or "" for an option that `app` does not have; "--x=1" counts as "--x".
std::string option_suggestion(const CLI::App& app, const std::string& typed);

}  // namespace odobench
