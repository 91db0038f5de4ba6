#include "bench/studies/run_tracks.hpp"

#include <utility>

#include "datasets/native/columns.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

void append_track(const PoseTrack& track, PoseTrack& all) {
  all.x.insert(all.x.end(), track.x.begin(), track.x.end());
  all.y.insert(all.y.end(), track.y.begin(), track.y.end());
  all.theta.insert(all.theta.end(), track.theta.begin(), track.theta.end());
}

TrackSet reference_tracks(const std::string& problem, const LoadedProblem& loaded) {
  TrackSet set;
  set.problem = problem;
  set.dataset = loaded.dataset_name();
  set.dataset_sha256 = loaded.dataset_sha256;
  const auto add = [&](const Recording& r, bool left_out) {
    set.recordings.push_back({r.id, r.trajectory, r.repetition, set.time_s.size(), r.size(), left_out});
    for (const std::int64_t time : r.time_us) set.time_s.push_back(static_cast<double>(time) * 1e-6);
    const Reference reference = with_reference_everywhere(r).reference;
    append_track({reference.x, reference.y, reference.theta}, set.reference);
  };
  for (const Recording& r : loaded.calibration->recordings()) add(r, false);
  if (loaded.aside)
    for (const Recording& r : loaded.aside->recordings()) add(r, true);
  return set;
}

TrackSet run_tracks(const LoadedProblem& loaded, const std::vector<RunRecord>& records) {
  TrackSet set = reference_tracks(loaded.name(), loaded);
  for (const Comparison& comparison : compare(records)) {
    if (comparison.problem != loaded.name()) continue;
    for (const ComparisonRow& row : comparison.rows) {
      const RunRecord& shown = *row.shown;
      if (shown.parameters.size() != loaded.problem.parameters().size()) continue;
      Vector z(static_cast<Eigen::Index>(shown.parameters.size()));
      for (std::size_t i = 0; i < shown.parameters.size(); ++i)
        z[static_cast<Eigen::Index>(i)] = shown.parameters[i].value;
      StoredTrack track{row.label, shown.repetition, {}};
      for (std::size_t i = 0; i < loaded.calibration->recordings().size(); ++i)
        append_track(loaded.calibration->integrate(i, z), track.pose);
      if (loaded.aside)
        for (std::size_t i = 0; i < loaded.aside->recordings().size(); ++i)
          append_track(loaded.aside->integrate(i, z), track.pose);
      set.tracks.push_back(std::move(track));
    }
  }
  return set;
}

}  // namespace odobench
