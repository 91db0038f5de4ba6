// Parts of a log that are drives: inside the common time of all signals, without gaps, without standing.
#pragma once

#include <string>
#include <vector>

#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

struct Part {
  double from = 0, to = 0;  // s, by the robot's clock, since LogCurves::begin_ns
  std::string name;         // of a mark
};

// The wheels stand where none of them turns by more than 0.01 rad in a quarter of a second; half a second of
// standing is left at both ends of a part.
class PartFinder {
 public:
  // Stamps by the robot's clock are those of the curves less these shifts [s].
  PartFinder(const LogMap& map, const LogCurves& curves, double reference_shift,
             const std::vector<double>& shifts);

  // What was cut off, split or left out goes to `notes`.
  std::vector<Part> find(std::vector<std::string>& notes) const;

 private:
  Part common_time() const;
  std::vector<Part> without_gaps(const Part& whole, std::vector<std::string>& notes) const;
  // Intervals in which a wheel turns, standing of less than `longest` [s] between them counted in.
  std::vector<Part> moving(const Part& part, double longest) const;

  const LogMap& map_;
  const LogCurves& curves_;
  double reference_shift_;
  const std::vector<double>& shifts_;
};

}  // namespace odobench::log_import
