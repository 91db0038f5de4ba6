// Real recordings with what happens to recordings: the fixed corruptions that reference results are for, and
// random ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace odobench::testing {

// Into the published recordings: "clean", "swap", "slip", "outliers", "frozen", "swap+slip", "all".
//   swap      circle_ccw_3: modules 1 and 4 exchanged, steering and speed
//   slip      line_x_2: wheel_speed_1 times 2.5 from 40 to 41 s
//   outliers  line_y_3: samples 200 + 230 j, j = 0 .. 19, are displaced by 1 m in direction 2.4 j rad
//   frozen    circle_cw_2: the pose of the last sample before holds from 30 to 32 s
// Throws std::invalid_argument for another name.
void corrupt(std::vector<Recording>& recordings, const std::string& corruption);

// Whether one of the four touches this recording.
bool touched_by_corruptions(const std::string& recording);

// Two of the recordings, drawn by the seed, each with one of
//   "slip"     a wheel, drawn, 2.5 times as fast for 2 s
//   "swap"     two modules, drawn, exchanged
//   "outlier"  1 % of the samples displaced by 0.2 to 1 m, headings by normal errors of 0.5 rad
//   "pose"     the pose displaced by 0.3 m and 0.3 rad for 3 s
//   "mix"      one of these each, drawn
// Times are drawn where the robot moves: from 0.25 to 0.75 of a recording. Gives what was done to whom.
struct Damage {
  std::size_t recording = 0;
  std::string kind;  // "slip", "swap", "outlier", "pose"
  std::string text;  // "wheel 3 times 2.5 from 44.1 s for 2 s"
};
std::vector<Damage> damage_two(std::vector<Recording>& recordings, const std::string& kind,
                               std::uint64_t seed);

}  // namespace odobench::testing
