// A data set of two short drives whose values a careless format would lose.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "base/sha256.hpp"
#include "datasets/dataset.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench::testing {

// Values whose last bits a careless format would lose.
inline Recording awkward_recording(const std::string& trajectory, int repetition, std::size_t samples) {
  Recording r = recording_4wis4wid();
  r.id = trajectory + "_" + std::to_string(repetition);
  r.trajectory = trajectory;
  r.repetition = repetition;
  const double values[] = {0.1, -0.0, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 2.2250738585072014e-308,
                           3,   1e22};
  std::size_t next = static_cast<std::size_t>(repetition);
  for (std::size_t k = 0; k < samples; ++k)
    r.time_us.push_back(static_cast<std::int64_t>(k * k) * 9'007'199'254'740'993);
  for_each_value_column(r, 1, [&](const std::string&, const char*, std::vector<double>& column) {
    for (std::size_t k = 0; k < samples; ++k) column.push_back(values[next++ % 8]);
  });
  return r;
}

inline Dataset small_dataset() {
  Dataset d;
  d.name = "small";
  d.description = "two \"quoted\" drives, \u010d";
  d.robot = robot_4wis4wid();
  d.trajectories = {{"ahead", "ahead"}, {"back", ""}};
  d.recordings = {awkward_recording("ahead", 1, 5), awkward_recording("back", 2, 2)};
  d.known_parameters = {{"truth", "known", std::vector<double>(12, 1.0 / 3.0)}};
  d.provenance = {"somewhere", "MIT", "by hand", {{"raw.csv", sha256("raw")}}};
  d.notes = {"1 stamp moved"};
  return d;
}

// Names of all files and folders below a folder, sorted.
inline std::vector<std::string> everything_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace odobench::testing
