// Regression check: golden values of runs in a JSON file, compared with stated tolerances.
//
//   {"schema_version": 1,
//    "tolerances": {"cost_relative": 1e-6, "error_m": 1e-6, "error_rad": 1e-6, "total": 6e-6,
//    "evaluations_factor": 2}, "entries": [
//      {"problem": "calibration", "dataset": "vitko2024", "label": "lm", "kind": "run",
//       "cost": 98.11878293, "evaluations": 29,
//       "totals": {"x": 0.06, "y": 0.06, "theta": 0.25, "total": 0.37},
//       "errors": {"line_x": {"x": {"e_max": 0.008, "e_sr": 0.008, "sigma": 0.0002}, "y": {..}, "theta":
//       {..}}, ..}, "tolerances": {"cost_relative": 0.01}}]}
//
// |found - expected| <= cost_relative |expected| for J; <= error_m, error_rad for the error cells of x, y and
// theta;
// <= total for the sums (table 42). found <= evaluations_factor * expected for evaluations, unchecked when
// the factor is null or the entry has no "evaluations". "tolerances" of an entry override those of the file
// one by one. null stands for a value that was not finite and is met only by such a value. An entry's
// optional "box" is RunRecord::box: a result in another box is another problem's. Keys other than these are
// errors.
//
// An entry of a label that ran several times may keep what each run gave (`"samples": {"cost": [..],
// "evaluations": [..], "total": [..]}`, null for a run without a result). Where the records have several runs
// of the label too, these three are compared as samples instead: a median must leave its tolerance AND
// Mann-Whitney's test (reports/statistics/mann_whitney.hpp) must be significant, p <= kSampleAlpha after
// Holm's correction over all samples of the file. Two numbers of a random solver differ for no reason, so the
// cells of its median run are not compared then. Any other entry is compared value by value.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {

inline constexpr int kBaselineSchemaVersion = 1;
inline constexpr double kSampleAlpha = 0.05;

struct Tolerances {
  double cost_relative = 1e-6;
  double error_m = 1e-6;
  double error_rad = 1e-6;
  double total = 6e-6;  // metres and radians are mixed in the total, as in the thesis
  std::optional<double> evaluations_factor;
};

struct BaselineEntry {
  std::string problem, dataset, label, kind;
  std::string box;             // check sum of the parameters' names and bounds; "": whatever box
  std::optional<double> cost;  // absent for skipped and failed runs
  std::optional<std::int64_t> evaluations;
  std::vector<TrajectoryErrors> errors;
  std::optional<Totals> totals;
  std::map<std::string, std::vector<double>>
      samples;            // of labels with several runs; +infinity for a failed one
  Tolerances tolerances;  // in force for this entry
};

struct Baseline {
  std::string source;  // file it was read from, for messages; "" when made from records
  Tolerances tolerances;
  std::vector<BaselineEntry> entries;
};

// DataError "file: /entries/3/errors/line_x/x/e_max: found "x", expected a number".
Baseline read_baseline(const std::string& path);

// One entry per label, its trajectories in alphabetical order; of several runs with one label the median run
// by J, as in the tables, and the samples. Throws std::invalid_argument when there is no record, a tolerance
// is negative or not finite, or two results have one name.
Baseline make_baseline(const std::vector<RunRecord>& records, const Tolerances& tolerances = {});

// Text of the file, one error cell group per line so that a change shows as few changed lines; ends with a
// newline.
std::string to_json_text(const Baseline& baseline);

struct BaselineReport {
  bool passed = false;
  std::size_t compared = 0;  // values
  // One row per cell that moved, per label or trajectory missing from the records, and per additional one;
  // what was compared is in a note.
  Table table;
};

// Fails on every cell outside its tolerance, when there is nothing to compare, on labels or trajectories that
// are missing, and on additional trajectories. Additional labels are listed without failing. Throws
// std::invalid_argument when two results of the records have one name.
BaselineReport check_baseline(const Baseline& baseline, const std::vector<RunRecord>& records);

}  // namespace odobench
