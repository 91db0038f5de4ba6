// What a bootstrap leaves in the record of the result that it was made of: measures
//   bootstrap.replicates; bootstrap.stratified (1, or 0 of plain resamples)
//   bootstrap.cost.p2_5, p50, p97_5    percentiles of J over the replicates, each of its own resample
// and series
//   bootstrap.recordings   of each replicate the recordings drawn, ascending, as places in RunRecord::errors
//                          from 0: one list after the other, each as long as there are recordings
//   bootstrap.cost         J of each replicate
//   bootstrap.parameters   of each replicate, one after the other
// Percentiles by linear interpolation between order statistics (definition 7 of Hyndman and Fan 1996).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

inline constexpr std::array<double, 3> kBootstrapPercentiles{2.5, 50, 97.5};

struct BootstrapFigures {
  std::string scheme = "stratified";  // or "plain"
  std::vector<double> recordings, costs, parameters;

  std::size_t replicates() const { return costs.size(); }
};

void put_bootstrap(const BootstrapFigures& figures, RunRecord& record);
// Nothing where there was none.
std::optional<BootstrapFigures> bootstrap_of(const RunRecord& record);

// Over the replicates.
struct BootstrapSpread {
  std::array<double, 3> percentiles{};
  double deviation = 0;       // standard, of the sample; not-a-number for one replicate
  double share_at_bound = 0;  // within 1e-6 of the width of the box
};
// Of one parameter, by its place.
BootstrapSpread parameter_spread(const BootstrapFigures& figures, const RunRecord& record,
                                 std::size_t parameter);
BootstrapSpread cost_spread(const BootstrapFigures& figures);

// Throws std::invalid_argument for an empty list.
double percentile(std::vector<double> values, double percent);

}  // namespace odobench
