#include "bench/verbs/fusion_arguments.hpp"

#include "bench/catalogue/number_text.hpp"
#include "bench/verbs/run_arguments.hpp"
#include "problems/kalman/linear_system.hpp"

namespace odobench {
void add_format(CLI::App& app, std::string& format) {
  app.add_option("--format", format, "of the tables [console]")->type_name("console|md|csv|json|latex");
}

namespace {

Verb add_discretise(CLI::App& app, DiscretiseOptions& o) {
  CLI::App* verb =
      app.add_subcommand("discretise", "F, Psi, Gamma, Q of a linear system x' = A x + B u + G w");
  verb->add_option("--system", o.system, "JSON file with A and, if there are, B, G and Qc")
      ->required()
      ->type_name("FILE");
  verb->add_option_function<std::string>(
          "--period",
          [&o](const std::string& text) { o.period = finite_number("--period", text, true, 1e6); },
          "time step, seconds")
      ->required()
      ->type_name("T");
  verb->add_option_function<std::string>(
          "--order",
          [&o](const std::string& text) {
            o.order = static_cast<int>(whole_number("--order", text, 1, kMaxSeriesOrder - 2));
          },
          "cut the series of the exponential after this power and show the error [exact]")
      ->type_name("N");
  add_format(*verb, o.format);
  return {verb, [&o] { return discretise_command(o); }};
}

Verb add_fuse(CLI::App& app, FuseOptions& o) {
  CLI::App* verb =
      app.add_subcommand("fuse", "fuse wheel odometry with (synthetic) camera and gyro, and compare");
  verb->add_option("--data", o.data, "data set [the demo set]")->type_name("SET.JSON");
  verb->add_option("--parameters", o.parameters, "parameter sets as of 'bench evaluate' [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  verb->add_option("--filter", o.filters,
                   "none, ekf, ukf, ekf-smoothed, ukf-smoothed, ekf-literal; a comma list [none,ekf,ukf]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  verb->add_option("--sensors", o.sensors, "JSON file: the sensors, their errors, what the filter believes")
      ->required()
      ->type_name("FILE");
  verb->add_option_function<std::string>(
          "--seed", [&o](const std::string& text) { o.seed = seed_number("--seed", text); },
          "of the synthetic sensors [that of the file]")
      ->type_name("N");
  verb->add_option_function<std::string>(
          "--threads",
          [&o](const std::string& text) {
            o.threads = static_cast<int>(whole_number("--threads", text, 1, 1024));
          },
          "threads; results do not depend on them [one per core]")
      ->type_name("N");
  add_kernel(*verb, o.kernel, kNamedOnly);
  verb->add_option("--out", o.out, "keep records, tables and tracks in this folder")->type_name("DIR");
  verb->add_flag("--overwrite", o.overwrite, "replace runs that the folder holds");
  add_format(*verb, o.format);
  return {verb, [&o] { return fuse_command(o); }};
}

Verb add_tune(CLI::App& app, TuneOptions& o) {
  CLI::App* verb = app.add_subcommand("tune", "fit a filter's noise parameters with any solver");
  verb->add_option("--data", o.data, "data set [the demo set]")->type_name("SET.JSON");
  verb->add_option("--parameters", o.parameters, "parameter set of the wheels [nominal]")
      ->type_name("NAME|FILE");
  verb->add_option("--sensors", o.sensors, "JSON file as of 'bench fuse'; its sigmas are the start")
      ->required()
      ->type_name("FILE");
  verb->add_option("--solver", o.solvers, "solvers as of 'bench run' [nlopt:bobyqa]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  verb->add_option("--filter", o.filter, "ekf or ukf [ekf]")->type_name("NAME");
  verb->add_option(
          "--objective", o.objective,
          "likelihood (of the innovations) or error (of the pose against the reference) [likelihood]")
      ->type_name("NAME");
  verb->add_option_function<std::string>(
          "--max-evals",
          [&o](const std::string& text) { o.max_evaluations = whole_number("--max-evals", text, 1); },
          "evaluations of a run at most [200]")
      ->type_name("N");
  verb->add_option_function<std::string>(
          "--seed", [&o](const std::string& text) { o.seed = seed_number("--seed", text); },
          "of the synthetic sensors and the solvers [that of the file]")
      ->type_name("N");
  add_kernel(*verb, o.kernel, kNamedOnly);
  verb->add_option("--out", o.out, "write the sensors file with the best sigmas")->type_name("FILE");
  verb->add_flag("--overwrite", o.overwrite, "replace a file of --out that is there");
  add_format(*verb, o.format);
  return {verb, [&o] { return tune_command(o); }};
}

}  // namespace

std::vector<Verb> add_fusion_verbs(CLI::App& app, FusionArguments& a) {
  return {add_discretise(app, a.discretise), add_fuse(app, a.fuse), add_tune(app, a.tune)};
}

}  // namespace odobench
