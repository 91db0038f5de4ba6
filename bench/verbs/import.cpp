#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "base/files.hpp"
#include "base/text.hpp"
#include "bench/catalogue/importers.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/importing/log_proposal.hpp"
#include "bench/studies/importing/log_study.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "datasets/import/csv/csv_proposal.hpp"

namespace odobench {
namespace {

struct ImportOptions {
  std::vector<std::string> what;  // name of an importer, or logs
  std::string from;
  std::string out;
  std::string map;       // of csv: what the columns are
  std::string poses;     // of logs: table of end poses
  bool propose = false;  // print such a map
  bool show = false;     // print what stands in a log
  LogOptions log;
  std::vector<std::string> messages;  // files with definitions
  bool overwrite = false;
  std::string exclude;     // numbers of runs, separated by commas
  bool drop_lost = false;  // captured samples whose tracking was lost
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

// "vitko2024 or optiodom", of those that `takes` says so.
std::string names_of(const std::vector<ImporterEntry>& importers, const char* between,
                     bool ImporterEntry::*takes = nullptr) {
  std::vector<std::string> names;
  for (const ImporterEntry& importer : importers)
    if (takes == nullptr || importer.*takes) names.push_back(importer.name);
  return fmt::format("{}", fmt::join(names, between));
}

void add_options(CLI::App& app, ImportOptions& o) {
  app.add_option(
         "what", o.what,
         "logs of any format (bag, MCAP, rosbag2, CSV, MAT, npz, JSON lines, TUM, EuRoC, KITTI), or " +
             names_of(known_importers(), ", ") + " with --from")
      ->required()
      ->type_name("LOG...");
  app.add_option("--from", o.from,
                 "folder with the raw files; of optiodom one or several, of csv files, folders and patterns, "
                 "separated by commas")
      ->type_name("PLACE,...");
  app.add_option("--out", o.out, "data set to write; not with --propose")->type_name("SET.JSON");
  app.add_option("--map", o.map, "robot, signals and units (docs/import.md)")->type_name("MAP.JSON");
  app.add_option("--poses", o.poses,
                 "of logs without reference: a table of the poses at the ends, columns drive, x, y, theta")
      ->type_name("FILE.CSV");
  app.add_flag("--propose", o.propose,
               "print a map for these logs, with null for what they do not say, and why it is as it is");
  app.add_flag("--show", o.show, "print what stands in the logs: sources, rates, fields, first values");
  app.add_flag("--keep-cut", o.log.keep_cut, "of a log that is cut off take what stands before");
  app.add_option("--max-bytes", o.log.max_bytes, "decompressed bytes of one log [68719476736]")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  app.add_option("--msg", o.messages, "definition of a message that a log lacks; may be given again")
      ->type_name("FILE.msg")
      ->allow_extra_args(false);
  app.add_option("--exclude", o.exclude, "optiodom: numbers of runs to leave out, separated by commas")
      ->type_name("N,N,...");
  app.add_flag("--drop-lost", o.drop_lost,
               "vitko2024: leave out captured samples whose tracking was lost, and count them");
  app.add_flag("--overwrite", o.overwrite, "replace a data set that is there");
  app.add_flag("--quiet", o.quiet, "no progress");
  add_json(app, o.json);
}

std::vector<int> run_numbers(const std::string& list) {
  std::vector<int> numbers;
  if (list.empty()) return numbers;
  for (const std::string& item : comma_items(list)) {
    int number = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), number);
    if (error != std::errc() || end != item.data() + item.size() || number < 1)
      throw std::invalid_argument(
          fmt::format("--exclude: found '{}', expected numbers of runs, from 1", shown(item)));
    numbers.push_back(number);
  }
  return numbers;
}

Dataset import_from(const ImportOptions& options, const ImporterEntry& importer) {
  ImportRequest request{options.from, run_numbers(options.exclude), options.drop_lost, options.map, {}, {}};
  if (!options.quiet) request.say = [](const std::string& line) { note(line); };
  if (!options.quiet && ::isatty(STDERR_FILENO) == 1)
    request.progress = [](int done, int total) {
      std::fputs(fmt::format("\r\x1b[K{}", done < total ? fmt::format("[{}/{}] recordings", done, total) : "")
                     .c_str(),
                 stderr);
    };
  return importer.read(request);
}

// `importers`: for the names of those that take an option that this one does not.
void check_options(const ImportOptions& o, const ImporterEntry& importer,
                   const std::vector<ImporterEntry>& importers) {
  const auto only = [&](const char* option, bool ImporterEntry::*takes) {
    return std::invalid_argument(fmt::format("{} is of {} only", option, names_of(importers, ", ", takes)));
  };
  if (o.from.empty()) throw std::invalid_argument("--from is required");
  if (o.show) throw std::invalid_argument("--show is of logs only");
  if (!o.poses.empty()) throw std::invalid_argument("--poses is of logs only");
  if (o.propose && !importer.maps) throw only("--propose", &ImporterEntry::maps);
  if (!o.map.empty() && !importer.maps) throw only("--map", &ImporterEntry::maps);
  if (o.drop_lost && !importer.drops_lost) throw only("--drop-lost", &ImporterEntry::drops_lost);
  if (!o.exclude.empty() && !importer.excludes) throw only("--exclude", &ImporterEntry::excludes);
  if (o.propose) return;
  if (importer.maps && o.map.empty())
    throw std::invalid_argument(
        "import csv needs --map=MAP.JSON, which says what robot it is and what the columns are; "
        "`bench import csv --from=... --propose > map.json` makes one to fill in (docs/import.md)");
}

// What is printed leaves no files.
void check_printed(const ImportOptions& o) {
  const char* what = o.propose ? "--propose prints a map" : "--show prints tables";
  for (const auto& [given, option] : {std::pair{o.propose && o.show, "--show"},
                                      {!o.map.empty(), "--map"},
                                      {!o.poses.empty(), "--poses"},
                                      {!o.out.empty(), "--out"},
                                      {o.overwrite, "--overwrite"},
                                      {o.propose && o.json, "--json"}})
    if (given) throw std::invalid_argument(fmt::format("{}; leave out {}", what, option));
}

ExitCode propose(const ImportOptions& options) {
  const CsvProposal proposal = propose_csv_map(comma_items(options.from));
  if (!options.quiet)
    for (const std::string& reason : proposal.reasons) note(reason);
  print_text(safe_json(proposal.map));
  return ExitCode::Success;
}

ExitCode save(const Dataset& dataset, const ImportOptions& options, const SetSensors& sensors = {}) {
  if (!options.quiet)
    for (const std::string& text : dataset.notes) note(text);
  save_announced(dataset, options.out, options.overwrite, options.json, false, sensors);
  TerminalWatcher watcher(options.quiet);
  told_findings(inspect_recordings(dataset.robot, dataset.recordings), options.out, watcher);
  return ExitCode::Success;
}

LogOptions log_options(const ImportOptions& options) {
  LogOptions log = options.log;
  for (const std::string& file : options.messages) log.messages.emplace_back(file);
  return log;
}

ExitCode show(const ImportOptions& options) {
  std::vector<Table> tables;
  for (const std::string& log : options.what)
    for (Table& table : log_tables(log, log_options(options), InterruptGuard::stop()))
      tables.push_back(std::move(table));
  print_tables(tables, options.json ? Format::Json : Format::Console);
  return ExitCode::Success;
}

ExitCode propose_for_logs(const ImportOptions& options) {
  const LogProposal proposal = propose_log_map({options.what.begin(), options.what.end()},
                                               log_options(options), InterruptGuard::stop());
  if (!options.quiet)
    for (const std::string& reason : proposal.reasons) note(reason);
  print_text(safe_json(proposal.map));
  return ExitCode::Success;
}

ExitCode import_of_logs(const ImportOptions& options, const Catalogue& catalogue) {
  if (!options.from.empty())
    throw std::invalid_argument("--from is of " + names_of(catalogue.importers(), ", "));
  if (options.drop_lost || !options.exclude.empty())
    throw std::invalid_argument("--drop-lost and --exclude are not for logs");
  if (options.show) return show(options);
  if (options.propose) return propose_for_logs(options);
  if (options.map.empty())
    throw std::invalid_argument(
        "logs need --map=MAP.JSON, which says what robot it is and what their fields are; "
        "`bench import LOG... --propose > map.json` makes one to fill in (docs/import.md)");
  if (options.out.empty()) throw std::invalid_argument("--out is required");
  require_writable(options.out, existing_files(options.overwrite));
  TerminalWatcher watcher;
  const LogStudy study{{options.what.begin(), options.what.end()},
                       read_file(options.map),
                       options.map,
                       log_options(options),
                       options.poses};
  ImportedLogs imported = import_logs(study, watcher, InterruptGuard::stop());
  if (!options.quiet)
    for (const std::string& line : imported.report) note(line);
  return save(imported.dataset, options, imported.sensors);
}

bool names_importer(const ImportOptions& options, const Catalogue& catalogue) {
  const std::vector<ImporterEntry>& all = catalogue.importers();
  return options.what.size() == 1 &&
         (!options.from.empty() || std::any_of(all.begin(), all.end(), [&](const ImporterEntry& e) {
           return e.name == options.what.front();
         }));
}

ExitCode import_command(const ImportOptions& options, const Catalogue& catalogue) {
  if (options.propose || options.show) check_printed(options);
  if (!names_importer(options, catalogue)) return import_of_logs(options, catalogue);
  const ImporterEntry& importer = catalogue.importer(options.what.front());
  check_options(options, importer, catalogue.importers());
  if (options.propose) return propose(options);
  if (options.out.empty()) throw std::invalid_argument("--out is required");
  require_writable(options.out, existing_files(options.overwrite));
  return save(import_from(options, importer), options);
}

}  // namespace

VerbAction add_import(CLI::App& app) {
  return verb_action<ImportOptions>(app, add_options, import_command);
}

}  // namespace odobench
