#include "bench/studies/report_study.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "bench/studies/records.hpp"
#include "reports/kinds/kinds.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {
namespace fs = std::filesystem;

ReportInput report_input(const std::vector<std::string>& runs, const std::vector<RunRecord>& records,
                         const std::string& title) {
  ReportInput input;
  input.records = records;
  input.title = title;
  input.notes = notes_of_best(records);
  for (const std::string& run : runs) {
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
  input.absent = unknown_records(records);
  bool drives = false;
  for (const RunRecord& r : records) drives = drives || !r.errors.empty();
  if (drives && input.tracks.empty())
    input.absent.push_back(
        "The run directory holds no tracks, so there are no figures of the driven paths: they are stored "
        "when a run with "
        "--out ends.");
  return input;
}

}  // namespace odobench
