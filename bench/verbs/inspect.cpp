#include <filesystem>

#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/importing/log_study.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "bench/verbs/verbs.hpp"
#include "problems/inspection/mend.hpp"

namespace odobench {
namespace {

constexpr const char* kInspectExamples = R"(Examples:
  bench inspect set.json
  bench inspect set.json --fix --out=mended.json
  bench inspect drive.bag --map=map.json
Exit code 1 where something is found without which a calibration is meaningless. docs/inspect.md has all kinds.)";

struct InspectOptions {
  std::vector<std::string> what;  // a set, or logs
  std::string map;                // of logs
  bool fix = false;
  std::string out;  // data set to write
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, InspectOptions& o) {
  app.add_option("what", o.what, "data set, or logs with --map [the demo set]")->type_name("SET.JSON|LOG...");
  app.add_option("--map", o.map, "of logs: what is what in them (docs/logs.md)")->type_name("MAP.JSON");
  app.add_flag("--fix", o.fix, "write a set in which everything is mended that can be");
  app.add_option("--out", o.out, "of --fix: the data set to write")->type_name("SET.JSON");
  app.add_flag("--overwrite", o.overwrite, "replace a data set that is there");
  add_format(app, o.format);
  app.footer(kInspectExamples);
}

InspectedSet look_at(const InspectOptions& o) {
  const bool logs = !o.what.empty() && (!o.map.empty() || o.what.size() > 1 || !is_dataset(o.what.front()));
  if (!logs) return inspect_set(o.what.empty() ? "" : o.what.front());
  if (o.map.empty())
    throw std::invalid_argument(
        "logs need --map=MAP.JSON: bench import LOG... --propose > map.json begins one (docs/logs.md)");
  TerminalWatcher watcher;
  ImportedLogs imported = import_logs({{o.what.begin(), o.what.end()}, read_file(o.map), o.map, {}}, watcher,
                                      InterruptGuard::stop());
  InspectedSet set{std::move(imported.dataset), {}};
  set.findings = inspect_recordings(set.dataset.robot, set.dataset.recordings);
  return set;
}

ExitCode inspect_command(const InspectOptions& o) {
  const Format format = parse_format(o.format);
  if (o.fix != !o.out.empty()) throw std::invalid_argument("--fix and --out belong together");
  if (o.fix) require_writable(o.out, existing_files(o.overwrite), "--out");
  InspectedSet set = look_at(o);
  std::vector<Table> tables =
      findings_tables(set.dataset.name, set.findings, format == Format::Json || format == Format::Csv);
  if (o.fix) {
    const std::vector<std::string> changes = inspection::mend(set.dataset, set.findings);
    for (const std::string& change : changes) tables.front().notes.push_back("Mended: " + change + ".");
    if (changes.empty()) tables.front().notes.push_back("There was nothing to mend.");
    save_announced(set.dataset, o.out, o.overwrite, false);
  }
  print_tables(tables, format);
  return inspection::any_error(set.findings) ? ExitCode::CheckFailed : ExitCode::Success;
}

}  // namespace

VerbAction add_inspect(CLI::App& app) {
  return verb_action<InspectOptions>(app, add_options, inspect_command);
}

}  // namespace odobench
