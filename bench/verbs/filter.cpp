#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/filter_options.hpp"
#include "bench/studies/entropy/filter_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"

namespace odobench {
namespace {

ExitCode filter_command(const FilterOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  EntropyOptions study = options.study;
  refuse_existing("--out", study.out, study.overwrite);
  RunFolder folder(options.records, study.overwrite, "--records");
  folder.require_free();
  study.checksum = folder.keeps();
  TerminalWatcher watcher(options.quiet);
  const FilteredRun run = filter_run(study, catalogue, print_text, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = filter_tables({run.record});
  folder.keep({run.record}, tables, watcher);
  if (study.out != "-") print_tables(tables, format);
  if (run.unfinished)
    watcher.note(fmt::format("{}: the last line has no line break; it was taken, since it has all its fields",
                             study.data));
  if (run.interrupted) note(fmt::format("interrupted after {} windows", run.windows));
  return run.interrupted ? ExitCode::Interrupted : ExitCode::Success;
}

}  // namespace

VerbAction add_filter(CLI::App& app) {
  return verb_action<FilterOptions>(app, add_filter_options, filter_command);
}

}  // namespace odobench
