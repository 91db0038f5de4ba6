// `bench verify`: parameter sets judged on drives that they were not fitted to. The robot of a scenario is
// driven anew, closed loop, by each set as what it believes about itself.
//
// Tables per trajectory (e_max, e_sr, sigma of odometry against motion capture, as the thesis' tables 9 to
// 41), totals (table 42), and where the robot really ended; means over the repeats with half the width of
// their 95 % interval. All sets meet the same noise. "nominal" is always among them, as the reference of
// differences. Throws std::invalid_argument on unknown names, scenarios without a closed loop, sets called
// the same; DataError on bad files and on sets by which the robot cannot drive.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_verify(CLI::App& app);

}  // namespace odobench
