#include "bench/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "base/files.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/console/faults.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/context.hpp"
#include "bench/verbs/verbs.hpp"

namespace odobench {
namespace {

constexpr const char* kProgramExamples = R"(Examples:
  bench                                              four solvers on the demo set
  bench --solver=lm,pso --data=set.json --repeat=10  compare on your own data
  bench --solver="pso[swarm=60],ga" --polish=lm --out=results
  bench --solver=all --problem=rosenbrock --dimension=6 --start=random
  bench evaluate --data=set.json --parameters=nominal,mine.json
  bench filter --data=run.csv --truth=truth.csv --out=filtered.csv
  bench windows windows.json --solver=coordinate,exact,relaxed,lm,pso
  bench list solvers
  bench import vitko2024 --from=DIR --out=set.json
  bench check --baseline=golden.json results
  bench compare results/old results/new --fail-on="J:+0.1%,evaluations:+50%"

Without a verb bench runs solvers: 'bench run --help' lists those options.
Exit codes: 0 done, 1 a check failed or no solver gave a result, 2 wrong usage, 3 wrong data, 70 a fault of the program, 130 interrupted.)";

struct Verb {
  const char* name;
  const char* summary;
  VerbAction (*add_options)(CLI::App& app);
};

// In the order of the help. Without a verb the first one is meant.
constexpr std::array<Verb, 22> kVerbs{{
    {"run", "run solvers on a problem and compare them (the default verb)", add_run},
    {"campaign", "run a matrix of solvers, problems and repetitions into a store; goes on after an end",
     add_campaign},
    {"store", "what is in a store of a campaign; SQL, export and import", add_store},
    {"calibrate", "from logs of any format to parameters, in one go", add_calibrate},
    {"filter", "the relative-entropy filter over a recorded run", add_filter},
    {"windows", "solve windows of the relative-entropy filter and compare the methods", add_windows},
    {"import", "make a data set of published raw files", add_import},
    {"demo", "make the demo data set", add_demo},
    {"inspect", "what is implausible about the recordings of a set, and a mended set", add_inspect},
    {"evaluate", "cost and error tables of given parameters", add_evaluate},
    {"models", "compare models of a robot by recordings that they were not fitted to", add_models},
    {"list", "solvers with their options, problems, data sets, scenarios", add_list},
    {"report", "stored runs as tables, as one HTML page, or as figures; nothing is solved again", add_report},
    {"export", "trajectories of a run directory for other programs", add_export},
    {"check", "compare stored runs with a baseline; exit code 1 when something moved", add_check},
    {"compare", "two sets of stored runs side by side; says what changed", add_compare},
    {"discretise", "F, Psi, Gamma, Q of a linear system x' = A x + B u + G w", add_discretise},
    {"fuse", "fuse wheel odometry with (synthetic) camera and gyro, and compare", add_fuse},
    {"tune", "fit a filter's noise parameters with any solver", add_tune},
    {"simulate", "make recordings or sensor logs of a simulated robot", add_simulate},
    {"plan", "which parameters drives can determine, and which drives to add", add_plan},
    {"verify", "judge parameter sets on new drives that are steered by them", add_verify},
}};

// Every verb has --json. Those with tables take it for --format=json, so that a configuration file does not
// overrule it; the others have a flag of their own (add_json).
void offer_json(CLI::App& verb) {
  if (verb.get_option_no_throw("--json") == nullptr)
    verb.add_flag("--json")->description("the same as --format=json");
}

void apply_json(CLI::App& verb) {
  CLI::Option* format = verb.get_option_no_throw("--format");
  if (format == nullptr || verb.get_option("--json")->count() == 0) return;
  if (format->count() > 0 && format->as<std::string>() != "json")
    throw std::invalid_argument(
        fmt::format("--json: it contradicts --format={}, expected one of them", format->as<std::string>()));
  format->clear();
  format->add_result("json");
  format->run_callback();
}

// CLI11 would report leftovers as a list; one line with the nearest name is clearer.
void refuse_leftovers(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining();
  if (left.empty()) return;
  if (left.front().rfind('-', 0) == 0 && left.front().size() > 1)
    throw std::invalid_argument(fmt::format("unknown option '{}'{}; 'bench {} --help' lists them",
                                            left.front(), option_suggestion(app, left.front()),
                                            app.get_name()));
  throw std::invalid_argument(
      fmt::format("unexpected argument '{}'; see 'bench {} --help'", left.front(), app.get_name()));
}

// Puts the default verb in front and refuses an unknown one. "" when the program itself is asked for its help
// or version.
std::string complete_verb(std::vector<std::string>& words) {
  if (!words.empty() && (words[0] == "-h" || words[0] == "--help" || words[0] == "--version")) return "";
  if (words.empty() || words[0].rfind('-', 0) == 0) words.insert(words.begin(), kVerbs.front().name);
  std::vector<std::string> names;
  for (const Verb& verb : kVerbs) names.emplace_back(verb.name);
  if (std::find(names.begin(), names.end(), words[0]) != names.end()) return words[0];
  throw std::invalid_argument(
      fmt::format("unknown verb '{}'{}; 'bench --help' lists them", words[0], did_you_mean(words[0], names)));
}

ExitCode dispatch(std::vector<std::string> words, const Catalogue& catalogue) {
  CLI::App app{"Calibrates wheeled robots from recordings and compares the solvers that do it.", "bench"};
  app.footer(kProgramExamples);
  app.set_version_flag("--version", version_line);
  const std::string name = complete_verb(words);
  CLI::App* verb = nullptr;
  VerbAction execute;
  for (const Verb& known : kVerbs) {
    CLI::App* const added = app.add_subcommand(known.name, known.summary);
    if (name != known.name) continue;  // its options are not needed
    verb = added;
    execute = known.add_options(*verb);
    verb->allow_extras();
    offer_json(*verb);
    verb->set_version_flag("--version", version_line);
  }
  for (const std::string& word : words)  // CLI11 would take the next word for its value
    if (word.rfind("--", 0) == 0 && word.find('=') == word.size() - 1)
      throw std::invalid_argument(fmt::format("{}: a value is missing after '='", word));
  std::reverse(words.begin(), words.end());  // the order CLI11 takes a vector in
  try {
    app.parse(words);
  } catch (const CLI::CallForHelp&) {
    print_text(app.help());
    return ExitCode::Success;
  } catch (const CLI::CallForVersion& version) {
    print_text(std::string(version.what()) + "\n");
    return ExitCode::Success;
  } catch (const CLI::ParseError& error) {
    if (verb != nullptr && verb->parsed())
      refuse_leftovers(*verb);  // a misspelt option explains a missing one
    throw std::invalid_argument(error.what());
  }
  if (verb == nullptr || !verb->parsed()) throw std::logic_error("no verb was parsed");
  refuse_leftovers(*verb);
  apply_json(*verb);
  return execute(catalogue);
}

int fail(ExitCode code, const std::string& message) {
  const std::string line = fmt::format("bench: error: {}\n", one_line_message(message));
  std::fwrite(line.data(), 1, line.size(), stderr);
  return static_cast<int>(code);
}

}  // namespace

int bench_main(int argc, char** argv) {
  open_standard_descriptors();
  announce_crashes();
  const InterruptGuard guard;
  try {
    Catalogue catalogue;
    add_known(catalogue);
    return static_cast<int>(dispatch({argv + std::min(argc, 1), argv + argc}, catalogue));
  } catch (...) {
    const Ending ending = ending_of(std::current_exception());
    return fail(ending.code, ending.message);
  }
}

}  // namespace odobench
