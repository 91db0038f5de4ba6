// Records sorted into what the tables show: one comparison per problem and data set, one row per label.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {

// All records of one label. The pointers are into the vector that was compared.
struct ComparisonRow {
  std::string label;
  std::string kind;                    // of `shown`
  std::vector<const RunRecord*> runs;  // in order of appearance; skipped ones only when there is nothing else
  const RunRecord* shown = nullptr;    // the median by J
  std::vector<TrajectoryErrors> errors;  // of `shown`
};

struct Comparison {
  std::string problem, dataset;
  std::string box;                        // RunRecord::box; "" when no record says
  std::string id_prefix;                  // "" or "calibration.vitko2024."
  std::string title_suffix;               // "" or " (calibration, vitko2024)"
  std::vector<ComparisonRow> rows;        // nominal, other evaluations, runs
  std::vector<std::string> trajectories;  // of all rows, in order of first appearance
  std::optional<std::size_t> reference;   // row of the nominal evaluation

  const ComparisonRow* nominal() const { return reference ? &rows[*reference] : nullptr; }
  // Lowest finite J of all records; none without one.
  std::optional<double> best_cost() const;
};

// In order of first appearance; data sets of the same name but another check sum are kept apart, and so are
// boxes. The records must outlive the result.
std::vector<Comparison> compare(const std::vector<RunRecord>& records);

// Equal check sums, or one that an older record does not have.
bool same_problem_box(const std::string& a, const std::string& b);

// Throws std::invalid_argument when problem, data set name and label do not tell two rows apart: two data
// sets of one name, or an evaluation called like a run.
void require_unique(const std::vector<Comparison>& groups);

// What a repetition of the row may change about a figure of its runs, for Cell::noise: the interquartile
// range over several runs; infinity of a single run that draws random numbers, or may (older records do not
// say), or that a clock ended; none else.
std::optional<double> noise_over_runs(const ComparisonRow& row,
                                      const std::function<std::optional<double>(const RunRecord&)>& figure);
// How a figure differs although one run repeats to the bit: times. Infinity of a single run.
std::optional<double> timing_noise(const ComparisonRow& row);

// "Of several runs of one label the tables show the median by J: pso 4 of 10." or "" when no label has
// several.
std::string median_note(const Comparison& comparison);

// The entry of a trajectory, null when the row has none.
const TrajectoryErrors* find_trajectory(const std::vector<TrajectoryErrors>& errors, const std::string& name);

}  // namespace odobench
