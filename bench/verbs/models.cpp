#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/trust/models_study.hpp"
#include "bench/verbs/verbs.hpp"
#include "reports/kinds/trust/models_tables.hpp"

namespace odobench {
namespace {

struct ModelsOptions {
  ModelsStudy study;
  std::string out;
  bool overwrite = false, quiet = false;
  std::string format = "console";
};

void add_options(CLI::App& app, ModelsOptions& o) {
  app.add_option("--data", o.study.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--models", o.study.models,
                 "models to compare, names combined by '+', 'plain' for none; may be given again [those that "
                 "suit the robot]")
      ->type_name("NAME+NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_cost(app, o.study.calibration);
  add_kernel(app, o.study.kernel, kLastBits);
  add_threads(app, o.study.threads);
  add_study_folder(app, o.out, o.overwrite);
  app.add_flag("--quiet", o.quiet, "no progress on standard error, only warnings and errors");
  add_format(app, o.format);
}

ExitCode models_command(const ModelsOptions& o) {
  const Format format = parse_format(o.format);
  RunFolder folder(o.out, o.overwrite);
  folder.require_free();
  TerminalWatcher watcher(o.quiet);
  ModelsStudy study = o.study;
  for (std::string& model : study.models)
    if (model == "plain") model.clear();
  const std::vector<RunRecord> records = compare_models(study, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = models_tables(records);
  folder.keep(records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_models(CLI::App& app) {
  return verb_action<ModelsOptions>(app, add_options, models_command);
}

}  // namespace odobench
