#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <tuple>

#include "base/error.hpp"
#include "base/files.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/records.hpp"
#include "reports/regression/baseline.hpp"

namespace odobench {
namespace {

struct CheckOptions {
  std::string baseline;
  std::vector<std::string> runs;  // folders or .jsonl files
  bool update = false;
  std::string format = "console";
};

void add_options(CLI::App& app, CheckOptions& o) {
  app.add_option("--baseline", o.baseline, "file of expected values with tolerances")
      ->required()
      ->type_name("FILE");
  app.add_option("runs", o.runs, "folders with runs.jsonl, or .jsonl files")->required();
  app.add_flag("--update", o.update, "write these runs to the baseline instead, keeping its tolerances");
  add_format(app, o.format);
}

}  // namespace

namespace {

ExitCode check_command(const CheckOptions& options) {
  const Format format = parse_format(options.format);
  TerminalWatcher watcher;
  const std::vector<RunRecord> records = read_all_records(options.runs, watcher);
  if (options.update) {
    Baseline before;
    if (std::filesystem::exists(options.baseline)) before = read_baseline(options.baseline);
    Baseline baseline = make_baseline(records, before.tolerances);
    for (BaselineEntry& entry : baseline.entries)
      for (const BaselineEntry& old : before.entries)
        if (std::tie(old.problem, old.dataset, old.label) ==
            std::tie(entry.problem, entry.dataset, entry.label))
          entry.tolerances = old.tolerances;
    InterruptGuard::remember();
    write_file(options.baseline, to_json_text(baseline));
    note(fmt::format("{}: {} entries written", options.baseline, baseline.entries.size()));
    if (format == Format::Json) print_tables({written_table({options.baseline})}, format);
    return ExitCode::Success;
  }
  const BaselineReport report = check_baseline(read_baseline(options.baseline), records);
  print_tables({report.table}, format);
  if (report.compared == 0)
    warn(fmt::format("nothing to compare: no entry of {} meets a record", options.baseline));
  return report.passed ? ExitCode::Success : ExitCode::CheckFailed;
}

}  // namespace

VerbAction add_check(CLI::App& app) {
  return verb_action<CheckOptions>(app, add_options, check_command);
}

}  // namespace odobench
