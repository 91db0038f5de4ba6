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
#include "bench/studies/exporting/robot_export.hpp"
#include "reports/figures/vega.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {
namespace {

struct ExportOptions {
  std::string run;  // folder
  bool tum = false;
  bool csv = false;
  RobotExport robot;  // its target empty: tracks
  std::string out;    // folder of tracks, file of parameters
  bool overwrite = false;
  bool json = false;
};

constexpr const char* kExportExamples = R"(Examples:
  bench export results --to=ros2 --row=lm --out=controller.yaml
  bench export results --to=urdf
  bench export results --tum --out=tum
docs/export.md has a table for each class of robots: controller, keys, what is lost.)";

void add_options(CLI::App& app, ExportOptions& o) {
  app.add_option("run", o.run, "folder of a run with --out")->required();
  app.add_option(
         "--to", o.robot.target,
         "the calibrated parameters as: ros2 (YAML of the class' controller), urdf, yaml (every number), "
         "json, c (a header), wpilib (Java)")
      ->type_name("TARGET");
  app.add_flag("--tum", o.tum,
               "trajectories in the TUM format that evo and others read: time x y z qx qy qz qw");
  app.add_flag("--csv", o.csv, "trajectories as CSV: time_s,x,y,theta");
  app.add_option("--row", o.robot.row, "of --to: whose parameters [the row with the lowest J]")
      ->type_name("LABEL");
  app.add_option("--node", o.robot.node,
                 "of --to: the node's name; of c the names' prefix [the controller's]")
      ->type_name("NAME");
  app.add_flag("--absolute", o.robot.absolute,
               "of --to=ros2: a differential robot's calibrated lengths instead of multipliers");
  app.add_option(
         "--out", o.out,
         "of --to: file to write, - is standard output [-]; else the folder for LABEL/RECORDING.tum or "
         ".csv, reference/RECORDING.tum or .csv")
      ->type_name("PLACE");
  app.add_flag("--overwrite", o.overwrite, "replace files that are there");
  add_json(app, o.json);
  app.footer(kExportExamples);
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

std::string csv_text(const TrackSet& set, const TrackRecording& recording, const PoseTrack& pose) {
  std::string text = "time_s,x,y,theta\n";
  for (std::size_t k = recording.begin; k < recording.begin + recording.samples; ++k)
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", set.time_s[k], pose.x[k], pose.y[k],
                   pose.theta[k]);
  return text;
}

ExitCode export_tracks(const ExportOptions& options) {
  if (options.out.empty()) throw std::invalid_argument("--out is required");
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
      written.push_back(out / folder / (vega::slug(r.id) + (options.csv ? ".csv" : ".tum")));
      transaction.add(written.back(), options.csv ? csv_text(*set, r, pose) : tum_text(*set, r, pose));
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

ExitCode export_parameters(const ExportOptions& options) {
  const std::string out = options.out.empty() ? "-" : options.out;
  if (options.json && out == "-")
    throw std::invalid_argument("--json says which file was written: give --out=FILE");
  refuse_existing("--out", out, options.overwrite);
  RobotExport study = options.robot;
  study.run = options.run;
  const ExportedRobot exported = export_robot(study);
  InterruptGuard::remember();
  write_result(out, exported.text, existing_files(options.overwrite));
  note(fmt::format("parameters of row '{}'{}", exported.row, out == "-" ? "" : " -> " + out));
  for (const std::string& text : exported.warnings) warn(text);
  if (options.json) print_tables({written_table({out})}, Format::Json);
  return ExitCode::Success;
}

ExitCode export_command(const ExportOptions& options) {
  const RobotExport& robot = options.robot;
  const int formats = (options.tum ? 1 : 0) + (options.csv ? 1 : 0) + (robot.target.empty() ? 0 : 1);
  if (formats != 1)
    throw std::invalid_argument(
        "export: say in which format, one of --to=TARGET (parameters), --tum and --csv (trajectories)");
  if (!robot.target.empty()) return export_parameters(options);
  if (!robot.row.empty() || !robot.node.empty() || robot.absolute)
    throw std::invalid_argument("--row, --node and --absolute are of --to");
  return export_tracks(options);
}

}  // namespace

VerbAction add_export(CLI::App& app) {
  return verb_action<ExportOptions>(app, add_options, export_command);
}

}  // namespace odobench
