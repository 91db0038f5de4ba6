// What a calibration's record says of how far it can be trusted: problems/trust/trust.hpp as plain data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

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

struct TrustRecord {
  int recordings = 0, kinds = 0;
  bool exact_hessian = false;
  double kind_f, kind_p;  // test of errors that repeat within kinds; not-a-number where it is not possible
  bool systematic = false;
  bool ratios_only = false;  // headings alone were compared
  std::vector<DeterminedRecord> determined;
  std::vector<ParameterIntervalRecord> parameters;
  std::vector<DriveErrorRecord> drives;
  std::vector<std::string> remarks, sentences;  // of the numbers; below the tables

  TrustRecord();
};

nlohmann::json to_json(const TrustRecord& trust);
// DataError names the field. Fields that it does not know are ignored.
TrustRecord trust_from(const JsonNode& node);

}  // namespace odobench
