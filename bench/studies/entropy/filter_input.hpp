// What `bench filter` reads: a CSV file row by row, with its truth beside it, or logs through a map.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/entropy/entropy_setup.hpp"

namespace odobench {

// A row of the data with its truth.
struct FilterInput {
  FilterRow row;
  FilterTruth truth;
};

class FilterInputs {
 public:
  virtual ~FilterInputs() = default;
  virtual bool next(FilterInput& input) = 0;
  virtual std::string file() const = 0;  // for messages
  virtual double dt() const = 0;
  virtual bool has_time() const = 0;
  virtual bool thesis_layout() const { return false; }
  // The last line has no line break; it was taken.
  virtual bool unfinished() const { return false; }
  // Of stamps and rows, once all are read; `report` before.
  virtual std::vector<std::string> notes() const = 0;
  std::vector<std::string> report;
};

// Opens options.data. Of a log `setup` gets the robot's sizes, where the options leave them at their
// defaults. Throws std::invalid_argument on options that do not go with logs, DataError, Interruption.
std::unique_ptr<FilterInputs> open_filter_inputs(const EntropyOptions& options, FilterSetup& setup,
                                                 const Stop& stop);

}  // namespace odobench
