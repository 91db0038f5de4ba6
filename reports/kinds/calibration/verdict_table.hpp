// What a calibration comes to, in sentences: the first thing on terminal and page.
//
// A row per clause: what it is about ("use", "unseen_kinds", "determined", "kinds", "explains", "bounds",
// "twice_box", "single", "set_aside", "next"), the sentence, and where it has one the figure behind it with
// its unit:
//   use           change of the total error to nominal, in %; against: the same held out
//   unseen_kinds  total error on kinds of drive left out; against: that of the nominal parameters
//   determined    what the drives determine, with 95 % half widths; its figures are the table `determined`
//   bounds        parameters on bounds; against: all that are free
//   explains, twice_box, single, next: see reports/kinds/trust/next_steps_tables.hpp
//   set_aside     recordings left out; against: all
//   kinds         F of errors that repeat within kinds; against: its p
#pragma once

#include <optional>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// "verdict": of the run with the lowest J, where the nominal parameters are there to compare with. Nothing
// without such a run, and nothing for problems without error tables.
std::optional<Table> verdict_table(const Comparison& comparison);

}  // namespace odobench
