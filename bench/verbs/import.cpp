#include "bench/verbs/import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/table_output.hpp"
#include "bench/verbs/common_options.hpp"
#include "bench/verbs/written_files.hpp"
#include "datasets/import/csv/csv_import.hpp"
#include "datasets/import/csv/csv_proposal.hpp"
#include "datasets/import/optiodom/optiodom.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct ImportOptions {
  std::string source;  // name of the importer, "csv", "vitko2024", "optiodom"
  std::string from;
  std::string out;
  std::string map;       // of csv: what the columns are
  bool propose = false;  // of csv: print such a map
  bool overwrite = false;
  std::string exclude;     // numbers of runs, separated by commas
  bool drop_lost = false;  // captured samples whose tracking was lost
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, ImportOptions& o) {
  app.add_option("source", o.source, "csv (files of your own), vitko2024 or optiodom")->required();
  app.add_option("--from", o.from,
                 "folder with the raw files; of optiodom one or several, of csv files, folders and patterns, "
                 "separated by commas")
      ->required()
      ->type_name("PLACE,...");
  app.add_option("--out", o.out, "data set to write; not with --propose")->type_name("SET.JSON");
  app.add_option("--map", o.map, "csv: robot, columns and units (docs/import.md)")->type_name("MAP.JSON");
  app.add_flag("--propose", o.propose,
               "csv: print a map for these files, with null for what they do not say");
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

Dataset import_own(const ImportOptions& options) {
  CsvImport imported = import_csv(comma_items(options.from), options.map);
  if (!options.quiet)
    for (const std::string& line : imported.report) note(line);
  return std::move(imported.dataset);
}

Dataset import_from(const ImportOptions& options) {
  if (options.source == "csv") return import_own(options);
  if (options.source == "optiodom") {
    if (options.drop_lost) throw std::invalid_argument("--drop-lost is of vitko2024 only");
    std::vector<std::filesystem::path> folders;
    for (const std::string& item : comma_items(options.from)) folders.emplace_back(item);
    return import_optiodom(folders, {run_numbers(options.exclude)});
  }
  if (!options.exclude.empty()) throw std::invalid_argument("--exclude is of optiodom only");
  const bool draw = !options.quiet && ::isatty(STDERR_FILENO) == 1;
  const auto progress = [draw](int done, int total) {
    if (draw)
      std::fputs(fmt::format("\r\x1b[K{}", done < total ? fmt::format("[{}/{}] recordings", done, total) : "")
                     .c_str(),
                 stderr);
  };
  return import_vitko2024(options.from, progress, 0, options.drop_lost);
}

void check_options(const ImportOptions& o) {
  const std::vector<std::string> sources = {"csv", "vitko2024", "optiodom"};
  if (std::find(sources.begin(), sources.end(), o.source) == sources.end())
    throw std::invalid_argument(fmt::format("bench import '{}'{}: known sources: {}", o.source,
                                            did_you_mean(o.source, sources), fmt::join(sources, ", ")));
  const bool own = o.source == "csv";
  if (!own && o.propose) throw std::invalid_argument("--propose is of csv only");
  if (!own && !o.map.empty()) throw std::invalid_argument("--map is of csv only");
  if (own && o.drop_lost) throw std::invalid_argument("--drop-lost is of vitko2024 only");
  if (own && !o.exclude.empty()) throw std::invalid_argument("--exclude is of optiodom only");
  if (o.propose) {
    for (const auto& [given, option] : {std::pair{!o.map.empty(), "--map"},
                                        {!o.out.empty(), "--out"},
                                        {o.overwrite, "--overwrite"},
                                        {o.json, "--json"}})
      if (given) throw std::invalid_argument(fmt::format("--propose prints a map; leave out {}", option));
    return;
  }
  if (own && o.map.empty())
    throw std::invalid_argument(
        "import csv needs --map=MAP.JSON, which says what robot it is and what the columns are; "
        "`bench import csv --from=... --propose > map.json` makes one to fill in (docs/import.md)");
  if (o.out.empty()) throw std::invalid_argument("--out is required");
}

ExitCode propose(const ImportOptions& options) {
  const CsvProposal proposal = propose_csv_map(comma_items(options.from));
  if (!options.quiet)
    for (const std::string& reason : proposal.reasons) note(reason);
  print_text(safe_json(proposal.map));
  return ExitCode::Success;
}

ExitCode import_command(const ImportOptions& options) {
  check_options(options);
  if (options.propose) return propose(options);
  require_writable(options.out, existing_files(options.overwrite));
  const Dataset dataset = import_from(options);
  if (!options.quiet)
    for (const std::string& text : dataset.notes) note(text);
  save_announced(dataset, options.out, options.overwrite, options.json);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_import(CLI::App& app) {
  return verb_action<ImportOptions>(app, add_options, import_command);
}

}  // namespace odobench
