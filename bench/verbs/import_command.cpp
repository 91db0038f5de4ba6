#include "bench/verbs/import_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/verbs/written_files.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

void save(const Dataset& dataset, const std::filesystem::path& set, bool overwrite, bool json) {
  InterruptGuard::remember();
  FileTransaction transaction(existing_files(overwrite));
  add_dataset(dataset, set, transaction, false, InterruptGuard::stop());
  const std::vector<std::filesystem::path> files = transaction.targets();
  transaction.commit();
  std::size_t samples = 0;
  for (const Recording& r : dataset.recordings) samples += r.size();
  note(fmt::format("{}: {} recordings, {} samples", set.string(), dataset.recordings.size(), samples));
  if (json) print_tables({dataset_table(dataset), written_table(files)}, Format::Json);
}

}  // namespace

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
  save(dataset, options.out, options.overwrite, options.json);
  return ExitCode::Success;
}

ExitCode demo_command(const DemoOptions& options) {
  const std::filesystem::path set = std::filesystem::path(options.out) / "set.json";
  require_writable(set, existing_files(options.overwrite));
  save(make_demo_dataset(options.seed.value_or(kDemoSeed)), set, options.overwrite, options.json);
  return ExitCode::Success;
}

}  // namespace odobench
