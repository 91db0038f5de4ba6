// The statistics of the tables. Not-a-number in, not-a-number out: nothing is dropped silently.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

// Index of x, y, theta in the arrays below and their names.
inline constexpr std::array<const char*, 3> kPoseVariables{"x", "y", "theta"};

// Of one variable over the repetitions n = 1..N of a trajectory, e_n = max_k |estimate - reference|:
//   e_max = max_n e_n,   e_sr = 1/N sum_n e_n (3.15),   sigma^2 = sum_n (e_n - e_sr)^2 / (N - 1)
// sigma is the sample standard deviation, not-a-number for N = 1.
struct ErrorStatistics {
  double max = 0;
  double mean = 0;
  double sigma = 0;
};

struct TrajectoryErrors {
  std::string trajectory;
  std::array<ErrorStatistics, 3> variables{};  // x, y [m], theta [rad]
};

// One entry per trajectory, in order of first appearance.
std::vector<TrajectoryErrors> error_statistics(const std::vector<RecordingError>& errors);

// Table 42: sums of e_sr over the trajectories, and their sum (metres and radians mixed, as in the thesis).
struct Totals {
  std::array<double, 3> sums{};  // x, y, theta
  double total = 0;
};
Totals error_totals(const std::vector<TrajectoryErrors>& errors);

// e_max, e_sr, sigma of a non-empty list; throws std::invalid_argument for an empty one.
ErrorStatistics error_statistics_of(const std::vector<double>& repetitions);

// Five-number summary. Quartiles by linear interpolation between order statistics (definition 7 of
// Hyndman and Fan 1996, the default of numpy and R). Throws std::invalid_argument for an empty list.
struct Spread {
  std::size_t count = 0;
  double min = 0;
  double lower_quartile = 0;
  double median = 0;
  double upper_quartile = 0;
  double max = 0;
  double interquartile_range() const { return upper_quartile - lower_quartile; }
};
Spread spread(std::vector<double> values);

}  // namespace odobench
