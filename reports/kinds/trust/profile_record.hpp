// What --profile leaves in the record of the result that it was made of: per parameter PARAM measures, `of`
// it and in its unit,
//   profile.PARAM.rise            how far J may rise within the 95 % interval (no unit); absent without one
//   profile.PARAM.lower, .upper   its ends; absent where it goes on to the bound
// and series, ascending by value,
//   profile.PARAM.value, profile.PARAM.cost   J with the parameter held at the value and all others fitted
#pragma once

#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

struct ProfileFigures {
  std::string parameter;
  std::vector<double> values, costs;
  double rise = 0;              // not-a-number where there is no interval
  double lower = 0, upper = 0;  // its ends; +-infinity where it goes on to the bound
};

void put_profiles(const std::vector<ProfileFigures>& figures, RunRecord& record);
// In the order of the record's parameters; those that it has no profile of are left out.
std::vector<ProfileFigures> profiles_of(const RunRecord& record);

// Of the first record that has some: a row per parameter, the profile's interval beside that of table
// `intervals`.
std::optional<Table> profile_table(const Comparison& comparison);
// J above its minimum along each, a small chart per parameter; nothing where there is none.
void add_profile_figures(const Comparison& comparison, const std::string& prefix, Section& section,
                         Document& document);

}  // namespace odobench
