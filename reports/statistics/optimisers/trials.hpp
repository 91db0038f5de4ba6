// Runs of several solvers on several problems, as what statistics of optimisers are made of: how many
// evaluations a run needed to come how near to the lowest known cost.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

// One run. Its gap after e evaluations is (J - J*) / unit:
//   J*    the lowest known cost of the problem (RunRecord::known), else the lowest of all its runs here
//   unit  1 for bbob: problems, so that targets are COCO's; J_0 - J* for others (1 where that is not
//         positive), J_0 the median over their runs of the first cost in the trace: a gap of 0.1 is the
//         tau = 0.1 of More and Wild
// From traces, which keep at most 400 improvements of a run: beyond that a gap may be noticed one kept
// improvement late.
struct Trial {
  std::vector<std::pair<double, double>> steps;  // evaluations, gap: both strictly monotone
  double spent = 0;                              // evaluations in all
  int repetition = 1;
  std::string problem;  // with its instance

  // Evaluations until the gap is at most `precision`; none if it never is.
  std::optional<double> evaluations_to(double precision) const;
};

// The trials of a problem; instances of one problem are one: "bbob:f1" of bbob:f1[instance=1..15].
struct ProblemTrials {
  std::string problem;    // and the data set, "calibration, demo"
  bool absolute = false;  // gaps in units of the cost
  std::size_t dimension = 0;
  std::vector<std::vector<Trial>> of;  // per solver; empty: it did not run here
};

struct TrialTable {
  std::vector<std::string> solvers;  // labels, in order of first appearance
  std::vector<ProblemTrials> problems;
};

// Of the records that are runs with a trace; problems that only one solver ran on count for nothing and
// are left out.
TrialTable trial_table(const std::vector<RunRecord>& records);

// "bbob:f1[n=5]" of "bbob:f1[n=5,instance=3]".
std::string without_instance(const std::string& problem);

}  // namespace odobench
