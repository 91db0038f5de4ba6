// One run = one record = one JSON line. Tables and plots are pure functions of records.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/measure.hpp"
#include "reports/records/trust_record.hpp"

namespace odobench {

inline constexpr int kRecordSchemaVersion = 2;

// e_n = max_k |estimate - reference| of one recording, for x, y [m] and theta [rad].
struct RecordingError {
  std::string recording;
  std::string trajectory;
  int repetition = 0;
  std::array<double, 3> max_error{};  // x, y, theta
};

struct ParameterValue {
  std::string name;
  std::string unit;
  double value = 0;
  double nominal = 0;
  double lower = 0;
  double upper = 0;
  std::string at_bound;  // "", "lower" or "upper"
};

struct TracePoint {
  std::int64_t evaluations = 0;
  double seconds = 0;
  double cost = 0;  // best so far
};

// Of the driver's test of first-order optimality at the returned point (docs/solvers.md): `converged` is said
// where value <= limit. value: what a step inside the box still promises, as a part of the cost; not-a-number
// where cost or derivatives are not finite.
struct OptimalityRecord {
  std::string test;  // "a bounded Gauss-Newton step", "a bounded Newton step", "no free parameter"
  double value = 0;
  double limit = 0;
  std::int64_t evaluations = 0;  // made for the test, not counted among those of the run
};

// Of a problem whose best cost is known: certified, published, or the lowest that anyone has found.
struct KnownAnswer {
  double cost = 0;  // the lowest known
  std::optional<double>
      digits;  // of the worst parameter, where the minimisers are known (NIST's log relative error, 0 to 11)
  bool solved = false;  // docs/problems.md says by which rule
  // Of a bounded Gauss-Newton step at the returned point by differences of residuals alone: a second opinion
  // on `converged`.
  std::optional<double> promise;
};

struct RunContext {
  std::string cpu;
  std::string compiler;
  std::string build_type;
  std::string git_revision;
  std::string version;
  int threads = 1;
  std::string command;    // the command line, "" when it is not known
  std::string libraries;  // versions of the solvers' libraries
  std::string kernel;     // of the cost evaluations: "avx512", "avx2", "baseline"; "" in older records
};

struct RunRecord {
  std::string problem;
  std::string dataset;         // name of the set
  std::string dataset_sha256;  // of its set.json; empty without a set
  std::string label;   // how tables call this row: "lm", "pso[variant=thesis]", "nominal", "published:lm"
  std::string kind;    // "run" (a solver ran), "evaluation" (given parameters), "skipped" (cannot run)
  std::string solver;  // registry name
  std::map<std::string, std::string> options;  // every option with the value in force
  std::string polish;                          // solver that polished the result, or ""
  std::uint64_t seed = 0;                      // the derived seed
  std::uint64_t base_seed = 0;
  int repetition = 1;  // of the run, 1-based
  std::string start;   // nominal | random
  std::string box;     // check sum of the parameters' names and bounds; "" in older records
  std::optional<bool>
      random;  // whether the solver or its polish draws random numbers; absent in older records
  // Limits in force: max_evaluations, max_seconds (0: none), target. Empty in records of versions that did
  // not write it.
  std::map<std::string, double> budget;

  std::string termination;                // converged, settled, stalled, target_reached, max_evaluations, ...
  std::string message;                    // the sentence with both numbers, or why it was skipped
  std::optional<OptimalityRecord> check;  // absent without derivatives, and in records of earlier versions
  std::optional<KnownAnswer> known;
  std::optional<double> cost;
  std::optional<double> cost_before_polish;
  std::vector<ParameterValue> parameters;
  std::vector<RecordingError> errors;
  std::int64_t evaluations = 0;  // all calls
  std::int64_t cost_evaluations = 0;
  std::int64_t derivative_evaluations = 0;
  std::int64_t non_finite = 0;
  std::int64_t iterations = 0;
  double seconds = 0;
  std::vector<TracePoint> trace;
  std::string group;  // of data sets with groups: the one that this member is in
  // Figures beyond cost and errors; the header of each kind of record (reports/kinds/) says which.
  Measures measures;
  // Lists of figures by name: kIdentifiabilitySeries below, those of reports/kinds/entropy/entropy_tables.hpp
  // and reports/kinds/fusion/fusion_tables.hpp. What is not finite is stored as null and read as
  // not-a-number.
  std::map<std::string, std::vector<double>> series;
  // How far a calibration can be trusted; absent in records of earlier versions and of other problems.
  std::optional<TrustRecord> trust;
  std::vector<std::string> notes;  // remarks on this result, e.g. which parameters are barely determined
  RunContext context;
  std::string time_utc;  // ISO 8601 start of the run
};

// Series of a least-squares result with n free parameters (those whose bounds differ), in their order and
// relative to |nominal| (half the box where nominal is 0):
//   singular_values      of the Jacobian, largest first (n)
//   directions           unit right singular vectors in the same order, one after the other (n * n)
//   sd_if_samples_were_independent  sqrt(J / (N - n) diag((J'J)^-1)) (n), null where the data say nothing;
//                        samples are not independent: several times too small, no interval is made of it.
//                        `standard_deviations` in records of earlier versions, read by the new name
//   correlation          of the parameters, row by row (n * n)
//   residual_deviation   sqrt(J / (N - n)) (1)
inline constexpr std::array<const char*, 5> kIdentifiabilitySeries{
    "singular_values", "directions", "sd_if_samples_were_independent", "correlation", "residual_deviation"};

// Doubles keep every bit, except that JSON has no word for what is not finite: it is written as null and read
// as not-a-number (an optional cost: as absent).
nlohmann::json to_json(const RunRecord& record);
// Of schema 1 or 2. DataError names the field, what was found and what was expected. Fields that it does not
// know are ignored.
RunRecord record_from(const JsonNode& node);

// Whether `converged` was said though a step found without the problem's own derivatives would still gain:
// more than ten times what the verdict's test allows, and at least 1e-6 of the cost.
bool false_verdict(const RunRecord& record);

// One line, without a newline at its end.
std::string to_json_line(const RunRecord& record);
// Reads a .jsonl file by record_from(), empty lines are passed over; DataError "file:line:
// /parameters/3/lower: found "x", expected a number".
std::vector<RunRecord> read_records(const std::string& path);

}  // namespace odobench
