// How far calibrations can be trusted (RunRecord::trust), as tables:
//   determined  what the drives determine: words, nominal value, estimate, +- for new kinds of drive, +-
//   for the
//               same drives again, degrees of freedom; the reason where there is no interval
//   intervals   of single parameters, or that the box decides
//   new_drives  half widths of errors on drives that are yet to be made: 10 m, a turn, each kind of the set
// One group of rows per label, of its best run by J. Empty where no record says anything.
#pragma once

#include <string>
#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// A unit of records ("rad/m", "m/rad", ..) as people read it, and what a number is multiplied by for it.
struct ReadUnit {
  std::string name;
  double factor = 1;
};
ReadUnit read_unit(const std::string& unit);

// Digits after the point of a number whose 95 % half width this is: two of the half width; `otherwise` where
// that is no positive number.
int digits_of_half_width(double half_width, int otherwise);

std::vector<Table> trust_tables(const Comparison& comparison);

}  // namespace odobench
