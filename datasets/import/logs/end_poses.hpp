// Where drives ended by tape measure: a small table, typed by hand, in the place of a reference.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/dataset.hpp"

namespace odobench::log_import {

// One row: the pose at the end of a drive in the frame of its start.
struct EndPose {
  std::string drive;               // id of a recording, or name of its log with or without extension
  double x = 0, y = 0, theta = 0;  // m, rad
  std::size_t line = 0;
};

// Columns drive, x, y, theta (or yaw, heading) in any order, units by the header ("x [mm]", "theta_deg"; m
// and rad without); others are ignored. Throws DataError "file:line: ..." for columns that are missing or in
// units of something else, for cells that are no numbers, a drive that is there twice, no row at all.
std::vector<EndPose> parse_end_poses(std::string_view text, const std::string& file);

// Puts the poses at the ends of the recordings, and leaves out those without one, with a note that counts
// them. `logs`: the logs of each recording. Throws DataError with the line for a pose whose drive is not
// there (with the nearest name) and for a log that has several drives.
void join_end_poses(const std::vector<EndPose>& poses, const std::string& file,
                    const std::vector<std::vector<std::filesystem::path>>& logs, Dataset& set);

}  // namespace odobench::log_import
