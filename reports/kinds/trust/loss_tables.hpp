// Tables of calibrations with a robust loss, and of recordings that were left out of one.
//
// A record of a robust loss has the measures loss.position_scale (m), loss.heading_scale (rad) or
// loss.recording_scale, and the series below. A record of a calibration that left recordings out has for each
// of them, `of` its name, set_aside.NAME.z (how many times the usual it differs from its siblings),
// set_aside.NAME.x, .y (m), .heading (rad): the largest errors of the record's parameters on it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// One value per row of the table: which of RunRecord::errors, its ratio of RMS to the median, the weight,
// first and last sample (null: the whole recording).
inline constexpr std::array<const char*, 5> kWeightedDownSeries{"weighted_down.recording",
                                                                "weighted_down.ratio", "weighted_down.weight",
                                                                "weighted_down.first", "weighted_down.last"};

// "weighted_down": what the row with the lowest J counts for less. Nothing without the series.
std::optional<Table> weighted_down_table(const Comparison& comparison);

// "set_aside": a row per recording and label, with the largest errors there. Nothing where nothing was left
// out.
std::optional<Table> set_aside_table(const Comparison& comparison);

// The name of a measure of a recording that was left out: "set_aside.line_y_2.z".
std::string set_aside_measure(const std::string& recording, const char* what);

}  // namespace odobench
