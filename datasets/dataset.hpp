// A data set: one robot, its trajectories and the recordings made of them, with where they came from.
// On disk it is a set.json (docs/data_format.md) that refers to recording files beside it or holds them
// inline.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.hpp"
#include "base/stop.hpp"
#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench {

struct Trajectory {
  std::string name;         // key that recordings refer to
  std::string description;  // one line for people
};

struct SourceFile {
  std::string path;    // as the source names it, relative
  std::string sha256;  // lower-case hex
};

struct Provenance {
  std::string source;   // who recorded it, where it was published
  std::string licence;  // "none stated", "MIT", ...
  std::string made_by;  // the command that made the set
  std::vector<SourceFile> files;
};

// A named parameter vector that the set's makers published or know to be true ("published:lm", "truth").
struct NamedParameters {
  std::string name;
  std::string description;
  std::vector<double> values;  // in the order of Robot::parameters
};

// What the references of all recordings are.
enum class ReferenceKind {
  Poses,     // where the robot was
  Drifting,  // another odometry: its errors grow with the way
  Headings  // theta alone was measured, by a gyro; x, y follow it and the wheels' nominal sizes, for pictures
};
inline constexpr std::array<std::string_view, 3> kReferenceKindNames = {"poses", "drifting", "headings"};
inline std::string_view name_of(ReferenceKind kind) {
  return kReferenceKindNames[static_cast<std::size_t>(kind)];
}

struct Dataset {
  std::string name;
  std::string description;
  Robot robot;
  std::vector<Trajectory> trajectories;  // in table order
  std::vector<Recording> recordings;
  ReferenceKind reference = ReferenceKind::Poses;
  std::vector<NamedParameters> known_parameters;
  Provenance provenance;
  // What the import repaired, counted: "3 stamps moved to 1 us after their predecessor in recording
  // line_x_2".
  std::vector<std::string> notes;
};

// Reads set.json and everything it refers to; checks schema version, sums, lengths, finiteness, strictly
// increasing stamps, known trajectory names, lower <= nominal <= upper. Throws DataError with file:line (or
// file and JSON path).
Dataset load_dataset(const std::filesystem::path& set_json);

// Writes set.json and, unless `inline_recordings`, one recording file each in the folder "<stem>_recordings"
// beside it. Everything is written to temporary names and renamed when complete. Returns what was written.
// Throws DataError when it cannot be, std::invalid_argument when a file is there that is to be kept.
std::vector<std::filesystem::path> save_dataset(const Dataset& dataset, const std::filesystem::path& set_json,
                                                bool inline_recordings = false,
                                                Existing existing = Existing::Replace);
// The same files as a part of something larger: added, set.json last, but not committed. Throws Interruption
// when a stop is asked for before the last recording.
void add_dataset(const Dataset& dataset, const std::filesystem::path& set_json, FileTransaction& files,
                 bool inline_recordings = false, const Stop& stop = {});

}  // namespace odobench
