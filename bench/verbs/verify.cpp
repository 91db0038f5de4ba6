#include "bench/verbs/verbs.hpp"

#include <stdexcept>

#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/planning/verification.hpp"
#include "bench/studies/run_folder.hpp"
#include "reports/kinds/verification/verification_tables.hpp"

namespace odobench {
namespace {

struct VerifyOptions {
  VerificationStudy study;
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, VerifyOptions& o) {
  add_scenario(app, "--scenario", o.study.scenario);
  add_robot(app, o.study.robot);
  app.add_option(
         "--truth", o.study.truth,
         "of --robot: parameters of the simulated robot, a name or a JSON file [the first of --parameters]")
      ->type_name("NAME|FILE");
  app.add_option("--parameters", o.study.parameters,
                 "JSON files, 'nominal', 'truth' or 'believed'; a comma list, may be given again")
      ->required()
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(app, "--repeat", o.study.repeat, 1, 10000, "times that all drives are driven [10]");
  add_noise_options(app, o.study.seed, o.study.threads);
  add_kernel(app, o.study.kernel, kNamedOnly);
  add_study_folder(app, o.out, o.overwrite);
  add_format(app, o.format);
}

ExitCode verify_command(const VerifyOptions& o) {
  require_one(o.study.scenario, o.study.robot);
  if (!o.study.scenario.empty() && !o.study.truth.empty())
    throw std::invalid_argument("--truth: it belongs to --robot; a scenario states its own");
  const Format format = parse_format(o.format);
  RunFolder folder(o.out, o.overwrite);
  folder.require_free();
  TerminalWatcher watcher;
  const Verification v = verify_parameters(o.study, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = verification_tables(v.rounds);
  folder.keep(v.records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_verify(CLI::App& app) {
  return verb_action<VerifyOptions>(app, add_options, verify_command);
}

}  // namespace odobench
