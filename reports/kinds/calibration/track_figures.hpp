// Figures of driven paths, after the thesis' figures 34-69: per trajectory the path (y over x), x, y and
// heading over time, and the absolute errors over time, for every method and drive.
#pragma once

#include <string>

#include "reports/figures/document.hpp"
#include "reports/kinds/kind.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {

// Rows of the paths' data sets at most, and a third of those of the errors'; 35 and 20 bytes of the page
// each.
inline constexpr std::size_t kTrackRows = 40000;

// Appends to `section`: path.TRAJECTORY, pose.TRAJECTORY, error.TRAJECTORY for each, their data sets to
// `document`. Ids begin with `prefix`. Paths are thinned (reports/figures/decimate.hpp) to within 1/1200 of
// the range of the trajectory, less finely when there would be more than `rows` rows; errors to 1/300 or to
// the extremes of as many stretches as the rows allow; the captions say which. The largest error of every
// drive and variable is always among them.
void add_track_figures(const TrackSet& set, const std::string& prefix, Section& section, Document& document,
                       std::size_t rows = kTrackRows);
// The same in their place on the page.
void add_track_figures(const PlacedTracks& tracks, Section& section, Document& document);

}  // namespace odobench
