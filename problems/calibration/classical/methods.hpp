// The methods behind the table of classical.hpp: each takes drives that the reasons below have let pass.
#pragma once

#include "problems/calibration/classical/drives.hpp"

namespace odobench::classical {

// Why drives are not what a method needs, "" where they are.
std::string why_no_squares(const Drives& drives);
std::string why_no_circles(const Drives& drives);
std::string why_no_lines_and_turns(const Drives& drives);
std::string why_no_pieces(const Drives& drives);   // at least two sample rows
std::string why_no_turning(const Drives& drives);  // and the heading changes

Result umbmark_x(const Drives& drives);
Result umbmark_y(const Drives& drives);
Result jung_chung(const Drives& drives);
Result jung_chung_of_optiodom(const Drives& drives);
Result circles(const Drives& drives);
Result ivanjko(const Drives& drives);
Result kallasi(const Drives& drives);
Result lin(const Drives& drives);
Result antonelli(const Drives& drives);
Result censi(const Drives& drives);
Result censi_with_mount(const Drives& drives);

}  // namespace odobench::classical
