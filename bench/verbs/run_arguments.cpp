#include "bench/verbs/run_arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/verbs/config_file.hpp"
#include "solvers/options.hpp"

namespace odobench {

CLI::Option* add_value(CLI::App& app, const std::string& name, const char* type, const std::string& help,
                       const std::function<void(const std::string&)>& set) {
  return app.add_option_function<std::string>(name, set, help)->type_name(type);
}

void add_kernel(CLI::App& app, std::optional<InstructionSet>& kernel, const std::string& remark) {
  add_value(
      app, "--kernel", "auto|avx512|avx2|baseline",
      fmt::format("vector instructions of the cost evaluations; {} [$ODOBENCH_KERNEL, else auto: the widest "
                  "of this processor]",
                  remark),
      [&kernel](const std::string& text) { kernel = instruction_set("--kernel", text); });
}

void add_budget(CLI::App& app, Budget& budget) {
  add_value(app, "--max-evals", "N",
            fmt::format("evaluations (costs and derivatives) of a run at most; 'none' lifts the limit [{}]",
                        kDefaultMaxEvaluations),
            [&budget](const std::string& text) {
              budget.max_evaluations = text == "none" ? 0 : whole_number("--max-evals", text, 1);
            });
  add_value(
      app, "--time-limit", "S", "seconds of a run at most [unlimited]",
      [&budget](const std::string& text) { budget.max_seconds = finite_number("--time-limit", text, true); });
  add_value(
      app, "--target", "J", "stop a run once its cost is at most this",
      [&budget](const std::string& text) { budget.target_cost = finite_number("--target", text, false); });
}

void add_run_options(CLI::App& app, RunOptions& options, std::string& config) {
  app.add_option(
         "--solver", options.solvers,
         "solvers, e.g. lm,pso[swarm=60,inertia=0.7]; 'all' for every one; may be given again [lm,ip,ga,pso]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--data", options.data, "data set of the calibration problem [the demo set]")
      ->type_name("SET.JSON");
  app.add_option(
         "--problem", options.problems,
         "problems and patterns of names, e.g. rosenbrock,nist:*,mgh:*/10; may be given again [calibration]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_value(app, "--dimension", "N", "dimension of classic problems", [&options](const std::string& text) {
    options.dimension = static_cast<int>(whole_number("--dimension", text, 1, 1000));
  });
  add_value(app, "--repeat", "N", "runs of every solver, each with a seed of its own [1]",
            [&options](const std::string& text) {
              options.repeat = static_cast<int>(whole_number("--repeat", text, 1, 100000));
            });
  add_value(app, "--seed", "N", "base of all seeds [1]",
            [&options](const std::string& text) { options.seed = seed_number("--seed", text); });
  add_value(app, "--threads", "N", "threads; results do not depend on them [one per core]",
            [&options](const std::string& text) {
              options.threads = static_cast<int>(whole_number("--threads", text, 1, 1024));
            });
  add_kernel(app, options.kernel, kLastBits);
  add_budget(app, options.budget);
  add_value(app, "--start", "nominal|random",
            "where runs begin; random starts are shared by all solvers [nominal]",
            [&options](const std::string& text) {
              if (text != "nominal" && text != "random")
                throw std::invalid_argument(fmt::format("--start={}: expected nominal or random", text));
              options.start = text;
            });
  app.add_flag("--check-derivatives", options.check_derivatives,
               "before the run, compare Jacobian and gradient with differences at the start and at three "
               "random points; exit "
               "code 1 where they disagree");
  app.add_option("--polish", options.polish,
                 "solver that goes on from the best point of each run, within its budget")
      ->type_name("SOLVER");
  app.add_option("--out", options.out, "folder for runs.jsonl (a line per run, as it ends) and tables.*")
      ->type_name("DIR");
  app.add_flag("--overwrite", options.overwrite, "replace the runs.jsonl of an earlier call in --out");
  app.add_option("--format", options.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  app.add_option("--config", config, "options from a JSON or INI/TOML file; the command line wins")
      ->type_name("FILE");
  app.add_flag("--quiet", options.quiet,
               "no progress and no remarks on standard error, only warnings and errors");
}

void apply_config(CLI::App& app, const std::string& config) {
  for (const ConfigEntry& entry : read_config(config)) {
    if (entry.key == "json")
      throw std::invalid_argument(
          fmt::format("{}: unknown key 'json', write format = \"json\"", entry.where));
    const bool no_key = entry.key == "config" || entry.key == "help" || entry.key == "version";
    CLI::Option* option = no_key ? nullptr : app.get_option_no_throw("--" + entry.key);
    if (option == nullptr)
      throw std::invalid_argument(fmt::format("{}: unknown key '{}'{}", entry.where, shown(entry.key),
                                              option_suggestion(app, entry.key)));
    if (option->count() > 0) continue;
    try {
      for (const std::string& value : entry.values) option->add_result(value);
      option->run_callback();
    } catch (const std::exception& error) {
      throw std::invalid_argument(fmt::format("{}: {}", entry.where, error.what()));
    }
  }
}

std::string option_suggestion(const CLI::App& app, const std::string& typed) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const auto begin = std::min(typed.find_first_not_of('-'), typed.size());
  const std::string near = nearest_name(typed.substr(begin, typed.find('=') - begin), names);
  if (near.empty() || near == typed) return {};
  return fmt::format(", did you mean '{}{}'?", begin > 0 ? "--" : "", near);
}

}  // namespace odobench
