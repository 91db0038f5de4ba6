// What a calibration's record says of how far it can be trusted: problems/trust/trust.hpp as plain data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/measure.hpp"

namespace odobench {

class JsonNode;

// A 95 % interval, or why there is none. Numbers are not-a-number where they are not given.
struct IntervalRecord {
  // For drives of new kinds: standard deviation, degrees of freedom, half width; and for the same drives.
  double deviation, df, half_width;
  double same_deviation, same_df, same_half_width;
  std::string refused = "none";  // name_of(NoInterval): "bound_active", ...
  std::string reason;            // in words; "" where there is an interval

  IntervalRecord();
};

// A number that drives determine: "m33", "turn factor". Units: "" of factors, "m/m", "rad/m", "m/rad".
struct DeterminedRecord {
  std::string name, words, unit;
  double nominal = 0, value = 0;
  IntervalRecord interval;
};

struct ParameterIntervalRecord {
  std::string name, unit;
  double value = 0;
  IntervalRecord interval;
};

// Of an error on a new drive, m or rad: half widths. scatter: of the recordings of that kind, held by them.
struct DriveErrorRecord {
  std::string drive, what, unit;
  double scatter = 0;
  IntervalRecord interval;
};

// How much of J a richer model explains.
struct ExplanationRecord {
  std::string model, words;  // "least_squares+contact_offset", "a contact offset"
  double cost = 0;           // J with it
  double explained = 0;      // share of J that is gone
  bool robot = true;         // of the robot; else a competitor without a meaning
  bool on_bound = false;     // one of its own parameters is
  std::string parameter, unit;
  double value = 0;  // where it has a single one
};

// A drive to make next, alone or with the others of the list.
struct NextDriveRecord {
  std::string purpose;        // "decide" between two models, "settle" parameters
  std::string first, second;  // the models, as 'bench plan --between' takes them
  std::string drive, description;
  bool recorded = false;                   // it is one of the set
  int repetitions = 0;                     // 0: however often, it does not do
  double separation = 0, probability = 0;  // of deciding: of one drive; of the right choice after them
  double seconds = 0;                      // of one
};

// What there is to drive next: models that are told apart, in words; parameters that are settled or stay
// open.
struct NextStepsRecord {
  std::string skipped;  // why nothing was planned; everything else is empty then
  std::string first_words, second_words;
  std::vector<std::string> open, settled;
  double largest_before = 0, largest_after = 0;  // of those open: 95 % half width over that of the box
  std::vector<NextDriveRecord> drives;  // to decide: best first, each does alone; to settle: together
};

// A number that somebody asked for: --combination.
struct CombinationRecord {
  std::string name, formula, unit;
  double nominal = 0, value = 0;  // nominal: not-a-number where the formula has none there
  bool of_the_map = false;        // made of the determined numbers alone
  IntervalRecord interval;
};

struct TrustRecord {
  int recordings = 0, kinds = 0;
  bool exact_hessian = false;
  double kind_f, kind_p;  // test of errors that repeat within kinds; not-a-number where it is not possible
  bool systematic = false;
  bool ratios_only = false;  // headings alone were compared
  std::vector<DeterminedRecord> determined;
  std::vector<ParameterIntervalRecord> parameters;
  std::vector<DriveErrorRecord> drives;
  std::optional<double> twice_box;  // J in a box twice as wide, where a parameter is on a bound
  std::vector<ExplanationRecord> explanations;
  std::optional<NextStepsRecord> next;
  std::vector<CombinationRecord> combinations;
  std::vector<std::string> remarks, sentences;  // of the numbers; below the tables

  TrustRecord();
};

// What comparisons and gates watch of it, `of` the number NAME of the map:
//   trust.NAME                                   value in SI units; no direction
//   trust.NAME.half_width, .same_half_width      95 %, new kinds of drive and the same; lower is better;
//                                                absent where there is no interval
//   trust.intervals                              numbers of the map that have one; higher is better
//   trust.single_intervals                       parameters that have one; higher is better
std::vector<Measure> trust_measures(const TrustRecord& trust);

nlohmann::json to_json(const TrustRecord& trust);
// DataError names the field. Fields that it does not know are ignored.
TrustRecord trust_from(const JsonNode& node);

}  // namespace odobench
