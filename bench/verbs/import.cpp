#include "bench/verbs/import.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/table_output.hpp"
#include "bench/verbs/common_options.hpp"
#include "bench/verbs/written_files.hpp"
#include "datasets/import/optiodom/optiodom.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct ImportOptions {
  std::string source;  // name of the importer, "vitko2024", "optiodom"
  std::string from;
  std::string out;
  bool overwrite = false;
  std::string exclude;     // numbers of runs, separated by commas
  bool drop_lost = false;  // captured samples whose tracking was lost
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, ImportOptions& o) {
  app.add_option("source", o.source, "vitko2024 or optiodom")->required();
  app.add_option("--from", o.from,
                 "folder with the raw files; of optiodom one or several, separated by commas")
      ->required()
      ->type_name("DIR");
  app.add_option("--out", o.out, "data set to write")->required()->type_name("SET.JSON");
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

Dataset import_from(const ImportOptions& options) {
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

ExitCode import_command(const ImportOptions& options) {
  if (options.source != "vitko2024" && options.source != "optiodom")
    throw std::invalid_argument(fmt::format("bench import '{}'{}: known sources: vitko2024, optiodom",
                                            options.source,
                                            did_you_mean(options.source, {"vitko2024", "optiodom"})));
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
