#include "bench/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "base/files.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/console/faults.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/context.hpp"
#include "bench/verbs/check_command.hpp"
#include "bench/verbs/compare_command.hpp"
#include "bench/verbs/entropy_arguments.hpp"
#include "bench/verbs/entropy_command.hpp"
#include "bench/verbs/evaluate_command.hpp"
#include "bench/verbs/fusion_arguments.hpp"
#include "bench/verbs/import_command.hpp"
#include "bench/verbs/list_command.hpp"
#include "bench/verbs/plan_command.hpp"
#include "bench/verbs/report_command.hpp"
#include "bench/verbs/run_arguments.hpp"
#include "bench/verbs/run_command.hpp"
#include "bench/verbs/simulate_command.hpp"
#include "bench/verbs/verify_command.hpp"
#include "bench/verbs/windows_command.hpp"
#include "solvers/options.hpp"

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

constexpr const char* kRunExamples = R"(Examples:
  bench --solver=lm --data=set.json
  bench --solver=pso,cmaes --repeat=20 --seed=7 --max-evals=30000 --out=results --format=md
  bench --solver=lm,ip --start=random --repeat=20
  bench --config=experiment.json --threads=1
A configuration file holds these options without dashes: {"solver": ["lm", "pso[swarm=60]"], "repeat": 10}
Every method also ends by itself; 'bench list solvers' shows its options.)";

// Everything CLI11 writes to.
struct Arguments {
  RunOptions run;
  std::string config;
  EvaluateOptions evaluate;
  ListOptions list;
  FilterOptions filter;
  WindowsOptions windows;
  ImportOptions import;
  DemoOptions demo;
  SimulateOptions simulate;
  PlanOptions plan;
  VerifyOptions verify;
  CheckOptions check;
  ReportOptions report;
  ExportOptions exporting;
  CompareArguments compare;
  FusionArguments fusion;
};

// Of verbs that write files instead of printing tables.
void add_json(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "say on standard output, as JSON, what was written");
}

std::vector<Verb> add_reading_verbs(CLI::App& app, Arguments& a) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "cost and error tables of given parameters");
  evaluate->add_option("--data", a.evaluate.data, "data set [the demo set]")->type_name("SET.JSON");
  evaluate
      ->add_option("--parameters", a.evaluate.parameters,
                   "JSON files ({\"a1\": 0.1125, ...} in metres, or an array of such), 'nominal', or names "
                   "the set knows "
                   "such as published:lm, truth; a comma list, may be given again [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  evaluate
      ->add_option(
          "--tracks", a.evaluate.tracks,
          "write the paths that the parameters give as CSV, for plots; - for standard output, without tables")
      ->type_name("FILE.CSV");
  add_kernel(*evaluate, a.evaluate.kernel, kLastBits);
  evaluate->add_option("--out", a.evaluate.out, "keep records, tables and tracks in this folder")
      ->type_name("DIR");
  evaluate->add_flag("--overwrite", a.evaluate.overwrite, "replace what --tracks or --out find there");
  add_format(*evaluate, a.evaluate.format);

  CLI::App* list = app.add_subcommand("list", "solvers with their options, problems, data sets, scenarios");
  list->add_option("what", a.list.what, "solvers, problems, data or scenarios")->required();
  list->add_option("set", a.list.data, "with data or scenarios: the one to describe [known places]");
  add_format(*list, a.list.format);

  CLI::App* report = app.add_subcommand(
      "report", "stored runs as tables, as one HTML page, or as figures; nothing is solved again");
  report
      ->add_option("--out", a.report.out,
                   "write one self-contained page that needs no network; - for standard output")
      ->type_name("FILE.HTML");
  report->add_option("--figures", a.report.figures, "write every figure as an SVG file into this folder")
      ->type_name("DIR");
  report->add_option("--title", a.report.title, "of the page [what was run]")->type_name("TEXT");
  report->add_flag("--overwrite", a.report.overwrite, "replace the page or the figures that are there");
  report->add_option("runs", a.report.runs, "folders with runs.jsonl, or .jsonl files")->required();
  add_format(*report, a.report.format);

  CLI::App* exporting = app.add_subcommand("export", "trajectories of a run directory for other programs");
  exporting->add_option("run", a.exporting.run, "folder of a run with --out")->required();
  exporting->add_flag("--tum", a.exporting.tum,
                      "the TUM format that evo and others read: time x y z qx qy qz qw");
  exporting
      ->add_option("--out", a.exporting.out, "folder to write: LABEL/RECORDING.tum, reference/RECORDING.tum")
      ->required()
      ->type_name("DIR");
  exporting->add_flag("--overwrite", a.exporting.overwrite, "replace files that are there");
  add_json(*exporting, a.exporting.json);

  CLI::App* check =
      app.add_subcommand("check", "compare stored runs with a baseline; exit code 1 when something moved");
  check->add_option("--baseline", a.check.baseline, "file of expected values with tolerances")
      ->required()
      ->type_name("FILE");
  check->add_option("runs", a.check.runs, "folders with runs.jsonl, or .jsonl files")->required();
  check->add_flag("--update", a.check.update,
                  "write these runs to the baseline instead, keeping its tolerances");
  add_format(*check, a.check.format);

  CLI::App* compare = add_compare_verb(app, a.compare);
  add_format(*compare, a.compare.format);

  return {{evaluate, [&a] { return evaluate_command(a.evaluate); }},
          {list, [&a] { return list_command(a.list); }},
          {report, [&a] { return report_command(a.report); }},
          {exporting, [&a] { return export_command(a.exporting); }},
          {check, [&a] { return check_command(a.check); }},
          {compare, [&a] { return compare_command(a.compare); }}};
}

std::vector<Verb> add_writing_verbs(CLI::App& app, Arguments& a) {
  CLI::App* run = app.add_subcommand("run", "run solvers on a problem and compare them (the default verb)");
  add_run_options(*run, a.run, a.config);
  run->footer(kRunExamples);

  CLI::App* filter = app.add_subcommand("filter", "the relative-entropy filter over a recorded run");
  add_filter_options(*filter, a.filter);
  CLI::App* windows =
      app.add_subcommand("windows", "solve windows of the relative-entropy filter and compare the methods");
  add_windows_options(*windows, a.windows);

  CLI::App* import = app.add_subcommand("import", "make a data set of published raw files");
  import->add_option("source", a.import.source, "vitko2024")->required();
  import->add_option("--from", a.import.from, "folder with the raw files")->required()->type_name("DIR");
  import->add_option("--out", a.import.out, "data set to write")->required()->type_name("SET.JSON");
  import->add_flag("--drop-lost", a.import.drop_lost,
                   "leave out captured samples whose tracking was lost, and count them");
  import->add_flag("--overwrite", a.import.overwrite, "replace a data set that is there");
  import->add_flag("--quiet", a.import.quiet, "no progress");
  add_json(*import, a.import.json);

  CLI::App* demo = app.add_subcommand("demo", "make the demo data set");
  demo->add_option("--out", a.demo.out, "folder for set.json")->required()->type_name("DIR");
  demo->add_option_function<std::string>(
          "--seed", [&a](const std::string& text) { a.demo.seed = seed_number("--seed", text); },
          "of its noise [that of the set in the repository]")
      ->type_name("N");
  demo->add_flag("--overwrite", a.demo.overwrite, "replace a data set that is there");
  add_json(*demo, a.demo.json);

  return {{run,
           [run, &a] {
             if (!a.config.empty()) apply_config(*run, a.config);
             return run_command(a.run);
           }},
          {filter, [&a] { return filter_command(a.filter); }},
          {windows, [&a] { return windows_command(a.windows); }},
          {import, [&a] { return import_command(a.import); }},
          {demo, [&a] { return demo_command(a.demo); }}};
}

// Every verb has --json. Those with tables take it for --format=json, so that a configuration file does not overrule it; the others
// have a flag of their own (add_json).
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

// Puts the default verb in front and refuses an unknown one.
void complete_verb(std::vector<std::string>& words, const std::vector<Verb>& verbs) {
  const bool top = !words.empty() && (words[0] == "-h" || words[0] == "--help" || words[0] == "--version");
  if (top) return;
  if (words.empty() || words[0].rfind('-', 0) == 0) {
    words.insert(words.begin(), "run");
    return;
  }
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.push_back(verb.app->get_name());
  if (std::find(names.begin(), names.end(), words[0]) != names.end()) return;
  throw std::invalid_argument(
      fmt::format("unknown verb '{}'{}; 'bench --help' lists them", words[0], did_you_mean(words[0], names)));
}

void add_count(CLI::App& app, const std::string& name, int& value, int lowest, int highest,
               const std::string& help) {
  app.add_option_function<std::string>(
         name,
         [name, &value, lowest, highest](const std::string& text) {
           value = static_cast<int>(whole_number(name, text, lowest, highest));
         },
         help)
      ->type_name("N");
}

void add_noise_options(CLI::App& app, std::uint64_t& seed, int& threads) {
  app.add_option_function<std::string>(
         "--seed", [&seed](const std::string& text) { seed = seed_number("--seed", text); },
         "of the noise [1]")
      ->type_name("N");
  add_count(app, "--threads", threads, 1, 1024, "threads; results do not depend on them [one per core]");
}

CLI::Option* add_scenario(CLI::App& app, const std::string& name, std::string& scenario) {
  return app.add_option(name, scenario, "file or name; 'bench list scenarios' shows them")
      ->required()
      ->type_name("FILE|NAME");
}

std::vector<Verb> add_simulation_verbs(CLI::App& app, Arguments& a) {
  CLI::App* simulate = app.add_subcommand("simulate", "make recordings or sensor logs of a simulated robot");
  add_scenario(*simulate, "--scenario", a.simulate.scenario);
  simulate->add_option("--out", a.simulate.out, "folder to write")->required()->type_name("DIR");
  add_noise_options(*simulate, a.simulate.seed, a.simulate.threads);
  simulate->add_flag("--raw", a.simulate.raw, "raw CSV files as published, for 'bench import vitko2024'");
  simulate->add_flag("--as-published", a.simulate.as_published,
                     "the motor robot with the errors of its thesis (kind dynamics)");
  simulate->add_flag("--overwrite", a.simulate.overwrite, "replace files that are there");
  simulate->add_flag("--quiet", a.simulate.quiet, "no remarks");
  add_json(*simulate, a.simulate.json);

  CLI::App* plan =
      app.add_subcommand("plan", "which parameters drives can determine, and which drives to add");
  add_scenario(*plan, "--robot", a.plan.robot);
  plan->add_option(
          "--drives", a.plan.drives,
          "drives, a name once per time it is driven, or 'none'; a comma list [those of the scenario]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  plan->add_option("--candidates", a.plan.candidates,
                   "propose drives out of these, 'all' or a comma list, until --wanted is met")
      ->type_name("LIST")
      ->allow_extra_args(false);
  plan->add_option_function<std::string>(
          "--wanted",
          [&a](const std::string& text) { a.plan.wanted = finite_number("--wanted", text, true, 1e6) / 100; },
          "standard deviation of every parameter, % of its nominal value [0.5]")
      ->type_name("PERCENT");
  add_count(*plan, "--replicas", a.plan.replicas, 2, 10000,
            "simulations per drive that its noise is taken from [32]");
  add_noise_options(*plan, a.plan.seed, a.plan.threads);
  add_kernel(*plan, a.plan.kernel, kLastBits);
  add_format(*plan, a.plan.format);

  CLI::App* verify =
      app.add_subcommand("verify", "judge parameter sets on new drives that are steered by them");
  add_scenario(*verify, "--scenario", a.verify.scenario);
  verify
      ->add_option("--parameters", a.verify.parameters,
                   "JSON files, 'nominal', 'truth' or 'believed'; a comma list, may be given again")
      ->required()
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(*verify, "--repeat", a.verify.repeat, 1, 10000, "times that all drives are driven [10]");
  add_noise_options(*verify, a.verify.seed, a.verify.threads);
  add_kernel(*verify, a.verify.kernel, kNamedOnly);
  add_format(*verify, a.verify.format);

  return {{simulate, [&a] { return simulate_command(a.simulate); }},
          {plan, [&a] { return plan_command(a.plan); }},
          {verify, [&a] { return verify_command(a.verify); }}};
}

ExitCode dispatch(std::vector<std::string> words) {
  CLI::App app{"Calibrates wheeled robots from recordings and compares the solvers that do it.", "bench"};
  Arguments arguments;
  std::vector<Verb> verbs = add_writing_verbs(app, arguments);
  for (Verb& verb : add_reading_verbs(app, arguments)) verbs.push_back(std::move(verb));
  for (Verb& verb : add_fusion_verbs(app, arguments.fusion)) verbs.push_back(std::move(verb));
  for (Verb& verb : add_simulation_verbs(app, arguments)) verbs.push_back(std::move(verb));
  app.footer(kProgramExamples);
  app.set_version_flag("--version", version_line);
  for (const Verb& verb : verbs) {
    verb.app->allow_extras();
    offer_json(*verb.app);
    verb.app->set_version_flag("--version", version_line);
  }
  complete_verb(words, verbs);
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
    for (const Verb& verb : verbs)
      if (verb.app->parsed()) refuse_leftovers(*verb.app);  // a misspelt option explains a missing one
    throw std::invalid_argument(error.what());
  }
  for (const Verb& verb : verbs) {
    if (!verb.app->parsed()) continue;
    refuse_leftovers(*verb.app);
    apply_json(*verb.app);
    return verb.execute();
  }
  throw std::logic_error("no verb was parsed");
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
    return static_cast<int>(dispatch(std::vector<std::string>(argv + std::min(argc, 1), argv + argc)));
  } catch (...) {
    const Ending ending = ending_of(std::current_exception());
    return fail(ending.code, ending.message);
  }
}

}  // namespace odobench
