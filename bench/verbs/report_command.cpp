#include "bench/verbs/report_command.hpp"

#include <fmt/format.h>

#include <algorithm>
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
#include "bench/studies/figure_files.hpp"
#include "bench/studies/records.hpp"
#include "bench/verbs/check_command.hpp"
#include "bench/verbs/written_files.hpp"
#include "reports/figures/vega.hpp"
#include "reports/page/report_document.hpp"
#include "reports/page/web_assets.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

ReportInput report_input(const ReportOptions& options, const std::vector<RunRecord>& records) {
  ReportInput input;
  input.records = records;
  input.title = options.title;
  input.notes = notes_of_best(records);
  for (const std::string& run : options.runs) {
    const fs::path folder = fs::is_directory(run) ? fs::path(run) : fs::path(run).parent_path();
    std::optional<TrackSet> tracks = read_tracks(folder);
    // A .jsonl file may lie beside the tracks of another run.
    const auto belongs = [&](const RunRecord& r) {
      return r.problem == tracks->problem && r.dataset == tracks->dataset &&
             r.dataset_sha256 == tracks->dataset_sha256;
    };
    if (tracks && std::any_of(records.begin(), records.end(), belongs))
      input.tracks.push_back(std::move(*tracks));
  }
  bool drives = false;
  for (const RunRecord& r : records) drives = drives || !r.errors.empty();
  if (drives && input.tracks.empty())
    input.absent.push_back(
        "The run directory holds no tracks, so there are no figures of the driven paths: they are stored "
        "when a run with "
        "--out ends.");
  return input;
}

// A name that is no other label's: "pso[swarm=60]" -> "pso-swarm-60-".
std::string folder_name(const std::string& label, std::set<std::string>& taken) {
  const std::string base = vega::slug(label);
  std::string name = base;
  for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
  return name;
}

std::string tum_text(const TrackSet& set, const TrackRecording& recording, const PoseColumns& pose) {
  std::string text;
  for (std::size_t k = recording.begin; k < recording.begin + recording.samples; ++k)
    fmt::format_to(std::back_inserter(text), "{} {} {} 0 0 0 {} {}\n", set.time_s[k], pose.x[k], pose.y[k],
                   std::sin(pose.theta[k] / 2), std::cos(pose.theta[k] / 2));
  return text;
}

}  // namespace

ExitCode report_command(const ReportOptions& options) {
  const Format format = parse_format(options.format);
  const std::vector<RunRecord> records = read_all_records(options.runs);
  if (options.out.empty() && options.figures.empty()) {
    print_tables(
        record_tables(records, notes_of_best(records), format == Format::Json || format == Format::Csv),
        format);
    return ExitCode::Success;
  }
  const Existing existing = existing_files(options.overwrite);
  refuse_existing("--out", options.out, options.overwrite);
  if (options.out == "-" && format == Format::Json)
    throw std::invalid_argument("--out=-: standard output takes the page, not JSON as well");
  const Document document = make_report(report_input(options, records));
  std::vector<fs::path> written, drawn;
  // First, since it can still be interrupted.
  if (!options.figures.empty()) drawn = write_figures(document, options.figures, existing);
  if (!options.out.empty()) {
    const std::string page = render_html(document);
    InterruptGuard::remember();
    write_result(options.out, page, existing);
    if (options.out != "-") written.emplace_back(options.out);
    note(has_chart_library()
             ? fmt::format("{}: {} figures, {} sections", options.out, figures(document).size(),
                           document.sections.size())
             : fmt::format("{}: tables without charts, since {}", options.out, why_no_charts()));
  }
  if (!options.figures.empty()) {
    written.insert(written.end(), drawn.begin(), drawn.end());
    note(fmt::format("{}: {} figures", options.figures, figures(document).size()));
  }
  if (format == Format::Json) print_tables({written_table(written)}, format);
  return ExitCode::Success;
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
  const auto add = [&](const std::string& label, const PoseColumns& pose) {
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

}  // namespace odobench
