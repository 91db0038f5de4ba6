// How far odometry is from the reference in the plane, drive by drive: the four figures of Sousa et al.
// (OptiOdom, 2022), and the end errors of UMBmark. Of records with the series below, which calibrations
// have but those of the thesis' robot with the thesis' cost.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// One value per drive, in the order of RunRecord::errors (problems/calibration/drive_errors.hpp): the largest
// distance in position (m) and heading (rad), those at the end; end error x, y, reference minus odometry in
// the frame of the start (m); 1 where odometry by nominal values turns counter-clockwise, -1 clockwise,
// else 0.
inline constexpr std::array<const char*, 7> kDriveSeries{
    "drive.max_position", "drive.max_heading", "drive.end_position", "drive.end_heading",
    "drive.end_x",        "drive.end_y",       "drive.sense"};

// Of more drives times rows than this only the maxima over the drives are a table.
inline constexpr std::size_t kMostDriveRows = 300;

// In this order, nothing without the series:
//   maxima  the four figures, their maxima over the drives, a row per label
//   drives  the same of each drive and label
//   ends    centres of the end errors (mean x, y) of the drives in each sense, their distances from 0, the
//           larger one E_max,syst, and the standard deviation about the centre; where there are both senses
std::vector<Table> drive_tables(const Comparison& comparison);

// End errors y over x of every drive that turns, with the centre of each sense, a colour per label. Nothing
// where there is no table of ends.
void add_end_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                    Document& document);

}  // namespace odobench
