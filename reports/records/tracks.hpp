// Where the robot was and where each result says it was, kept beside the records so that figures need no data
// set.
//
// A folder `tracks` with arrays in NumPy's format 1.0 (.npy; float64, little-endian, C order) and an index:
//   tracks.json     {"schema_version": 1, "problem", "dataset", "dataset_sha256",
//                    "recordings": [{"id", "trajectory", "repetition", "samples", "left_out"}, ..],
//                                  left_out where it is true,
//                    "time": "time.npy", "reference": "reference.npy",
//                    "tracks": [{"label", "repetition", "file"}, ..]}
//   time.npy        (N): s, from 0 in every recording; N samples of all recordings, one recording after the
//                   other
//   reference.npy   (N, 3): x, y [m], theta [rad] by motion capture
//   1.npy, 2.npy .. (N, 3): the same by a result
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/pose.hpp"

namespace odobench {

inline constexpr int kTracksSchemaVersion = 1;

struct TrackRecording {
  std::string id, trajectory;
  int repetition = 0;
  std::size_t begin = 0, samples = 0;  // place in the arrays
  bool left_out = false;               // of the calibration, since it differs from its siblings
};

struct StoredTrack {
  std::string label;
  int repetition = 1;  // of the run
  PoseTrack pose;
};

struct TrackSet {
  std::string problem, dataset, dataset_sha256;
  std::vector<TrackRecording> recordings;
  std::vector<double> time_s;
  PoseTrack reference;
  std::vector<StoredTrack> tracks;
};

// Name and bytes of every file, the index last: who sees it may rely on the others. Throws
// std::invalid_argument when lengths differ.
std::vector<std::pair<std::filesystem::path, std::string>> track_files(const TrackSet& set);

// Of a run directory; none when it has no tracks/tracks.json. DataError "file: what was found,
// what was expected".
std::optional<TrackSet> read_tracks(const std::filesystem::path& run_directory);

}  // namespace odobench
