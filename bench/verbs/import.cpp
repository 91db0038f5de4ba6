#include "bench/verbs/import.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/table_output.hpp"
#include "bench/verbs/common_options.hpp"
#include "bench/verbs/written_files.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct ImportOptions {
  std::string source;  // name of the importer, "vitko2024"
  std::string from;
  std::string out;
  bool overwrite = false;
  bool drop_lost = false;  // captured samples whose tracking was lost
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, ImportOptions& o) {
  app.add_option("source", o.source, "vitko2024")->required();
  app.add_option("--from", o.from, "folder with the raw files")->required()->type_name("DIR");
  app.add_option("--out", o.out, "data set to write")->required()->type_name("SET.JSON");
  app.add_flag("--drop-lost", o.drop_lost,
               "leave out captured samples whose tracking was lost, and count them");
  app.add_flag("--overwrite", o.overwrite, "replace a data set that is there");
  app.add_flag("--quiet", o.quiet, "no progress");
  add_json(app, o.json);
}

ExitCode import_command(const ImportOptions& options) {
  if (options.source != "vitko2024") {
    throw std::invalid_argument(fmt::format("bench import '{}'{}: known sources: vitko2024", options.source,
                                            did_you_mean(options.source, {"vitko2024"})));
  }
  require_writable(options.out, existing_files(options.overwrite));
  const bool draw = !options.quiet && ::isatty(STDERR_FILENO) == 1;
  const auto progress = [draw](int done, int total) {
    if (draw)
      std::fputs(fmt::format("\r\x1b[K{}", done < total ? fmt::format("[{}/{}] recordings", done, total) : "")
                     .c_str(),
                 stderr);
  };
  const Dataset dataset = import_vitko2024(options.from, progress, 0, options.drop_lost);
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
