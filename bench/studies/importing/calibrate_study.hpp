// From logs to parameters in one go: the study behind `bench calibrate`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/importing/map_answers.hpp"
#include "bench/studies/trust/trust_choice.hpp"
#include "bench/studies/watcher.hpp"
#include "datasets/dataset.hpp"
#include "datasets/logs/log_file.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct CalibrateStudy {
  std::vector<std::filesystem::path> logs;  // or one set.json
  std::filesystem::path map;                // "": proposed
  MapAnswers answers;                       // to the proposal
  LogOptions options;
  // Cost and mount of the fit. Without a cost: segments where the reference proposed is another odometry.
  CalibrationChoice calibration = screened();
  std::vector<std::string> accept;  // kinds of findings that do not stop the calibration, comma lists
  ValidationChoice validation;
  std::filesystem::path out;  // folder: map.json, set.json, results/, report.html
  bool overwrite = false;
};

struct Calibrated {
  std::vector<RunRecord> records;            // nominal, lm
  std::vector<std::filesystem::path> files;  // what was written, for people
  std::filesystem::path results;             // the run directory
  std::filesystem::path set,
      sensors;  // what bench fuse takes; sensors "" where the robot has none that it knows
};

// Proposes a map (unless one is given), imports, calibrates with `lm`, writes. What was assumed goes to the
// watcher as notes. Throws std::invalid_argument where the log leaves open what may not be assumed (then
// nothing is written), DataError, Interruption.
Calibrated calibrate_logs(const CalibrateStudy& study, const Catalogue& catalogue, Watcher& watcher,
                          const Stop& stop);

}  // namespace odobench
