#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <stdexcept>

#include "base/error.hpp"
#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/records.hpp"
#include "reports/figures/vega.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {
namespace {

struct ExportOptions {
  std::string run;  // folder
  bool tum = false;
  std::string out;  // folder
  bool overwrite = false;
  bool json = false;
};

void add_options(CLI::App& app, ExportOptions& o) {
  app.add_option("run", o.run, "folder of a run with --out")->required();
  app.add_flag("--tum", o.tum, "the TUM format that evo and others read: time x y z qx qy qz qw");
  app.add_option("--out", o.out, "folder to write: LABEL/RECORDING.tum, reference/RECORDING.tum")
      ->required()
      ->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace files that are there");
  add_json(app, o.json);
}

namespace fs = std::filesystem;

std::string folder_name(const std::string& label, std::set<std::string>& taken) {
  const std::string base = vega::slug(label);
  std::string name = base;
  for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
  return name;
}

std::string tum_text(const TrackSet& set, const TrackRecording& recording, const PoseTrack& pose) {
  std::string text;
  for (std::size_t k = recording.begin; k < recording.begin + recording.samples; ++k)
    fmt::format_to(std::back_inserter(text), "{} {} {} 0 0 0 {} {}\n", set.time_s[k], pose.x[k], pose.y[k],
                   std::sin(pose.theta[k] / 2), std::cos(pose.theta[k] / 2));
  return text;
}

ExitCode export_command(const ExportOptions& options) {
  if (!options.tum) throw std::invalid_argument("export: say in which format; --tum is the one there is");
  const std::optional<TrackSet> set = read_tracks(options.run);
  if (!set)
    throw DataError(fmt::format(
        "{}: no tracks/tracks.json; runs of 'bench run', 'evaluate' and 'fuse' with --out have one",
        options.run));
  const fs::path out = options.out;
  refuse_existing_folder("--out", options.out, options.overwrite);
  InterruptGuard::remember();
  FileTransaction transaction(existing_files(options.overwrite));
  std::vector<fs::path> written;
  std::set<std::string> taken;
  const auto add = [&](const std::string& label, const PoseTrack& pose) {
    const std::string folder = folder_name(label, taken);
    require_own_folder(out / folder);
    for (const TrackRecording& r : set->recordings) {
      InterruptGuard::stop().check();
      written.push_back(out / folder / (vega::slug(r.id) + ".tum"));
      transaction.add(written.back(), tum_text(*set, r, pose));
    }
  };
  add("reference", set->reference);
  for (const StoredTrack& track : set->tracks) add(track.label, track.pose);
  transaction.commit();
  note(fmt::format("{}: {} trajectories of {} recordings", options.out, set->tracks.size() + 1,
                   set->recordings.size()));
  if (options.json) print_tables({written_table(written)}, Format::Json);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_export(CLI::App& app) {
  return verb_action<ExportOptions>(app, add_options, export_command);
}

}  // namespace odobench
