// The tracks of results, kept in a run directory beside the records (reports/records/tracks.hpp).
#pragma once

#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "reports/records/record.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {

// Recordings, those last that were left out, times and reference; no tracks yet.
TrackSet reference_tracks(const std::string& problem, const LoadedProblem& loaded);

void append_track(const PoseTrack& track, PoseTrack& all);

// The track of the run that the tables show of each label (the median by J), integrated from its parameters.
// `loaded`: a calibration; records of other problems have none.
TrackSet run_tracks(const LoadedProblem& loaded, const std::vector<RunRecord>& records);

}  // namespace odobench
