// `bench report` and `bench export`: what people look at and other programs read, from stored records alone.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// The tables on standard output; with `out` one HTML page, with `figures` an SVG file per figure instead.
ExitCode report_command(const ReportOptions& options);

// Trajectories in the format of the TUM RGB-D benchmark: lines "time x y z qx qy qz qw", seconds and metres, z = 0, the
// heading as a unit quaternion about z; OUT/LABEL/RECORDING.tum, the motion capture as OUT/reference/RECORDING.tum.
ExitCode export_command(const ExportOptions& options);

}  // namespace odobench
