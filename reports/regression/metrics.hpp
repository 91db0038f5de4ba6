// The figures of a table row that two sets of runs are compared by, one value per run.
#pragma once

#include <string>
#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// Names, in this order:
//   J                                       cost
//   total, total_x, total_y, total_theta    table 42: sums of e_sr over the trajectories [m], [rad], total
//   mixed
//   e_sr.TRAJECTORY.x, .y, .theta           mean over the repetitions of the largest error [m], [rad]
//   evaluations, iterations, seconds        effort; only of runs, not of given parameters
//   every measure of the records            alphabetical; unit, direction and timing are its own
// A run without the figure that other runs of the row have (it failed) counts as worst: +infinity, -infinity
// where higher is better. Not-a-number of a run counts the same. Where nothing says which way is better, it
// stays not-a-number.
struct Metric {
  std::string name;
  std::string
      family;  // what a list of metrics may call it by as well: "e_sr", "statistics" (measures); else the name
  std::string unit;
  Better better = Better::Lower;
  bool effort = false;         // what a budget limits: evaluations, iterations, seconds
  bool timing = false;         // depends on the machine and its load
  std::vector<double> values;  // one per run, in the order of the row
};

// Every metric that at least one run of the row has; none for a skipped row.
std::vector<Metric> metrics_of(const ComparisonRow& row);

const Metric* find_metric(const std::vector<Metric>& metrics, const std::string& name);

}  // namespace odobench
