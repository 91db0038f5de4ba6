// How well a calibration fits: root mean squares of the errors, drive by drive and over all.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// One value per drive, in the order of RunRecord::errors: root mean squares of position error (m) and heading
// error (rad) over the samples with a reference but the first, the largest position error (m), and how many
// these samples are. Records of earlier versions lack them.
inline constexpr std::array<const char*, 4> kFitSeries{"fit.rms_position", "fit.rms_heading",
                                                       "fit.max_position", "fit.samples"};

struct DriveFit {
  std::string recording;
  double rms_position = 0, rms_heading = 0, max_position = 0;  // m, rad, m
  double samples = 0;
};
// Of a record with these series, in the order of its errors; else nothing.
std::vector<DriveFit> drive_fits(const RunRecord& record);
// All samples together: sqrt(sum n rms^2 / sum n), the largest of the largest.
DriveFit overall_fit(const std::vector<DriveFit>& fits);

double in_millimetres(double metres);
double in_degrees(double radians);

// "fit": a row per drive (none where there are more than kMostDriveRows), the last for all together, of the
// row with the lowest J; differences to nominal in brackets. Nothing without the series.
std::optional<Table> fit_table(const Comparison& comparison);

}  // namespace odobench
